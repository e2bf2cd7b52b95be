#pragma once

#include <string_view>
#include <vector>

namespace gfp {

/// How an options struct tells its fields: one list per struct, beside it, serves loading, saving, validating and describing.
///
///     template <class Visitor>
///     void visit_fields(ExampleOptions& o, Visitor&& field) {
///       field("radius_px", o.radius_px, 1, 20);                     // number: bounds included
///       field("enabled", o.enabled);                                // bool
///       field("file", o.file);                                      // text
///       field("profile", o.profile, OneOf{{"robust", "paper"}});    // text out of a few
///       field("classes", o.classes);                                // list of text
///       field("coefficients", o.coefficients, -10.0, 10.0);         // list of numbers
///       field("T_tcp_parent", o.T_tcp_parent);                      // Transform: 4x4, row-major, rows or all 16
///       field.section("normals", o.normals);                        // a nested options struct
///       field.list("sensors", o.sensors);                           // a std::vector of options structs
///     }
///
/// A name is the key in the configuration; a member without a line here is not configurable.

/// The values that a text option may have.
struct OneOf {
  std::vector<std::string_view> values;
};

}  // namespace gfp
