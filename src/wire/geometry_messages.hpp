#pragma once

#include <string>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/error.hpp"
#include "gfp/core/time.hpp"
#include "gfp/core/transform.hpp"
#include "gfp/v1/geometry.pb.h"

namespace gfp::wire {

void fill(const Eigen::Vector3d& vector, v1::Vector3& message);
void fill(const Transform& transform, v1::Transform& message);
void fill(const CameraModel& camera, v1::Camera& message);

/// The frame of a sensor's coordinates, in messages: `<sensor>_optical`.
inline std::string frame_id_of(const std::string& sensor) { return sensor + "_optical"; }

/// Which capture: everything but the Envelope's session.
void fill(const std::string& sensor, std::uint64_t sequence, const Stamps& stamps, v1::FrameHeader& message);

Eigen::Vector3d vector_from(const v1::Vector3& message);
Stamps stamps_from(const v1::FrameHeader& message);

/// Errors: kCorruptData, naming `what`: not 16 numbers, not finite or not rigid (rotation to 1e-6).
Result<Transform> transform_from(const v1::Transform& message, const char* what);

/// Errors: kInvalidArgument as validate(CameraModel), kTooLarge (more than 64 coefficients).
Result<CameraModel> camera_from(const v1::Camera& message);

}  // namespace gfp::wire
