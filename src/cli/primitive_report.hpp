#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

#include "gfp/core/image.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Everything `gfp primitive show` says of a primitive but its points; metres, hashes in hexadecimal.
nlohmann::json primitive_json(const Primitive& primitive);

/// The same for people.
void print_primitive(std::ostream& out, const Primitive& primitive);

/// A sheet of pictures: the mean at the typical size with its control points, then a row per mode at -2, 0 and +2 sigma.
Image<Rgb8> draw_primitive(const Primitive& primitive);

}  // namespace gfp
