#include "gfp/collection/build_primitive.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <numeric>

#include "collection/cavity.hpp"
#include "collection/find_symmetry.hpp"
#include "collection/morph.hpp"
#include "gfp/collection/close_surface.hpp"
#include "gfp/core/simplified.hpp"
#include "gfp/evaluation/surface_samples.hpp"
#include "gfp/primitive/primitive_of_members.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr int kYaws = 24;              ///< Turns looked at when two members are compared.
constexpr int kCandidates = 6;         ///< Members of which the most typical one becomes the template.
constexpr int kTemplates = 3;          ///< Of the candidates, at most so many are tried, until one reaches all members well.
constexpr int kCompareSamples = 300, kResidualSamples = 2000;
constexpr double kFarOff = 0.15;        ///< In the unit cube: points farther from the template are all as bad.
constexpr double kWellReached = 0.004;   ///< Mean residual at which no other template is tried.
constexpr int kMostHoles = 3;
constexpr std::size_t kMostShapes = 60;  ///< Members with their symmetric copies.
constexpr double kBaseShare = 0.05;    ///< Of the height: the origin is the middle of what is lower.
constexpr double kDoubtMembers = 2;    ///< Weight of the general priors of size and unexplained shape.

/// A model on its way.
struct Member {
  std::size_t model = 0;
  TriangleMesh surface;  ///< Closed.
};

/// Counts finished steps.
class Steps {
 public:
  Steps(int of, const std::function<void(int, int)>& progress) : of_(of), progress_(progress) {}
  void done() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (progress_) progress_(std::min(done_, of_), of_);
  }
  void finish() {
    if (done_ < of_) progress_ ? progress_(of_, of_) : void();
  }

 private:
  std::mutex mutex_;
  int done_ = 0, of_;
  const std::function<void(int, int)>& progress_;
};

int genus(const TriangleMesh& mesh) { return 1 - (static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh.triangles.size()) / 2) / 2; }

/// In the cube [-1/2, 1/2]^3: heights and widths differ within a class, the turn must not depend on them, and the morph starts like this too.
std::vector<Vector3d> in_unit_cube(std::vector<Vector3d> points) {
  const Bounds box = bounds(points);
  const Vector3d size = box.size().cwiseMax(1e-9), centre = box.centre();
  for (Vector3d& p : points) p = (p - centre).cwiseQuotient(size);
  return points;
}

struct Agreement {
  double distance = std::numeric_limits<double>::infinity(), yaw_rad = 0;
};

/// The turn of a member that brings it nearest to the template, which is in the unit cube; `points`: the member's, even by area.
Agreement best_turn(const TriangleTree& template_tree, const std::vector<Vector3d>& points) {
  Agreement best;
  std::vector<Vector3d> moved(points.size());
  const auto look = [&](double yaw_rad) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
    for (std::size_t i = 0; i < points.size(); ++i) moved[i] = turn * points[i];
    double sum = 0;
    for (const Vector3d& p : in_unit_cube(moved)) sum += std::min(kFarOff, template_tree.closest(p, kFarOff).distance_m);
    const double distance = sum / static_cast<double>(std::max<std::size_t>(1, points.size()));
    if (distance < best.distance - 1e-9) best = {distance, yaw_rad};
  };
  double step = 2 * std::numbers::pi / kYaws;
  for (int k = 0; k < kYaws; ++k) look(k * step);
  for (int k = 0; k < 4; ++k) {
    step *= 0.5;
    const double around = best.yaw_rad;
    look(around - step);
    look(around + step);
  }
  return best;
}

TriangleMesh turned(TriangleMesh mesh, double yaw_rad) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  for (Vector3d& v : mesh.vertices) v = turn * v;
  const Bounds box = bounds(mesh.vertices);
  const Vector3d base(box.centre().x(), box.centre().y(), box.low.z());
  for (Vector3d& v : mesh.vertices) v -= base;
  return mesh;
}

/// Closes one model and says what it is.
Result<TriangleMesh> close_model(const CollectionModel& model, const CloseSurfaceOptions& options, MemberReport& report) {
  report.name = model.name;
  auto closed = model.unreadable.empty() ? close_surface(model.mesh, options) : Result<TriangleMesh>(failure(ErrorCode::kCorruptData, model.unreadable));
  if (!closed) {
    report.rejected = closed.error().what;
    return closed;
  }
  report.genus = genus(*closed);
  report.volume_m3 = signed_volume(*closed);
  report.size_m = bounds(closed->vertices).size();
  report.surface = turned(*closed, 0);
  return closed;
}

/// The genus that most models have; of several, the lowest.
int usual_genus(const std::vector<MemberReport>& reports) {
  std::map<int, int> count;
  for (const MemberReport& report : reports)
    if (report.rejected.empty()) ++count[report.genus];
  const auto most = std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count.end() ? 0 : most->first;
}

/// Every model of the usual genus as a closed surface, and what is wrong with the others. A model with more holes than usual is closed again, with
/// its tunnels sealed: scans have some that things do not have. So is one with more holes than things have.
std::vector<Member> close_all(const std::vector<CollectionModel>& models, const BuildPrimitiveOptions& options, std::vector<MemberReport>& reports, Steps& steps,
                              const std::stop_token& stop) {
  std::vector<Result<TriangleMesh>> closed(models.size(), TriangleMesh{});
  CloseSurfaceOptions closing{.voxels = options.voxels, .vertices = 4 * options.vertices};
  oneapi::tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t k) {
    if (!stop.stop_requested()) closed[k] = close_model(models[k], closing, reports[k]);
    steps.done();
  });
  int usual = usual_genus(reports);
  closing.as_is = false;
  oneapi::tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t k) {
    if (stop.stop_requested() || !reports[k].rejected.empty() || reports[k].genus <= std::min(usual, kMostHoles)) return;
    MemberReport sealed;
    auto again = close_model(models[k], closing, sealed);
    if (again && sealed.genus < reports[k].genus) closed[k] = std::move(again), reports[k] = std::move(sealed);
  });
  usual = usual_genus(reports);
  std::vector<Member> members;
  for (std::size_t k = 0; k < models.size(); ++k) {
    if (!reports[k].rejected.empty()) continue;
    if (reports[k].genus == usual) members.push_back({k, std::move(*closed[k])});
    else reports[k].rejected = "genus " + std::to_string(reports[k].genus) + ", most of the class have " + std::to_string(usual);
  }
  return members;
}

/// Members that may become the template, the most typical first, and how all members agree with each.
struct Candidate {
  std::size_t member = 0;
  double mirror_yaw_rad = 0;         ///< Turns it so that its mirror plane is y = 0.
  std::vector<Agreement> agreement;  ///< Turns that bring the members to it, turned like that.
  double distance = 0;
};

std::vector<Candidate> rank_candidates(const std::vector<Member>& members, Steps& steps) {
  std::vector<std::vector<Vector3d>> points(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) points[m] = sample_surface(members[m].surface, kCompareSamples, 1).points;
  std::vector<Candidate> candidates(std::min<std::size_t>(kCandidates, members.size()));
  oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t c) {
    Candidate& candidate = candidates[c];
    candidate.member = c * members.size() / candidates.size();
    candidate.agreement.resize(members.size());
    candidate.mirror_yaw_rad = yaw_of_mirror_plane(turned(members[candidate.member].surface, 0));
    TriangleMesh unit = turned(members[candidate.member].surface, candidate.mirror_yaw_rad);
    unit.vertices = in_unit_cube(std::move(unit.vertices));
    const TriangleTree tree(unit);
    oneapi::tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t m) {
      candidate.agreement[m] = m == candidate.member ? Agreement{0, candidate.mirror_yaw_rad} : best_turn(tree, points[m]);
    });
    for (const Agreement& a : candidate.agreement) candidate.distance += a.distance;
    steps.done();
  });
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  return candidates;
}

/// A template and what it made of the members.
struct Trial {
  std::size_t member = 0;                     ///< The template.
  TriangleMesh shape;
  std::vector<std::vector<Vector3d>> shapes;  ///< Per member.
  std::vector<TriangleMesh> surfaces;         ///< Per member, turned alike.
  std::vector<double> residuals;              ///< Per member.

  int reached(double max_residual) const {
    return static_cast<int>(std::count_if(residuals.begin(), residuals.end(), [=](double residual) { return residual <= max_residual; }));
  }
  double distance() const { return std::accumulate(residuals.begin(), residuals.end(), 0.0); }
};

Result<Trial> morph_onto_all(const std::vector<Member>& members, const Candidate& candidate, const BuildPrimitiveOptions& options, const std::stop_token& stop, Steps* steps) {
  auto shape = simplified(turned(members[candidate.member].surface, candidate.mirror_yaw_rad), options.vertices);
  if (!shape) return tl::unexpected(shape.error());
  Trial trial{candidate.member, std::move(*shape), std::vector<std::vector<Vector3d>>(members.size()), std::vector<TriangleMesh>(members.size()), std::vector<double>(members.size(), 1.0)};
  oneapi::tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t m) {
    if (stop.stop_requested()) return;
    trial.surfaces[m] = turned(members[m].surface, candidate.agreement[m].yaw_rad);
    const TriangleTree tree(trial.surfaces[m]);
    trial.shapes[m] = morph(trial.shape, trial.surfaces[m], tree);
    const TriangleMesh morphed{trial.shapes[m], trial.shape.triangles};
    trial.residuals[m] = surface_distance_m(morphed, TriangleTree(morphed), trial.surfaces[m], tree, kResidualSamples) / bounds(trial.surfaces[m].vertices).size().maxCoeff();
    if (steps) steps->done();
  });
  return trial;
}

/// The template that reaches most members, and those best.
Result<Trial> best_trial(const std::vector<Member>& members, const BuildPrimitiveOptions& options, Steps& steps, const std::stop_token& stop) {
  const std::vector<Candidate> candidates = rank_candidates(members, steps);
  Result<Trial> best = failure(ErrorCode::kDegenerateGeometry, "no template");
  for (std::size_t c = 0; c < std::min<std::size_t>(kTemplates, candidates.size()) && !stop.stop_requested(); ++c) {
    auto trial = morph_onto_all(members, candidates[c], options, stop, c == 0 ? &steps : nullptr);
    if (!trial) {
      if (!best) best = std::move(trial);
      continue;
    }
    const int reached = trial->reached(options.max_residual);
    if (!best || reached > best->reached(options.max_residual) || (reached == best->reached(options.max_residual) && trial->distance() < best->distance())) best = std::move(trial);
    if (best->reached(options.max_residual) == static_cast<int>(members.size()) && best->distance() <= kWellReached * static_cast<double>(members.size())) break;
  }
  return best;
}

/// The members that the template reached.
ClassMembers kept_members(const Trial& trial, const std::vector<Member>& members, const BuildPrimitiveOptions& options, std::vector<MemberReport>& reports) {
  ClassMembers kept;
  kept.triangles = trial.shape.triangles;
  for (std::size_t m = 0; m < members.size(); ++m) {
    MemberReport& report = reports[members[m].model];
    report.residual = trial.residuals[m];
    report.size_m = bounds(trial.surfaces[m].vertices).size();
    report.surface = trial.surfaces[m];
    if (report.residual > options.max_residual)
      report.rejected = "residual = " + std::to_string(report.residual) + " of its size, expected at most " + std::to_string(options.max_residual);
    else
      kept.shapes.push_back(trial.shapes[m]);
  }
  return kept;
}

TriangleMesh moved(const TriangleMesh& mesh, const Eigen::Matrix3d& motion) {
  TriangleMesh result = mesh;
  for (Vector3d& v : result.vertices) v = motion * v;
  if (motion.determinant() < 0)
    for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
  return result;
}

/// The turns and reflections that leave a class where it is, without the one that does nothing; some of them for a class of revolution.
std::vector<Eigen::Matrix3d> motions_of(const Symmetry& symmetry) {
  constexpr int kOfRevolution = 5;  // odd, so that no ring of vertices falls onto itself
  std::vector<Eigen::Matrix3d> motions;
  const int turns = symmetry.revolution ? kOfRevolution : symmetry.cyclic;
  for (int k = 0; k < turns; ++k) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2 * std::numbers::pi * k / turns, Vector3d::UnitZ()).toRotationMatrix();
    if (k > 0) motions.push_back(turn);
    if (symmetry.mirror_y) motions.push_back(turn * Vector3d(1, -1, 1).asDiagonal());
    else if (symmetry.mirror_x) motions.push_back(turn * Vector3d(-1, 1, 1).asDiagonal());
  }
  return motions;
}

/// Moved by what leaves the class where it is, a member is another one of it: the average and the modes become as symmetric as the class.
void add_symmetric_copies(const Trial& trial, const Symmetry& symmetry, const BuildPrimitiveOptions& options, ClassMembers& members) {
  std::vector<const TriangleMesh*> surfaces;
  for (std::size_t m = 0; m < trial.surfaces.size(); ++m)
    if (trial.residuals[m] <= options.max_residual) surfaces.push_back(&trial.surfaces[m]);
  const std::vector<Eigen::Matrix3d> motions = motions_of(symmetry);
  const std::size_t copies = std::min(motions.size(), kMostShapes / surfaces.size());
  std::vector<std::vector<Vector3d>> shapes(copies * surfaces.size());
  oneapi::tbb::parallel_for(std::size_t{0}, shapes.size(), [&](std::size_t k) {
    const TriangleMesh surface = moved(*surfaces[k % surfaces.size()], motions[k / surfaces.size()]);
    shapes[k] = morph(trial.shape, surface, TriangleTree(surface));
  });
  for (auto& shape : shapes) members.shapes.push_back(std::move(shape));
}

/// Where the template stands on the ground, every member does: the middle of those vertices is its origin. Returns the size.
Vector3d put_on_base(const TriangleMesh& shape, std::vector<Vector3d>& points) {
  const Bounds box = bounds(shape.vertices), whole = bounds(points);
  Bounds base;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (shape.vertices[i].z() <= box.low.z() + kBaseShare * box.size().z()) base.include(points[i]);
  for (Vector3d& p : points) p -= Vector3d(base.centre().x(), base.centre().y(), whole.low.z());
  return whole.size();
}

TriangleMesh mean_of(const ClassMembers& members) {
  TriangleMesh mean{std::vector<Vector3d>(members.shapes.front().size(), Vector3d::Zero()), members.triangles};
  for (const auto& points : members.shapes)
    for (std::size_t i = 0; i < points.size(); ++i) mean.vertices[i] += points[i] / static_cast<double>(members.shapes.size());
  return mean;
}

Error too_few(const std::string& name, std::size_t kept, const std::vector<MemberReport>& reports) {
  std::string message = name + ": members kept = " + std::to_string(kept) + " of " + std::to_string(reports.size()) + ", expected at least " + std::to_string(std::min<std::size_t>(2, reports.size()));
  for (const MemberReport& report : reports)
    if (!report.rejected.empty()) message += "; " + report.name + ": " + report.rejected;
  return {ErrorCode::kTooFewPoints, message};
}

const Error kStopped{ErrorCode::kTimeout, "stopped"};

}  // namespace

Result<BuiltPrimitive> build_primitive(const std::string& name, const std::vector<CollectionModel>& models, const BuildPrimitiveOptions& options,
                                       const std::function<void(int, int)>& progress, const std::stop_token& stop, std::vector<MemberReport>* members_out) {
  BuiltPrimitive built;
  built.members.resize(models.size());
  const auto refuse = [&](Error error) {
    if (members_out) *members_out = built.members;
    return tl::unexpected(std::move(error));
  };
  const std::size_t least = std::min<std::size_t>(2, models.size());
  Steps steps(2 * static_cast<int>(models.size()) + std::min<int>(kCandidates, static_cast<int>(models.size())), progress);
  const std::vector<Member> members = close_all(models, options, built.members, steps, stop);
  if (stop.stop_requested()) return refuse(kStopped);
  if (members.size() < std::max<std::size_t>(1, least)) return refuse(too_few(name, members.size(), built.members));
  auto trial = best_trial(members, options, steps, stop);
  if (stop.stop_requested()) return refuse(kStopped);
  if (!trial) return refuse(trial.error());
  ClassMembers kept = kept_members(*trial, members, options, built.members);
  if (kept.shapes.size() < std::max<std::size_t>(1, least)) return refuse(too_few(name, kept.shapes.size(), built.members));

  const std::size_t count = kept.shapes.size();
  const Symmetry symmetry = find_symmetry(mean_of(kept));
  add_symmetric_copies(*trial, symmetry, options, kept);
  if (stop.stop_requested()) return refuse(kStopped);
  for (auto& points : kept.shapes) kept.sizes_m.push_back(put_on_base(trial->shape, points));
  kept.sound = trial->shape.vertices;
  kept.sound_size_m = put_on_base(trial->shape, kept.sound);
  const TriangleMesh mean = mean_of(kept);
  std::vector<Vector3d> canonical_mean(mean.vertices.size(), Vector3d::Zero());
  for (std::size_t m = 0; m < kept.shapes.size(); ++m)
    for (std::size_t i = 0; i < canonical_mean.size(); ++i) canonical_mean[i] += kept.shapes[m][i].cwiseQuotient(kept.sizes_m[m]) / static_cast<double>(kept.shapes.size());
  Cavity cavity = find_cavity(mean);
  kept.parts = std::move(cavity.parts);
  kept.filled_triangles = std::move(cavity.filled_triangles);
  built.primitive = primitive_of_members(kept, {.name = name,
                                                .class_name = name,
                                                .aliases = {},
                                                .symmetry = symmetry,
                                                .genus = genus(mean),
                                                .hollow = cavity.found,
                                                .upright_share = options.upright_share,
                                                .members = static_cast<int>(count),
                                                .doubt_members = kDoubtMembers,
                                                .provenance = {"collection " + name, "as its members", static_cast<int>(count)}});
  built.template_member = members[trial->member].model;
  for (std::size_t i = 0; i < mean.vertices.size(); ++i) built.mean_moved = std::max(built.mean_moved, (canonical_mean[i] - built.primitive.mean[i]).norm());
  steps.finish();
  if (members_out) *members_out = built.members;
  return built;
}

}  // namespace gfp
