#pragma once

#include <functional>
#include <memory>

#include "gfp/core/error.hpp"
#include "gfp/scene/scene.hpp"
#include "gfp/v1/scene.pb.h"
#include "wire/mesh_messages.hpp"

namespace gfp::wire {

void fill(const Scene& scene, VertexCoding coding, v1::Scene& message);
void fill(const SceneObject& object, VertexCoding coding, v1::SceneObject& message);

/// One object with what is needed to place it: the payload of /gfp/objects/<id>/.
void fill(const Scene& scene, const SceneObject& object, VertexCoding coding, v1::ObjectUpdate& message);

/// "Object `id` is gone": nothing of it but its id.
void fill_lost(const Scene& scene, std::uint64_t id, v1::ObjectUpdate& message);

/// The topology of a hash; nullptr where it has not arrived yet.
using TopologyLookup = std::function<std::shared_ptr<const Topology>(std::uint64_t hash)>;

/// The Scene that was sent. What does not travel: primitives. An object whose topology is not known has one
/// with its hash and no triangles. Errors: kTooLarge, kCorruptData, kInvalidArgument (camera), kUnsupported.
Result<Scene> scene_from(const v1::Scene& message, const TopologyLookup& topologies);
Result<SceneObject> object_from(const v1::SceneObject& message, const TopologyLookup& topologies);

}  // namespace gfp::wire
