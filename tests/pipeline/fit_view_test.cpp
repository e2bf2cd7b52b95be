#include "gfp/pipeline/fit_view.hpp"

#include <gtest/gtest.h>

#include "pipeline/stage_doubles.hpp"
#include "support/box_model.hpp"

namespace gfp {
namespace {

using test::script;

class FitView : public ::testing::Test {
 protected:
  FitView() { script().reset(); }

  static ObjectView block_view() {
    const auto scene = test::block_scene({{{40, 30, 80, 70}, 0.8}});
    return associate(scene.segments, scene.cloud, scene.normals, scene.frame, {}).front();
  }
  static ObjectView tracked_view(const std::string& class_name, const std::string& method, double cost, int fits) {
    ObjectView view = block_view();
    view.warm_start = WarmStart{class_name, method, Transform::Identity(), Eigen::Vector3d::Ones(), {}, 0, 0, cost, fits, nullptr};
    view.id = 0;  // whose turn it is depends on both
    view.warm_start->model = std::make_shared<const FittedModel>(test::box_model(method, class_name, {0.1, 0.1, 0.1}, cost));
    return view;
  }

  PrimitiveLibrary library = test::library_of({"bowl", "box", "can", "cup", "mug"});
};

// The contour is the dear part: of five placements the best two get one where both may win; so long as it may, the superquadric competes.
TEST_F(FitView, PrunesAfterRegistrationAndKeepsTheSuperquadric) {
  script().cost_of_class = {{"bowl", 5}, {"box", 1.1}, {"can", 1.15}, {"cup", 1}, {"mug", 3}};
  const auto candidates = fit_view(block_view(), library);
  ASSERT_TRUE(candidates);
  ASSERT_EQ(candidates->size(), 3U);
  EXPECT_EQ((*candidates)[0].model.class_name, "cup");
  EXPECT_EQ((*candidates)[1].model.class_name, "box");
  EXPECT_EQ((*candidates)[2].model.method, "superquadric");
  EXPECT_EQ(script().registered, 5);
  EXPECT_EQ(script().contoured, 2);
}

TEST_F(FitView, SparesTheSuperquadricThatCannotWin) {
  script().cost_of_class = {{"bowl", 9}, {"box", 9}, {"can", 9}, {"cup", 1}, {"mug", 9}, {"unknown", 5}};
  EXPECT_EQ(fit_view(block_view(), library)->size(), 1U);
  EXPECT_EQ(script().superquadrics, 0);
}

TEST_F(FitView, WithoutPrimitivesStillGivesAVolume) {
  const auto candidates = fit_view(block_view(), PrimitiveLibrary());
  ASSERT_EQ(candidates->size(), 1U);
  EXPECT_EQ(candidates->front().model.method, "superquadric");
}

TEST_F(FitView, OnlyMovesAKnownObject) {
  const auto candidates = fit_view(tracked_view("mug", "gfp_robust", 1.0, 3), library);
  ASSERT_EQ(candidates->size(), 1U);
  EXPECT_EQ(script().followed, 1);
  EXPECT_EQ(script().registered + script().contoured + script().recognised + script().superquadrics, 0);
}

TEST_F(FitView, ShapesAKnownObjectAnewEveryNowAndThen) {
  PipelineOptions options;
  options.budget.reshape_every = 5;
  for (int fits = 1; fits <= 20; ++fits) fit_view(tracked_view("mug", "gfp_robust", 1.0, fits), library, options);
  EXPECT_EQ(script().contoured, 4);
  EXPECT_EQ(script().followed, 16);
  EXPECT_EQ(script().recognised, 0);
}

TEST_F(FitView, ShapesAKnownObjectAnewWhenItNoLongerFits) {
  script().cost_of_class["mug"] = 1.2;  // more than shape_cost_slack, less than warm_cost_slack
  EXPECT_EQ(fit_view(tracked_view("mug", "gfp_robust", 1.0, 3), library)->size(), 1U);
  EXPECT_EQ(script().contoured, 1);
  EXPECT_EQ(script().recognised, 0);
}

TEST_F(FitView, TakesTurns) {
  PipelineOptions options;
  options.budget.reshape_every = 6;
  for (std::uint64_t id = 1; id <= 6; ++id) {
    ObjectView view = tracked_view("mug", "gfp_robust", 1.0, 3);
    view.id = id;
    fit_view(view, library, options);
  }
  EXPECT_EQ(script().contoured, 1) << "of six objects that came together, one a frame";
}

TEST_F(FitView, FollowsAKnownObjectWithoutASearch) {
  script().cost_of_class["mug"] = 0.5;
  const auto candidates = fit_view(tracked_view("mug", "gfp_robust", 0.5, 6), library);
  ASSERT_EQ(candidates->size(), 1U);
  EXPECT_EQ(candidates->front().model.class_name, "mug");
  EXPECT_EQ(script().contoured, 1);
  EXPECT_EQ(script().recognised, 0);
  EXPECT_EQ(script().superquadrics, 0);
}

TEST_F(FitView, SearchesAnewWhenTheFitGotWorse) {
  script().cost_of_class["mug"] = 2.0;
  EXPECT_EQ(fit_view(tracked_view("mug", "gfp_robust", 0.5, 3), library)->size(), 3U);
  EXPECT_EQ(script().recognised, 1);
}

// Part of a chair is no wine glass, however much less of one the others are: it stays a volume without a name.
TEST_F(FitView, NamesNoClassThatExplainsLessThanHalf) {
  for (const PrimitivePtr& primitive : library.all()) script().cost_of_class[primitive->class_name] = 3.5;
  const auto candidates = fit_view(block_view(), library);
  ASSERT_EQ(candidates->size(), 1U);
  EXPECT_EQ(candidates->front().model.method, "superquadric");
  PipelineOptions told;
  told.recognition.only_class = "mug";
  EXPECT_GT(fit_view(block_view(), library, told)->size(), 1U);
}

TEST_F(FitView, SearchesAnewEveryNowAndThen) {
  PipelineOptions options;
  options.budget.search_every = 10;
  for (int fits = 1; fits <= 20; ++fits) fit_view(tracked_view("mug", "gfp_robust", 1.0, fits), library, options);
  EXPECT_EQ(script().recognised, 2);
}

TEST_F(FitView, SearchesAnewWhenThePrimitiveIsGone) {
  EXPECT_EQ(fit_view(tracked_view("kettle", "gfp_robust", 1.0, 6), library)->size(), 3U);
}

TEST_F(FitView, FollowsASuperquadricAsOne) {
  const auto candidates = fit_view(tracked_view("unknown", "superquadric", 1.0, 6), library);
  ASSERT_EQ(candidates->size(), 1U);
  EXPECT_EQ(script().superquadrics, 1);
  EXPECT_EQ(candidates->front().model.method, "superquadric");
  EXPECT_EQ(script().registered, 0);
}

// The paper knows the class before it fits (P4): one registration, one contour, of the most probable class.
TEST_F(FitView, ThePaperDecidesTheClassFirst) {
  for (const char* method : {"gfp_paper", "gfp_grid26"}) {
    script().reset();
    PipelineOptions options;
    options.method = method;
    const auto candidates = fit_view(block_view(), library, options);
    ASSERT_EQ(candidates->size(), 1U);
    EXPECT_EQ(candidates->front().model.class_name, "bowl");
    EXPECT_EQ(script().registered, 1);
    EXPECT_EQ(script().contoured, 1);
    EXPECT_EQ(script().superquadrics, 0);
  }
  PipelineOptions options;
  options.method = "gfp_paper";
  EXPECT_TRUE(fit_view(block_view(), PrimitiveLibrary(), options)->empty()) << "no class, no primitive, no fit";
}

TEST_F(FitView, MethodsAreFoundByNameAndUnknownOnesNameTheKnown) {
  PipelineOptions options;
  for (const std::string& method : method_names()) {
    options.method = method;
    EXPECT_TRUE(validate(options)) << method;
    EXPECT_TRUE(fit_view(block_view(), library, options)) << method;
  }
  options.method = "guess";
  for (const Error& error : {fit_view(block_view(), library, options).error(), validate(options).error()}) {
    EXPECT_EQ(error.code, ErrorCode::kNotFound);
    EXPECT_EQ(error.what, "method = guess, expected one of gfp_robust, gfp_paper, gfp_grid26, sphere_snake, superquadric, multi_superquadric, simple_primitive, nearest_instance");
  }
  options = {};
  options.profile = "paperback";
  EXPECT_EQ(validate(options).error().what, "profile = paperback, expected one of robust, paper");
}

TEST_F(FitView, TimesItsStages) {
  StageTimings timings;
  fit_view(block_view(), library, {}, &timings);
  for (const char* stage : {"recognition", "registration", "modelling", "superquadric"}) EXPECT_TRUE(timings.ms().contains(stage)) << stage;
}

}  // namespace
}  // namespace gfp
