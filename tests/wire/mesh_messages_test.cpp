#include "wire/mesh_messages.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_scene.hpp"

namespace gfp::wire {
namespace {

FittedModel some_model() {
  Random random(3);
  return test::hand_made_object(1, random).model;
}

TEST(MeshMessages, ATopologyComesBackTheSame) {
  Topology topology = *some_model().topology;
  topology.filled_triangles.pop_back();
  topology.parts[3] = Part::kHandle;
  topology.types[2] = PointType::kRegular;
  v1::Topology message;
  fill(topology, 8, message);
  const auto back = topology_from(message);
  ASSERT_TRUE(back.has_value()) << back.error().what;
  EXPECT_EQ(back->hash, topology.hash);
  EXPECT_EQ(back->triangles, topology.triangles);
  EXPECT_EQ(back->filled_triangles, topology.filled_triangles);
  EXPECT_EQ(back->types, topology.types);
  EXPECT_EQ(back->parts, topology.parts);
}

// A solid body's filled triangles are its triangles: they travel once.
TEST(MeshMessages, EqualFilledTrianglesTravelOnce) {
  v1::Topology message;
  fill(*some_model().topology, 8, message);
  EXPECT_TRUE(message.filled_triangles().empty());
  EXPECT_EQ(topology_from(message)->filled_triangles, some_model().topology->triangles);
}

TEST(MeshMessages, Float32KeepsPositionsToItsRounding) {
  const FittedModel model = some_model();
  v1::Vertices message;
  fill(model, VertexCoding::kFloat32, message);
  EXPECT_EQ(message.positions().size(), 12U * model.vertices.size());
  const auto back = vertices_from(message);
  ASSERT_TRUE(back.has_value()) << back.error().what;
  ASSERT_EQ(back->positions.size(), model.vertices.size());
  for (std::size_t i = 0; i < model.vertices.size(); ++i)
    EXPECT_LE((back->positions[i] - model.vertices[i]).cwiseAbs().maxCoeff(), 0.2 * 6e-8);  // half an ulp at 0.2 m
  EXPECT_EQ(back->states, model.states);
  EXPECT_EQ(back->sigma_m, model.sigma_m);
}

TEST(MeshMessages, Int16IsHalfAsLargeAndErrsByHalfAStep) {
  const FittedModel model = some_model();
  v1::Vertices message;
  fill(model, VertexCoding::kInt16, message);
  EXPECT_EQ(message.positions().size(), 6U * model.vertices.size());
  const auto back = vertices_from(message);
  ASSERT_TRUE(back.has_value()) << back.error().what;
  EXPECT_DOUBLE_EQ(message.scale(), bounds(model.vertices).size().maxCoeff() / 65534.0);
  for (std::size_t i = 0; i < model.vertices.size(); ++i) {
    EXPECT_LE((back->positions[i] - model.vertices[i]).cwiseAbs().maxCoeff(), 0.5 * message.scale() * 1.0001);
    EXPECT_LE(std::abs(back->sigma_m[i] - model.sigma_m[i]), 0.5 * message.sigma_scale() * 1.01);
  }
}

// Vertices are converted several at a time: what is left over at the end is as right as the rest.
TEST(MeshMessages, Int16IsRightForAnyNumberOfVertices) {
  Random random(3);
  for (const std::size_t count : {1U, 2U, 7U, 8U, 9U, 127U, 128U, 129U, 500U}) {
    FittedModel model;
    for (std::size_t i = 0; i < count; ++i) {
      model.vertices.emplace_back(random.uniform(0.1, 0.2), random.uniform(-0.3, -0.2), random.uniform(-0.1, 0.1));
      model.sigma_m.push_back(static_cast<float>(random.uniform(0, 0.01)));
    }
    model.states.assign(count, 1);
    v1::Vertices message;
    fill(model, VertexCoding::kInt16, message);
    const Bounds box = bounds(model.vertices);
    EXPECT_DOUBLE_EQ(message.scale(), std::max(box.size().maxCoeff() / 65534.0, 1e-9)) << count << " vertices";
    const auto back = vertices_from(message);
    ASSERT_TRUE(back.has_value()) << back.error().what;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_LE((back->positions[i] - model.vertices[i]).cwiseAbs().maxCoeff(), 0.5 * message.scale() * 1.0001) << "vertex " << i << " of " << count;
      EXPECT_LE(std::abs(back->sigma_m[i] - model.sigma_m[i]), 0.5 * message.sigma_scale() * 1.01) << "vertex " << i << " of " << count;
    }
  }
}

TEST(MeshMessages, NoVerticesAreNoVertices) {
  FittedModel empty;
  empty.topology = std::make_shared<Topology>();
  for (const VertexCoding coding : {VertexCoding::kFloat32, VertexCoding::kInt16}) {
    v1::Vertices message;
    fill(empty, coding, message);
    const auto back = vertices_from(message);
    ASSERT_TRUE(back.has_value()) << back.error().what;
    EXPECT_TRUE(back->positions.empty());
  }
}

TEST(MeshMessages, WhatDoesNotFitIsRefusedBeforeItIsAllocated) {
  v1::Vertices vertices;
  vertices.set_count(0xFFFFFFFF);
  EXPECT_EQ(vertices_from(vertices).error().code, ErrorCode::kTooLarge);
  vertices.set_count(3);
  EXPECT_EQ(vertices_from(vertices).error().what, "vertices.positions has 0 bytes, expected 36");
  vertices.set_positions(std::string(36, '\xff'));  // NaN
  EXPECT_EQ(vertices_from(vertices).error().what, "vertices.positions are not all finite");
  vertices.set_encoding(static_cast<v1::Vertices::Encoding>(7));
  EXPECT_EQ(vertices_from(vertices).error().code, ErrorCode::kUnsupported);

  v1::Topology topology;
  topology.set_vertex_count(2);
  topology.set_triangles(std::string(13, '\0'));
  EXPECT_EQ(topology_from(topology).error().code, ErrorCode::kCorruptData);
  topology.set_triangles(std::string("\2\0\0\0\0\0\0\0\0\0\0\0", 12));
  EXPECT_EQ(topology_from(topology).error().what, "topology.triangles names vertex 2, expected [0, 2)");
  topology.clear_triangles();
  topology.set_types("\7\0");
  EXPECT_EQ(topology_from(topology).error().code, ErrorCode::kCorruptData);
  topology.set_vertex_count(1U << 30);
  EXPECT_EQ(topology_from(topology).error().code, ErrorCode::kTooLarge);
}

}  // namespace
}  // namespace gfp::wire
