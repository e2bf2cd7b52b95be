#include "view/access.hpp"

#include <gtest/gtest.h>

namespace gfp::view {
namespace {

const std::string kToken = "0123456789abcdef";

ViewOptions with_token() {
  ViewOptions options;
  options.token = kToken;
  return options;
}

TEST(Access, BeyondLoopbackATokenIsNeeded) {
  ViewOptions options;
  EXPECT_TRUE(validate(options).has_value());
  options.address = "0.0.0.0";
  EXPECT_NE(validate(options).error().what.find("view.address = 0.0.0.0"), std::string::npos);
  options.token = "short";
  EXPECT_NE(validate(options).error().what.find("at least 16"), std::string::npos);
  options.token = kToken;
  EXPECT_TRUE(validate(options).has_value());
}

TEST(Access, TheTokenComesInThreeWays) {
  const ViewOptions options = with_token();
  EXPECT_FALSE(has_token({}, options));
  EXPECT_TRUE(has_token({"/?token=" + kToken, "", "", "", ""}, options));
  EXPECT_TRUE(has_token({"/?a=b&token=" + kToken, "", "", "", ""}, options));
  EXPECT_TRUE(has_token({"/", "", "", "Bearer " + kToken, ""}, options));
  EXPECT_TRUE(has_token({"/", "", "", "", "x=y; gfp_view_token=" + kToken}, options));
  for (const Caller& wrong : {Caller{"/?token=0123456789abcdeF", "", "", "", ""}, Caller{"/?token=", "", "", "", ""}, Caller{"/?nottoken=0123456789abcdef", "", "", "", ""}, Caller{"/", "", "", "Basic 0123456789abcdef", ""},
                              Caller{"/", "", "", "", "gfp_view_token=0123456789abcde"}})
    EXPECT_FALSE(has_token(wrong, options)) << wrong.target << wrong.authorization << wrong.cookie;
  EXPECT_TRUE(has_token({}, ViewOptions()));  // none is asked for
}

TEST(Access, OnlyOurPageAndAllowedOnesConnect) {
  ViewOptions options;
  options.allowed_origins = {"https://app.foxglove.dev"};
  const auto welcome = [&](std::string_view origin) { return is_welcome_origin({"/", "127.0.0.1:8765", origin, "", ""}, options); };
  EXPECT_TRUE(welcome(""));
  EXPECT_TRUE(welcome("http://127.0.0.1:8765"));
  EXPECT_TRUE(welcome("https://app.foxglove.dev"));
  for (const char* stranger : {"http://evil.example", "http://127.0.0.1:8766", "null", "https://app.foxglove.dev.evil.example", "http://127.0.0.1:8765.evil.example"}) EXPECT_FALSE(welcome(stranger)) << stranger;
}

TEST(Access, OnLoopbackOnlyItsNamesAreOurs) {
  const ViewOptions local;
  for (const char* host : {"localhost:8765", "127.0.0.1:8765", "[::1]:8765", "localhost"}) EXPECT_TRUE(is_our_host({"/", host, "", "", ""}, local)) << host;
  for (const char* host : {"evil.example:8765", "", "localhost.evil.example", "[::1", "["}) EXPECT_FALSE(is_our_host({"/", host, "", "", ""}, local)) << host;
  ViewOptions open = with_token();
  open.address = "0.0.0.0";
  EXPECT_TRUE(is_our_host({"/", "robot.local:8765", "", "", ""}, open));
}

}  // namespace
}  // namespace gfp::view
