#include "recognition/view_index.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "gfp/recognition/train_views.hpp"

namespace gfp {
namespace {

constexpr double kBandwidth = 1.6;  ///< Of the kernels, in pooled within-pose standard deviations of 28 dimensions.

using SquareMatrix = Eigen::Matrix<double, kDescriptorSize, kDescriptorSize>;

/// The primitive's own views where a program of this version wrote them.
TrainingViews views_of(const Primitive& primitive) {
  return primitive.training_views.descriptor_size == kDescriptorSize && !primitive.training_views.stable_pose.empty() ? primitive.training_views : train_views(primitive);
}

ViewDescriptor descriptor_of(const TrainingViews& views, std::size_t view) {
  return Eigen::Map<const Eigen::Matrix<float, kDescriptorSize, 1>>(views.descriptors.data() + view * kDescriptorSize).cast<double>();
}

SquareMatrix scatter_of(const std::vector<ViewDescriptor>& views) {
  ViewDescriptor mean = ViewDescriptor::Zero();
  for (const auto& d : views) mean += d / static_cast<double>(views.size());
  SquareMatrix scatter = SquareMatrix::Zero();
  for (const auto& d : views) scatter += (d - mean) * (d - mean).transpose();
  return scatter;
}

}  // namespace

ViewIndex::ViewIndex(const PrimitiveLibrary& library) {
  SquareMatrix scatter = SquareMatrix::Zero();
  double samples = 0;
  for (std::size_t p = 0; p < library.all().size(); ++p) {
    const TrainingViews views = views_of(*library.all()[p]);
    std::map<int, Group> by_pose;
    for (std::size_t k = 0; k < views.stable_pose.size(); ++k) by_pose[views.stable_pose[k]].views.push_back(descriptor_of(views, k));
    for (auto& [pose, group] : by_pose) {
      scatter += scatter_of(group.views);
      samples += static_cast<double>(group.views.size()) - 1;
      groups_.push_back({static_cast<int>(p), pose, std::move(group.views)});
    }
  }
  scatter /= std::max(1.0, samples);
  scatter.diagonal().array() += 1e-3;
  whitening_ = scatter.llt().matrixL().solve(SquareMatrix::Identity());
  for (auto& group : groups_)
    for (auto& d : group.views) d = whitening_ * d;
}

std::vector<ViewIndex::Likelihood> ViewIndex::likelihoods(const ViewDescriptor& view) const {
  const ViewDescriptor whitened = whitening_ * view;
  std::vector<Likelihood> result;
  for (const auto& group : groups_) {
    double nearest = 1e300;
    std::vector<double> exponents;
    for (const auto& d : group.views) {
      exponents.push_back((d - whitened).squaredNorm() / (2 * kBandwidth * kBandwidth));
      nearest = std::min(nearest, exponents.back());
    }
    double sum = 0;  // log-sum-exp about the nearest view
    for (const double e : exponents) sum += std::exp(nearest - e);
    result.push_back({group.primitive, group.stable_pose, std::log(sum / static_cast<double>(group.views.size())) - nearest});
  }
  return result;
}

std::shared_ptr<const ViewIndex> view_index(const PrimitiveLibrary& library) {
  static std::mutex mutex;
  static std::map<std::vector<std::uint64_t>, std::shared_ptr<const ViewIndex>> indices;
  std::vector<std::uint64_t> key;
  for (const auto& primitive : library.all()) key.push_back(primitive->content_hash);
  const std::lock_guard lock(mutex);
  auto& index = indices[key];
  if (!index) index = std::make_shared<const ViewIndex>(library);
  return index;
}

}  // namespace gfp
