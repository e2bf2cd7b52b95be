#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// The primitives a process works with, sorted by name; a class may have several (round and flat bottles). Immutable once built; safe from any thread.
class PrimitiveLibrary {
 public:
  PrimitiveLibrary() = default;
  explicit PrimitiveLibrary(std::vector<PrimitivePtr> primitives);

  const std::vector<PrimitivePtr>& all() const { return primitives_; }
  /// By name, else the first of that class or alias; nullptr where there is none.
  PrimitivePtr find(std::string_view name) const;
  /// All of a class; where there is no such class, all of that name or alias (`boot`: of the shoes, only those). May be empty.
  std::vector<PrimitivePtr> of_class(std::string_view name) const;

 private:
  std::vector<PrimitivePtr> primitives_;
};

}  // namespace gfp
