#include "wire/schema.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <set>
#include <span>

#include "gfp/core/sha256.hpp"
#include "gfp/v1/control.pb.h"
#include "gfp/v1/envelope.pb.h"
#include "gfp/v1/sensor.pb.h"
#include "gfp/v1/status.pb.h"

namespace gfp::wire {
namespace {

void append(const google::protobuf::FileDescriptor& file, std::set<std::string>& seen, google::protobuf::FileDescriptorSet& files) {
  if (!seen.insert(file.name()).second) return;
  for (int i = 0; i < file.dependency_count(); ++i) append(*file.dependency(i), seen, files);
  file.CopyTo(files.add_file());
}

}  // namespace

std::string descriptor_set(const google::protobuf::Descriptor& descriptor) {
  google::protobuf::FileDescriptorSet files;
  std::set<std::string> seen;
  append(*descriptor.file(), seen, files);
  return files.SerializeAsString();
}

std::uint64_t schema_hash(const google::protobuf::Descriptor& descriptor) {
  const std::string files = descriptor_set(descriptor);
  Sha256 hash;
  hash.put(std::as_bytes(std::span(files)));
  return hash.digest64();
}

std::string all_descriptors() {
  google::protobuf::FileDescriptorSet files;
  std::set<std::string> seen;
  // What the scene, mesh and geometry are made of comes with the control messages.
  for (const auto* descriptor : {v1::Envelope::descriptor(), v1::ControlRequest::descriptor(), v1::DepthImage::descriptor(), v1::SensorStatus::descriptor()})
    append(*descriptor->file(), seen, files);
  return files.SerializeAsString();
}

}  // namespace gfp::wire
