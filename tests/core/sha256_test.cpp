#include "gfp/core/sha256.hpp"

#include <gtest/gtest.h>

#include <string>

namespace gfp {
namespace {

std::string hash_hex(const std::string& message, std::size_t piece = 1000) {
  Sha256 hash;
  for (std::size_t at = 0; at < message.size(); at += piece)
    hash.put(std::as_bytes(std::span(message).subspan(at, std::min(piece, message.size() - at))));
  std::string hex;
  for (const auto byte : hash.digest()) {
    hex += "0123456789abcdef"[byte >> 4];
    hex += "0123456789abcdef"[byte & 15];
  }
  return hex;
}

// The examples of FIPS 180-4, and the padding's edge: 55, 56 and 64 bytes.
TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(hash_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hash_hex(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnHowTheMessageIsCut) {
  for (const std::size_t length : {55u, 56u, 63u, 64u, 65u, 200u}) {
    const std::string message(length, 'x');
    EXPECT_EQ(hash_hex(message, 1), hash_hex(message)) << length;
    EXPECT_EQ(hash_hex(message, 64), hash_hex(message, 7)) << length;
  }
}

TEST(Sha256, ShortFormIsTheBeginningOfTheDigest) {
  Sha256 hash;
  const std::string message = "abc";
  hash.put(std::as_bytes(std::span(message)));
  EXPECT_EQ(hash.digest64(), 0xba7816bf8f01cfeaULL);
}

}  // namespace
}  // namespace gfp
