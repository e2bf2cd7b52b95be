#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gfp/core/image.hpp"
#include "gfp/core/mesh.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Everything `gfp primitive show` says of a primitive but its points; metres, hashes in hexadecimal.
nlohmann::json primitive_json(const Primitive& primitive);

/// The same for people.
void print_primitive(std::ostream& out, const Primitive& primitive);

inline constexpr int kPrimitivePicture_px = 300;

/// Its shape at its typical size.
TriangleMesh shape_mesh(const Primitive& primitive, const std::vector<double>& modes = {});

/// A body (z up) seen from 30 degrees above and the side, as large as it fits a square of kPrimitivePicture_px.
Image<Rgb8> draw_body(const TriangleMesh& mesh, const std::string& caption, Rgb8 color);

/// The mean at its typical size with its axis, where it is one of revolution, and its mirror planes.
Image<Rgb8> draw_symmetry(const Primitive& primitive);

std::string symmetry_text(const Symmetry& symmetry);
std::size_t count_controls(const Primitive& primitive);

/// A sheet of pictures: the mean at the typical size with its control points, then a row per mode at -2, 0 and +2 sigma.
Image<Rgb8> draw_primitive(const Primitive& primitive);

}  // namespace gfp
