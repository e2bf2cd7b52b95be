#include "gfp/registration/register_primitive.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <span>

#include "gfp/memory/image_score.hpp"
#include "gfp/primitive/class_distance.hpp"
#include "registration/pose_search.hpp"
#include "registration/visible_fit.hpp"

// A race. Every stable pose and yaw of every hypothesis gets a size and a place on the coarse grid; the best are refined there, the best
// of those on the fine grid, which decides. What trails too far is out, whatever hypothesis it belongs to: right classes fit early.

namespace gfp {
namespace {

constexpr int kSearchCells = 280;       ///< Object cells of the search grid.
constexpr int kCoarseSteps = 8;         ///< Of the refinement on the search grid.
constexpr double kCoarseSigmaM = 0.006; ///< With which placements on the search grid are scored.
constexpr int kYawsPerPose = 3;         ///< Of a scan that stay in the race.
constexpr double kFarBehind = 1.5;      ///< Score by which an unrefined contender may trail the best.
constexpr double kHopeless = 0.5;       ///< The same once it is refined on the coarse grid.
constexpr double kTwinM = 0.01;         ///< Corners of bounding boxes of the same placement.
constexpr int kHolds = 4;               ///< Times that modes are held in,
constexpr double kHeldShare = 0.75;     ///< to this share of the largest each time;
constexpr double kNeverFolds = 1.5;     ///< nearer to the mean no class folds.
constexpr int kStalled = 3;              ///< Steps without a better score: re-association jitters about the optimum.
constexpr double kConvergedStep = 2e-4; ///< Metres, radians and log sizes alike: well below the noise.

/// How one stage of the race refines: from rough to tight.
struct Refinement {
  int iterations;
  double first_robust_m, last_robust_m;  ///< Residuals beyond this lose their say.
  double model_sigma_m = kModelSigmaM;   ///< With which placements are scored.
};

/// Gauss-Newton with annealed robust scale; keeps the best state seen, by the score on this grid. Returns the number of steps.
int refine(VisibleFit& fit, ScoredState& best, const Refinement& stage, bool& converged) {
  PoseState state = best.state;
  double robust = stage.first_robust_m, damping = 1e-3;
  converged = false;
  int k = 0, since_best = 0;
  fit.pose(state);
  best.score = fit.score(stage.model_sigma_m);
  for (; k < stage.iterations; ++k) {
    const Eigen::VectorXd step = fit.step({.robust_m = robust}, damping);
    state.apply(step);
    fit.pose(state);
    const double score = fit.score(stage.model_sigma_m);
    const bool better = score < best.score;
    if (better) best = {state, best.stable_pose, score};
    since_best = better ? 0 : since_best + 1;
    damping = better ? std::max(1e-4, damping * 0.5) : std::min(1.0, damping * 4);
    robust = std::max(stage.last_robust_m, 0.6 * robust);
    if (robust == stage.last_robust_m && step.head<PoseState::kShape>().cwiseAbs().maxCoeff() < kConvergedStep) converged = true;
    if (robust == stage.last_robust_m && since_best >= kStalled) converged = true;
    if (converged) break;
  }
  fit.pose(best.state);
  best.score = fit.score(stage.model_sigma_m);
  return k;
}

bool crosses_itself(const Primitive& primitive, const PoseState& state) {
  const std::vector<double> modes(state.modes.data(), state.modes.data() + state.modes.size());
  return count_self_intersections({shape(primitive, state.log_size.array().exp().matrix(), modes), primitive.topology->triangles}, 1) > 0;
}

/// What a state costs under the class, nats.
double prior_energy(const Primitive& primitive, const PoseState& state) { return 0.5 * class_distance_squared(primitive, state.log_size, state.modes); }

/// A hypothesis that names no stable pose leaves all of them open.
std::vector<int> poses_to_try(const Hypothesis& hypothesis) {
  if (!hypothesis.stable_poses.empty()) return hypothesis.stable_poses;
  std::vector<int> all(hypothesis.primitive->stable_poses.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::optional<ScoredState> warm_state(const ObjectView& view, const Primitive& primitive) {
  if (!view.warm_start || view.warm_start->primitive != primitive.name) return std::nullopt;
  ScoredState scored;
  scored.state.T_support_object = view.T_camera_support.inverse() * view.warm_start->T_camera_object;
  scored.state.log_size = view.warm_start->scale.array().log().matrix();
  scored.state.modes.setZero(static_cast<Eigen::Index>(primitive.modes.size()));
  for (std::size_t k = 0; k < std::min(primitive.modes.size(), view.warm_start->modes.size()); ++k)
    scored.state.modes[static_cast<Eigen::Index>(k)] = view.warm_start->modes[k];
  scored.stable_pose = view.warm_start->stable_pose;
  return scored;
}

Placement to_placement(const ObjectView& view, const PrimitivePtr& primitive, VisibleFit& fit, const ScoredState& scored, int pixels) {
  Placement placement;
  placement.primitive = primitive;
  placement.T_camera_object = view.T_camera_support * scored.state.T_support_object;
  placement.size_m = scored.state.log_size.array().exp().matrix();
  placement.modes.assign(scored.state.modes.data(), scored.state.modes.data() + scored.state.modes.size());
  placement.stable_pose = scored.stable_pose;
  const double effective_pixels = std::min(kScorePixels, static_cast<double>(std::max(1, pixels)));
  placement.cost = scored.score + prior_energy(*primitive, scored.state) / effective_pixels;
  fit.pose(scored.state);
  fit.step({.robust_m = 0.006}, 0);
  placement.covariance = fit.information().ldlt().solve(Eigen::MatrixXd::Identity(scored.state.unknowns(), scored.state.unknowns()));
  return placement;
}

/// The yaws about the found one that explain the view as well: a hidden handle gives a range (ALGORITHM 1.6).
void find_yaw_interval(VisibleFit& fit, const PoseState& found, const Primitive& primitive, Placement& placement) {
  const bool upright = std::abs(found.T_support_object.linear()(2, 2)) > 0.99;
  if (upright && primitive.symmetry.revolution) {
    placement.yaw_low_rad = -std::numbers::pi;
    placement.yaw_high_rad = std::numbers::pi;
    return;
  }
  constexpr double kStep = std::numbers::pi / 24;
  constexpr double kAsGood = 0.04;  ///< Of the score: about 15 effective pixels' half log likelihoods.
  fit.pose(found);
  const double limit = fit.score() + kAsGood;
  const auto reach = [&](double direction) {
    for (int k = 1; k <= 24; ++k) {
      PoseState turned = found;
      turned.T_support_object.linear() = Eigen::AngleAxisd(direction * k * kStep, Eigen::Vector3d::UnitZ()) * found.T_support_object.linear();
      fit.pose(turned);
      if (fit.score() > limit) return direction * (k - 0.5) * kStep;
    }
    return direction * std::numbers::pi;
  };
  placement.yaw_low_rad = reach(-1);
  placement.yaw_high_rad = reach(1);
}

/// One of the placements that still may win.
struct Contender {
  std::size_t hypothesis = 0;
  ScoredState scored;
  double standing = 0;  ///< Score plus what size and modes cost under the class; lower is better.
  int iterations = 0;
  bool converged = false;
};

class Race {
 public:
  Race(const ObjectView& view, std::span<const Hypothesis> hypotheses, const RegistrationOptions& options)
      : view_(view), hypotheses_(hypotheses), options_(options), fine_tiles_(search_tiles(view, options.sample_pixels)), coarse_tiles_(search_tiles(view, kSearchCells)) {
    for (const Hypothesis& hypothesis : hypotheses) {
      coarse_.emplace_back(coarse_tiles_, *hypothesis.primitive, view.has_support);
      fine_.emplace_back(fine_tiles_, *hypothesis.primitive, view.has_support);
    }
  }

  /// What the last frame knew joins; true where that alone is good enough.
  bool follow() {
    constexpr double kStillGood = 1.2;  // score up to which a warm start is trusted
    for (std::size_t h = 0; h < hypotheses_.size(); ++h)
      if (auto warm = warm_state(view_, *hypotheses_[h].primitive)) contenders_.push_back({h, std::move(*warm)});
    if (contenders_.empty()) return false;
    refine_all(fine_, {std::min(6, options_.max_iterations), 0.006, 0.004});
    return hypotheses_.size() == 1 && contenders_.front().scored.score <= kStillGood;
  }

  void search() {
    const ObservedExtent extent = observed_extent(view_, coarse_tiles_.front());
    std::vector<std::vector<Contender>> found(hypotheses_.size());
    oneapi::tbb::parallel_for(std::size_t{0}, hypotheses_.size(), [&](std::size_t h) { found[h] = scan(h, extent); });
    for (auto& of_hypothesis : found) std::move(of_hypothesis.begin(), of_hypothesis.end(), std::back_inserter(contenders_));
    drop(kFarBehind, static_cast<std::size_t>(options_.keep + 6));
    refine_all(coarse_, {kCoarseSteps, 0.03, 0.008, kCoarseSigmaM});
    drop_twins();
    drop(kHopeless, static_cast<std::size_t>(options_.keep));
    const Refinement last{options_.max_iterations, 0.012, 0.004};
    refine_all(fine_, last);
    hold_modes_in(last);
    drop(kFarBehind, static_cast<std::size_t>(options_.keep));
  }

  std::vector<Placement> placements() {
    std::vector<Placement> result;
    std::vector<bool> has_yaw(hypotheses_.size(), false);
    for (const Contender& contender : contenders_) {
      const std::size_t h = contender.hypothesis;
      result.push_back(to_placement(view_, hypotheses_[h].primitive, fine_[h], contender.scored, view_.object_pixels));
      result.back().hypothesis = static_cast<int>(h);
      result.back().iterations = contender.iterations;
      result.back().converged = contender.converged;
      if (!has_yaw[h]) find_yaw_interval(coarse_[h], contender.scored.state, *hypotheses_[h].primitive, result.back());
      has_yaw[h] = true;
    }
    return result;
  }

 private:
  std::vector<Contender> scan(std::size_t h, const ObservedExtent& extent) {
    const Primitive& primitive = *hypotheses_[h].primitive;
    std::vector<Contender> found;
    for (const int pose : poses_to_try(hypotheses_[h]))
      for (auto& scored : search_yaws(coarse_[h], extent, primitive, pose, options_.yaw_steps, kYawsPerPose)) found.push_back({h, std::move(scored)});
    return found;
  }

  /// Hypotheses in parallel; the contenders of one share its fit.
  void refine_all(std::vector<VisibleFit>& fits, const Refinement& stage) {
    oneapi::tbb::parallel_for(std::size_t{0}, fits.size(), [&](std::size_t h) {
      for (Contender& contender : contenders_) {
        if (contender.hypothesis == h) contender.iterations = refine(fits[h], contender.scored, stage, contender.converged);
      }
    });
  }

  /// A class stretched too far folds into itself. Its modes are held in until it does not, and the rest is fitted anew around them.
  void hold_modes_in(const Refinement& stage) {
    for (Contender& contender : contenders_) {
      const Primitive& primitive = *hypotheses_[contender.hypothesis].primitive;
      PoseState& state = contender.scored.state;
      for (int k = 0; k < kHolds && state.modes.size() > 0 && state.modes.cwiseAbs().maxCoeff() > kNeverFolds && crosses_itself(primitive, state); ++k) {
        state.largest_mode = kHeldShare * state.modes.cwiseAbs().maxCoeff();
        state.apply(Eigen::VectorXd::Zero(state.unknowns()));
        contender.iterations += refine(fine_[contender.hypothesis], contender.scored, stage, contender.converged);
      }
    }
  }

  /// Sorts by standing; keeps at most `count`, none of which trails the best by more than `margin`.
  void drop(double margin, std::size_t count) {
    for (Contender& contender : contenders_) {
      contender.standing = contender.scored.score + prior_energy(*hypotheses_[contender.hypothesis].primitive, contender.scored.state) / kScorePixels;
    }
    std::stable_sort(contenders_.begin(), contenders_.end(), [](const Contender& a, const Contender& b) { return a.standing < b.standing; });
    const double limit = contenders_.front().standing + margin;
    std::erase_if(contenders_, [&](const Contender& contender) { return contender.standing > limit; });
    if (contenders_.size() > count) contenders_.resize(count);
  }

  /// A box on its side is a box: of contenders of one primitive that fill the same space, the first stays.
  void drop_twins() {
    std::stable_sort(contenders_.begin(), contenders_.end(), [](const Contender& a, const Contender& b) { return a.scored.score < b.scored.score; });
    std::vector<Bounds> filled;
    std::vector<Contender> different;
    for (Contender& contender : contenders_) {
      coarse_[contender.hypothesis].pose(contender.scored.state);
      const Bounds box = coarse_[contender.hypothesis].bounds_support();
      bool twin = false;
      for (std::size_t k = 0; k < different.size(); ++k)
        twin = twin || (different[k].hypothesis == contender.hypothesis && std::max((filled[k].low - box.low).norm(), (filled[k].high - box.high).norm()) < kTwinM);
      if (twin) continue;
      filled.push_back(box);
      different.push_back(std::move(contender));
    }
    contenders_ = std::move(different);
  }

  const ObjectView& view_;
  std::span<const Hypothesis> hypotheses_;
  const RegistrationOptions& options_;
  std::vector<SearchTile> fine_tiles_, coarse_tiles_;
  std::vector<VisibleFit> coarse_, fine_;
  std::vector<Contender> contenders_;
};

}  // namespace

std::vector<Placement> register_hypotheses(const ObjectView& view, std::span<const Hypothesis> hypotheses, const RegistrationOptions& options) {
  if (hypotheses.empty()) return {};
  Race race(view, hypotheses, options);
  if (!race.follow()) race.search();
  return race.placements();
}

std::vector<Placement> register_primitive(const ObjectView& view, const Hypothesis& hypothesis, const RegistrationOptions& options) {
  return register_hypotheses(view, {&hypothesis, 1}, options);
}

}  // namespace gfp
