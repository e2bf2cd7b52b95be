#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// The primitives a process works with, one a class, sorted by class name. Immutable once built; safe from any thread.
class PrimitiveLibrary {
 public:
  PrimitiveLibrary() = default;
  explicit PrimitiveLibrary(std::vector<PrimitivePtr> primitives);

  const std::vector<PrimitivePtr>& all() const { return primitives_; }
  /// By class name or alias; nullptr where there is none.
  PrimitivePtr find(std::string_view class_name) const;

 private:
  std::vector<PrimitivePtr> primitives_;
};

}  // namespace gfp
