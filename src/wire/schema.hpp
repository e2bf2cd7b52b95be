#pragma once

#include <google/protobuf/message.h>

#include <cstdint>
#include <string>

namespace gfp::wire {

/// The FileDescriptorSet that defines a message, imports before what imports them: all a program needs to decode it.
std::string descriptor_set(const google::protobuf::Descriptor& descriptor);

/// First 8 bytes, big-endian, of the SHA-256 of descriptor_set(): `Envelope.schema_hash`.
std::uint64_t schema_hash(const google::protobuf::Descriptor& descriptor);

/// The FileDescriptorSet of every message that travels, as in gfp.desc.
std::string all_descriptors();

}  // namespace gfp::wire
