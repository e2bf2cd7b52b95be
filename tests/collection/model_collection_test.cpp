#include "gfp/collection/model_collection.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace gfp {
namespace {

namespace fs = std::filesystem;

class ModelCollection : public testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(root_);
  }
  void TearDown() override { fs::remove_all(root_); }
  void write(const fs::path& file, const std::string& text = "OFF\n0 0 0\n") {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  fs::path root_;
};

TEST_F(ModelCollection, OneFolderAClass) {
  for (const char* file : {"mug/b.off", "mug/a.OBJ", "mug/deep/c.ply", "bowl/x.stl", "bowl/readme.txt", "empty/notes.md", "loose.off"}) write(file);
  const auto classes = find_model_classes(root_);
  ASSERT_TRUE(classes);
  ASSERT_EQ(classes->size(), 2U);
  EXPECT_EQ((*classes)[0].name, "bowl");
  EXPECT_EQ((*classes)[1].name, "mug");
  ASSERT_EQ((*classes)[1].files.size(), 3U);
  EXPECT_EQ((*classes)[1].files[0].name, "mug/a.OBJ");
  EXPECT_EQ((*classes)[1].files[0].path, root_ / "mug/a.OBJ");
}

TEST_F(ModelCollection, PrincetonListsNameModelsByNumber) {
  for (const char* file : {"db/0/m1/m1.off", "db/0/m2/m2.off", "db/1/m117/m117.off"}) write(file);
  write("classification/test.cla", "PSB 1\n3 3\n\nfurniture 0 0\n\ntable furniture 2\n1\n117\n\nmug 0 2\n2\n999\n");
  const auto classes = find_model_classes(root_);
  ASSERT_TRUE(classes) << classes.error().what;
  ASSERT_EQ(classes->size(), 2U);
  EXPECT_EQ((*classes)[0].name, "mug");
  EXPECT_EQ((*classes)[0].files.size(), 1U) << "a model that is not there is left out";
  EXPECT_EQ((*classes)[1].files.size(), 2U);
}

TEST_F(ModelCollection, ABrokenListNamesItsLine) {
  write("m1.off");
  write("a.cla", "PSB 1\n1 1\nmug 0 5\n1\n");
  const auto classes = find_model_classes(root_);
  ASSERT_FALSE(classes);
  EXPECT_EQ(classes.error().code, ErrorCode::kCorruptData);
  EXPECT_NE(classes.error().what.find("a.cla:4"), std::string::npos) << classes.error().what;
}

TEST_F(ModelCollection, ATableSaysScaleAndAxis) {
  write("meshes.csv", "file,class,scale_to_m,up_axis\na.off,cup,0.01,y\nb.off,other,1,z\n");
  write("a.off", "OFF\n4 4 0\n0 0 0\n10 0 0\n0 20 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  const auto classes = find_model_classes(root_);
  ASSERT_TRUE(classes) << classes.error().what;
  ASSERT_EQ(classes->size(), 1U) << "other is no class";
  const auto models = read_models((*classes)[0].files.at(0));
  ASSERT_TRUE(models) << models.error().what;
  EXPECT_NEAR(bounds(models->at(0).mesh.vertices).size().z(), 0.2, 1e-9) << "y is up, centimetres";
  EXPECT_NEAR(bounds(models->at(0).mesh.vertices).low.z(), 0, 1e-9);
  EXPECT_NEAR(bounds(read_models((*classes)[0].files.at(0), 0.1)->at(0).mesh.vertices).size().z(), 0.1, 1e-9);
}

// Files are named after classes: a name that leads out of the folder is refused.
TEST_F(ModelCollection, RefusesNamesThatNoFileCanHave) {
  write("m1.off");
  write("a.cla", "PSB 1\n1 1\n../../mug 0 1\n1\n");
  EXPECT_EQ(find_model_classes(root_).error().code, ErrorCode::kCorruptData);
  write("meshes.csv", "file,class,scale_to_m,up_axis\nm1.off,/etc/mug,1,z\n");
  EXPECT_EQ(find_model_classes(root_).error().code, ErrorCode::kCorruptData);
}

TEST_F(ModelCollection, SaysWhatItExpected) {
  EXPECT_EQ(find_model_classes(root_ / "nowhere").error().code, ErrorCode::kNotFound);
  fs::create_directories(root_ / "mug");
  EXPECT_EQ(find_model_classes(root_).error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace gfp
