#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/mesh.hpp"

namespace gfp {

/// One line of a meshes.csv.
struct MeshEntry {
  std::string file;        ///< Relative to the folder.
  std::string class_name;
  double scale_to_m = 1;
  char up_axis = 'z';
};

/// Errors: kNotFound, kCorruptData (a missing column, a scale that is no positive number, an unknown axis), naming the line.
Result<std::vector<MeshEntry>> read_mesh_table(const std::filesystem::path& file);

/// The objects of one entry, metres, z up, base centre at the origin: one, or the parts of a *_pair file.
Result<std::vector<TriangleMesh>> load_objects(const std::filesystem::path& folder, const MeshEntry& entry);

/// Groups of connected components whose bounding boxes touch, by their first triangle. Welds vertices closer than 10 um.
std::vector<TriangleMesh> split_groups(const TriangleMesh& mesh);

/// Turned from `up_axis` to z up.
TriangleMesh upright(TriangleMesh mesh, char up_axis);

/// The direction along which a mesh holds the most water, as its up axis: of the six half axes, the present one unless another
/// holds half as much again (some tables give the axis of the file format, not of the object).
TriangleMesh stood_up(const TriangleMesh& mesh, bool& turned);

/// Shifted so that the base's centre is the origin.
TriangleMesh on_origin(TriangleMesh mesh);

}  // namespace gfp
