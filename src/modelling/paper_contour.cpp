#include "modelling/paper_contour.hpp"

#include <algorithm>
#include <cmath>

#include "modelling/density_rules.hpp"
#include "modelling/linear_law.hpp"
#include "modelling/paper_energy.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kMovedM = 1e-4;          ///< Less is no move (P25).
constexpr double kArrivedM = 1e-9;
constexpr double kSteadyEnergy = 1e-3;    ///< Relative change of the energy that counts as none...
constexpr int kSteadyIterations = 3;      ///< ...if it stays so for this long.

struct Control {
  std::int32_t vertex;
  Vector3d target;  ///< Displacement from rest at which it settles.
  Gate alpha, beta;
  bool settled = false;
};

class Contour {
 public:
  Contour(const ContourStart& start, const PaperContourOptions& options)
      : start_(start), options_(options), adjacency_(vertex_adjacency(start.mesh)), edge_m_(mean_edge_length(start.mesh)),
        displacements_(start.mesh.vertices.size(), Vector3d::Zero()) {}

  void find_targets(const PointCount& count, ContourDirections directions) {
    const auto normals = vertex_normals(start_.mesh);
    for (std::size_t i = 0; i < start_.is_control.size(); ++i) {
      if (start_.is_control[i] == 0) continue;
      ++trace_.controls;
      const Vector3d& place = start_.mesh.vertices[i];
      const auto looks = directions == ContourDirections::kGrid26 ? grid_directions(normals[i]) : normal_directions(normals[i]);
      if (const auto candidate = best_candidate(place, looks, count, options_.step_m, start_.search_m))
        controls_.push_back({static_cast<std::int32_t>(i), *candidate - place, {}, {}, false});
      else
        ++trace_.frozen;
    }
  }

  ContourEnd run() {
    const LinearLaw law(start_.mesh, start_.is_control, edge_m_, longest_way());
    record();
    bool converged = controls_.empty();
    int steady = 0;
    for (int iteration = 0; iteration < options_.max_iterations && !converged; ++iteration) {
      const double move = step();
      law.drag(displacements_);
      const double before = trace_.steps.back().energy();
      record();
      const double after = trace_.steps.back().energy();
      steady = std::abs(before - after) < kSteadyEnergy * before ? steady + 1 : 0;
      converged = all_settled() || move < kMovedM || steady >= kSteadyIterations;
    }
    return finish(converged);
  }

 private:
  double longest_way() const {
    double longest = 0;
    for (const Control& control : controls_) longest = std::max(longest, control.target.norm());
    return longest;
  }
  bool all_settled() const {
    return std::all_of(controls_.begin(), controls_.end(), [](const Control& control) { return control.settled; });
  }
  double external(const Control& control, const Vector3d& displacement) const { return (control.target - displacement).squaredNorm() / (edge_m_ * edge_m_); }

  /// Energies in units of their thresholds.
  InternalEnergy internal(const Control& control, const Vector3d& displacement) const {
    InternalEnergy energy = internal_energy(adjacency_, displacements_, control.vertex, displacement);
    energy.continuity /= square(options_.continuity_edges * edge_m_);
    energy.curvature /= square(options_.curvature_edges * edge_m_);
    return energy;
  }
  static double square(double value) { return std::max(value * value, 1e-18); }

  /// One step of every control at once; returns the longest.
  double step() {
    std::vector<Vector3d> next(displacements_);
    double longest = 0;
    for (Control& control : controls_) {
      if (control.settled) continue;
      const Vector3d& here = displacements_[static_cast<std::size_t>(control.vertex)];
      const Vector3d way = control.target - here;
      const double length = std::min(options_.step_m, way.norm());
      const Vector3d there = way.norm() <= options_.step_m + kArrivedM ? control.target : Vector3d(here + length * way.normalized());
      const InternalEnergy old_energy = internal(control, here), new_energy = internal(control, there);
      const double alpha = control.alpha.update(new_energy.continuity), beta = control.beta.update(new_energy.curvature);
      const double old_total = alpha * old_energy.continuity + beta * old_energy.curvature + external(control, here);
      const double new_total = alpha * new_energy.continuity + beta * new_energy.curvature + external(control, there);
      if (new_total > old_total) continue;  // held: its neighbours may follow
      next[static_cast<std::size_t>(control.vertex)] = there;
      control.settled = (control.target - there).norm() <= kArrivedM;
      longest = std::max(longest, length);
    }
    displacements_ = std::move(next);
    return longest;
  }

  void record() {
    ContourStep step;
    for (Control& control : controls_) {
      const Vector3d& here = displacements_[static_cast<std::size_t>(control.vertex)];
      const InternalEnergy energy = internal(control, here);
      Gate alpha = control.alpha, beta = control.beta;  // looking at them must not move them
      if (alpha.update(energy.continuity)) step.continuity += energy.continuity;
      if (beta.update(energy.curvature)) step.curvature += energy.curvature;
      step.external += external(control, here);
      step.settled += control.settled ? 1 : 0;
    }
    step.moved = static_cast<int>(std::count_if(displacements_.begin(), displacements_.end(), [](const Vector3d& u) { return u.norm() > kMovedM; }));
    trace_.steps.push_back(step);
  }

  ContourEnd finish(bool converged) {
    ContourEnd end{start_.mesh.vertices, std::vector<std::uint8_t>(displacements_.size()), std::move(trace_), converged};
    for (std::size_t i = 0; i < displacements_.size(); ++i) {
      end.vertices[i] += displacements_[i];
      end.moved[i] = displacements_[i].norm() > kMovedM ? 1 : 0;
      if (end.moved[i] != 0) ++(start_.is_control[i] != 0 ? end.trace.moved_controls : end.trace.moved_regulars);
    }
    return end;
  }

  const ContourStart& start_;
  const PaperContourOptions& options_;
  VertexAdjacency adjacency_;
  double edge_m_;
  std::vector<Vector3d> displacements_;
  std::vector<Control> controls_;
  ContourTrace trace_;
};

}  // namespace

ContourEnd run_paper_contour(const ContourStart& start, const PointCount& count, const PaperContourOptions& options, ContourDirections directions) {
  Contour contour(start, options);
  contour.find_targets(count, directions);
  return contour.run();
}

}  // namespace gfp
