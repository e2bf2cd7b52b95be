#include "wire/schema.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <gtest/gtest.h>

#include "gfp/v1/envelope.pb.h"
#include "gfp/v1/scene.pb.h"
#include "support/hand_made_scene.hpp"
#include "wire/scene_messages.hpp"

namespace gfp::wire {
namespace {

// What a client without generated code does: builds the message from the descriptor set alone and decodes with it.
TEST(Schema, TheDescriptorSetSufficesToDecode) {
  google::protobuf::FileDescriptorSet files;
  ASSERT_TRUE(files.ParseFromString(descriptor_set(*v1::Scene::descriptor())));
  google::protobuf::DescriptorPool pool;
  for (const auto& file : files.file()) ASSERT_NE(pool.BuildFile(file), nullptr) << file.name();
  google::protobuf::DynamicMessageFactory factory;
  const auto* descriptor = pool.FindMessageTypeByName("gfp.v1.Scene");
  ASSERT_NE(descriptor, nullptr);
  const std::unique_ptr<google::protobuf::Message> message(factory.GetPrototype(descriptor)->New());
  v1::Scene scene;
  fill(test::hand_made_scene(2), VertexCoding::kFloat32, scene);
  ASSERT_TRUE(message->ParseFromString(scene.SerializeAsString()));
  EXPECT_EQ(message->GetReflection()->FieldSize(*message, descriptor->FindFieldByName("objects")), 2);
}

TEST(Schema, HashesDifferBetweenSchemasAndNotBetweenCalls) {
  EXPECT_EQ(schema_hash(*v1::Scene::descriptor()), schema_hash(*v1::Scene::descriptor()));
  EXPECT_EQ(schema_hash(*v1::Scene::descriptor()), schema_hash(*v1::SceneObject::descriptor()));  // one file
  EXPECT_NE(schema_hash(*v1::Scene::descriptor()), schema_hash(*v1::Envelope::descriptor()));
}

}  // namespace
}  // namespace gfp::wire
