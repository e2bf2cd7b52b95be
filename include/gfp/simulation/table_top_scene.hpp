#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gfp/simulation/virtual_scene.hpp"

namespace gfp {

struct TableTopOptions {
  int objects = 5;
  double clutter = 0.0;              ///< 0: objects stand apart; 1: each touches another (gaps of 1 to 3 mm), so that they hide each other.
  double resting_otherwise = 0.15;   ///< Share of objects that were dropped: they lie, or stand on their rim.
  double free_form = 0.0;            ///< Of SampleFamilyOptions: the objects are then not exactly members of their families.
  std::vector<std::string> classes;  ///< To draw from; empty: every family.
};

template <class Visitor>
void visit_fields(TableTopOptions& o, Visitor&& field) {
  field("objects", o.objects, 0, 1000);
  field("clutter", o.clutter, 0.0, 1.0);
  field("resting_otherwise", o.resting_otherwise, 0.0, 1.0);
  field("free_form", o.free_form, 0.0, 0.2);
  field("classes", o.classes);
}

/// A table with objects drawn from the families. Each rests as it would after being set down (or dropped) there: lowest
/// vertices at z = 0, centre of mass above its support. No two footprints (convex outlines seen from above) overlap. The table
/// grows where the objects need it to. Unknown classes are left out. Deterministic for one seed.
VirtualScene table_top_scene(const TableTopOptions& options, std::uint64_t seed);

}  // namespace gfp
