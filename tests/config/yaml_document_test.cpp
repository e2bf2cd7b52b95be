#include "config/yaml_document.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "gfp/core/random.hpp"

namespace gfp::config {
namespace {

Error error_of(const std::string& text) {
  const auto parsed = parse_yaml(text, "hostile.yaml");
  EXPECT_FALSE(parsed.has_value()) << text.substr(0, 100);
  return parsed ? Error{} : parsed.error();
}

TEST(YamlDocument, EmptyTextIsAnEmptyDocument) {
  const auto parsed = parse_yaml("", "empty.yaml");
  ASSERT_TRUE(parsed.has_value());
  EXPECT_TRUE(parsed->IsNull());
}

TEST(YamlDocument, SyntaxErrorsNameFileAndLine) {
  const Error error = error_of("a: 1\nb: [1, 2\nc: 3\n");
  EXPECT_EQ(error.code, ErrorCode::kCorruptData);
  EXPECT_TRUE(error.what.starts_with("hostile.yaml:")) << error.what;
}

TEST(YamlDocument, AKeyTwiceIsAnErrorNotTheFirstOfThem) {
  EXPECT_EQ(error_of("a: 1\nb: {x: 1, x: 2}\n").what, "hostile.yaml:2: key x stands here twice");
}

TEST(YamlDocument, SeveralDocumentsAreRefused) { EXPECT_EQ(error_of("a: 1\n---\na: 2\n").code, ErrorCode::kCorruptData); }

// Limits hold before nodes are built: each of these would otherwise cost far more memory or stack than its bytes.
TEST(YamlDocument, RefusesWhatIsTooLargeDeepOrAliased) {
  EXPECT_EQ(error_of(std::string(kMaxFileBytes + 1, ' ')).code, ErrorCode::kTooLarge);
  EXPECT_NE(error_of("a: " + std::string(100, '[') + std::string(100, ']')).what.find("nested deeper than 24"), std::string::npos);
  EXPECT_EQ(error_of(std::string(100'000, '[')).code, ErrorCode::kCorruptData);
  std::string many = "a: [";
  for (int i = 0; i < kMaxNodes + 1; ++i) many += "1,";
  EXPECT_NE(error_of(many + "]").what.find("more than 20000 values"), std::string::npos);
  std::string laughs = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 70; ++i) laughs.append("a").append(std::to_string(i)).append(": &a").append(std::to_string(i)).append(" [*a").append(std::to_string(i - 1)).append(", *a0]\n");
  EXPECT_NE(error_of(laughs).what.find("more than 64 aliases"), std::string::npos);
}

// Whatever the bytes, parsing ends with a value or an error. Mutations of a real file and random structure characters.
TEST(YamlDocument, SurvivesRandomBytes) {
  const std::string seed_text = "sensors:\n  - name: front\n    driver: replay\npublish: {insecure: true}\npipeline:\n  method: \"gfp\"\n";
  const std::string structure = "{}[]:,&*!|>'\"%@`#- \n\t?<=~a1.\\";
  Random random(7);
  int parsed = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = round % 2 == 0 ? seed_text : std::string(static_cast<std::size_t>(random.below(40)), ' ');
    const int changes = round % 2 == 0 ? 1 + random.below(8) : static_cast<int>(text.size());
    for (int k = 0; k < changes; ++k) {
      const std::size_t at = round % 2 == 0 ? static_cast<std::size_t>(random.below(static_cast<int>(text.size()))) : static_cast<std::size_t>(k);
      text[at] = random.below(4) == 0 ? static_cast<char>(random.below(256)) : structure[static_cast<std::size_t>(random.below(static_cast<int>(structure.size())))];
    }
    parsed += parse_yaml(text, "random.yaml").has_value() ? 1 : 0;
  }
  EXPECT_GT(parsed, 100);  // some of it is YAML: the loop tests parsing, not only refusal
}

TEST(YamlDocument, ReadTextSaysWhyItCannotRead) {
  EXPECT_EQ(read_text("/nowhere/at/all.yaml").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(read_text(std::filesystem::temp_directory_path()).error().code, ErrorCode::kIo);
  const auto large = std::filesystem::path(::testing::TempDir()) / "gfp_large.yaml";
  std::ofstream(large) << std::string(kMaxFileBytes + 1, '#');
  EXPECT_EQ(read_text(large).error().code, ErrorCode::kTooLarge);
}

}  // namespace
}  // namespace gfp::config
