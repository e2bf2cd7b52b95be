#include "config/field_loader.hpp"

#include <gtest/gtest.h>

#include "config/field_writer.hpp"
#include "config/yaml_document.hpp"

namespace gfp {
namespace {

struct Inner {
  double ratio = 0.5;
  std::vector<std::string> words;
};

template <class Visitor>
void visit_fields(Inner& o, Visitor&& field) {
  field("ratio", o.ratio, 0.0, 1.0);
  field("words", o.words);
}

/// One field of every form.
struct Everything {
  int count = 3;
  std::uint64_t seed = 1;
  bool enabled = false;
  std::string text = "plain";
  std::string choice = "a";
  std::vector<double> numbers{1, 2};
  Transform pose = Transform::Identity();
  Inner inner;
  std::vector<Inner> list;
};

template <class Visitor>
void visit_fields(Everything& o, Visitor&& field) {
  field("count", o.count, -5, 10);
  field("seed", o.seed, std::uint64_t{0}, UINT64_MAX);
  field("enabled", o.enabled);
  field("text", o.text);
  field("choice", o.choice, OneOf{{"a", "b"}});
  field("numbers", o.numbers, -10.0, 10.0);
  field("pose", o.pose);
  field.section("inner", o.inner);
  field.list("list", o.list);
}

Result<Everything> load(const std::string& text, Everything start = {}) {
  const auto document = config::parse_yaml(text, "file.yaml");
  if (!document) return tl::unexpected(document.error());
  if (auto loaded = config::load_fields(*document, "file.yaml", start); !loaded) return tl::unexpected(loaded.error());
  return start;
}

std::string problem(const std::string& text) {
  const auto loaded = load(text);
  EXPECT_FALSE(loaded.has_value()) << text;
  return loaded ? "" : loaded.error().what;
}

TEST(FieldLoader, ReadsEveryForm) {
  const auto loaded = load(
      "count: -2\nseed: 18446744073709551615\nenabled: true\ntext: 'a: b'\nchoice: b\nnumbers: [1e-3, -4]\n"
      "pose: [[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]]\ninner:\n  words: [x, y z]\nlist:\n  - ratio: 1\n  - {}\n");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->count, -2);
  EXPECT_EQ(loaded->seed, UINT64_MAX);
  EXPECT_TRUE(loaded->enabled);
  EXPECT_EQ(loaded->text, "a: b");
  EXPECT_EQ(loaded->choice, "b");
  EXPECT_EQ(loaded->numbers, (std::vector<double>{1e-3, -4}));
  EXPECT_EQ(loaded->pose * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.1, 1.2, 0.3));
  EXPECT_EQ(loaded->inner.words, (std::vector<std::string>{"x", "y z"}));
  ASSERT_EQ(loaded->list.size(), 2U);
  EXPECT_EQ(loaded->list[0].ratio, 1.0);
  EXPECT_EQ(loaded->list[1].ratio, 0.5);
}

TEST(FieldLoader, AbsentKeysAndEmptySectionsLeaveTheirMembersAlone) {
  Everything start;
  start.count = 9;
  start.inner.ratio = 0.25;
  const auto loaded = load("text: new\ninner:\n", start);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->count, 9);
  EXPECT_EQ(loaded->inner.ratio, 0.25);
}

// The message is the product: file, line, key, value and bound, for each of the ways to be wrong.
TEST(FieldLoader, ErrorsNameFileLineKeyValueAndBound) {
  EXPECT_EQ(problem("text: x\ncount: 11\n"), "file.yaml:2: count = 11, expected [-5, 10]");
  EXPECT_EQ(problem("count: many\n"), "file.yaml:1: count = many, expected an integer in [-5, 10]");
  EXPECT_EQ(problem("count: 1.5\n"), "file.yaml:1: count = 1.5, expected an integer in [-5, 10]");
  EXPECT_EQ(problem("count: \"1\"\n"), "file.yaml:1: count = \"1\", expected an integer in [-5, 10]");
  EXPECT_EQ(problem("count: 99999999999999999999\n"), "file.yaml:1: count = 99999999999999999999, expected [-5, 10]");
  EXPECT_EQ(problem("count:\n"), "file.yaml:1: count = nothing, expected an integer in [-5, 10]");
  EXPECT_EQ(problem("inner: {ratio: nan}\n"), "file.yaml:1: inner.ratio = nan, expected [0, 1]");
  EXPECT_EQ(problem("enabled: yes\n"), "file.yaml:1: enabled = yes, expected true or false");
  EXPECT_EQ(problem("choice: c\n"), "file.yaml:1: choice = c, expected one of a, b");
  EXPECT_EQ(problem("text: [a]\n"), "file.yaml:1: text = a list, expected text of at most 4096 bytes");
  EXPECT_EQ(problem("inner: 5\n"), "file.yaml:1: inner = 5, expected a mapping");
  EXPECT_EQ(problem("numbers: [1, 20]\n"), "file.yaml:1: numbers.1 = 20, expected [-10, 10]");
  EXPECT_EQ(problem("list:\n  - ratio: 1\n  - ratio: 2\n"), "file.yaml:3: list.1.ratio = 2, expected [0, 1]");
  EXPECT_EQ(problem("[1, 2]"), "file.yaml:1: the document expected to be a mapping");
  EXPECT_EQ(problem("pose: [[1, 0], [0, 1]]"), "file.yaml:1: pose = a list, expected 4 rows of 4 numbers, or all 16");
  EXPECT_EQ(problem("pose: [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
            "file.yaml:1: pose is not rigid: expected a rotation (to 1e-3), a translation and the row [0, 0, 0, 1]");
}

TEST(FieldLoader, UnknownKeysGetTheNearestOneThatExists) {
  EXPECT_EQ(problem("inner:\n  ratoi: 0.3\n"), "file.yaml:2: inner.ratoi is not a key; did you mean ratio?");
  EXPECT_EQ(problem("inner: {colour: red}\n"), "file.yaml:1: inner.colour is not a key; here are ratio, words");
}

TEST(FieldLoader, AllProblemsAreListedAndNothingIsTaken) {
  Everything options;
  const auto document = config::parse_yaml("count: 4\nseed: -1\nchoice: c\n", "file.yaml");
  const auto loaded = config::load_fields(*document, "file.yaml", options);
  ASSERT_FALSE(loaded.has_value());
  EXPECT_EQ(loaded.error().what, "file.yaml:2: seed = -1, expected an integer in [0, 18446744073709551615]\n"
                                 "file.yaml:3: choice = c, expected one of a, b");
  EXPECT_EQ(options.count, 3);
}

TEST(FieldLoader, IndicesChangeSingleElementsOfAList) {
  Everything start;
  start.list.resize(2);
  const auto loaded = load("list: {1: {ratio: 0.75}}", start);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->list[0].ratio, 0.5);
  EXPECT_EQ(loaded->list[1].ratio, 0.75);
  EXPECT_FALSE(load("list: {2: {ratio: 0.75}}", start).has_value());
  EXPECT_FALSE(load("list: {x: {ratio: 0.75}}", start).has_value());
}

TEST(FieldLoader, LongListsAreRefused) {
  std::string text = "list: [";
  for (int i = 0; i < 65; ++i) text += "{},";
  EXPECT_EQ(problem(text + "]"), "file.yaml:1: list = a list, expected a list of at most 64");
}

TEST(FieldWriter, WhatIsWrittenReadsBackTheSame) {
  Everything options;
  options.count = -4;
  options.seed = 0xFFFFFFFFFFFFFFFF;
  options.enabled = true;
  options.text = "5: \"quoted\"\n\ttwo lines # no comment";
  options.choice = "b";
  options.numbers = {0.1, 1.0 / 3.0, -1e-7};
  options.pose = Eigen::Translation3d(0.1, -1.0 / 3.0, 2) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  options.inner = {0.1 + 0.2, {"", "~", "null", "12"}};
  options.list = {Inner{}, Inner{1.0, {"a"}}};
  const std::string text = config::fields_to_yaml(options);
  const auto loaded = load(text);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what << "\n" << text;
  EXPECT_EQ(loaded->text, options.text);
  EXPECT_EQ(loaded->numbers, options.numbers);
  EXPECT_EQ(loaded->pose.matrix(), options.pose.matrix());
  EXPECT_EQ(loaded->inner.words, options.inner.words);
  EXPECT_EQ(config::fields_to_yaml(*loaded), text);
}

TEST(FieldSchema, DescribesTypesBoundsAndDefaults) {
  Everything options;
  const auto schema = config::FieldSchema::of(options);
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["properties"]["count"].dump(), R"({"type":"integer","default":3,"minimum":-5,"maximum":10})");
  EXPECT_EQ(schema["properties"]["choice"]["enum"].dump(), R"(["a","b"])");
  EXPECT_EQ(schema["properties"]["list"]["items"]["properties"]["ratio"]["maximum"], 1.0);
}

}  // namespace
}  // namespace gfp
