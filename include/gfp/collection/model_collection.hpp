#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/mesh.hpp"

namespace gfp {

/// A file of a collection, and how its coordinates are meant.
struct ModelFile {
  std::string name;  ///< Relative to the collection.
  std::filesystem::path path;
  double scale_to_m = 1;
  char up_axis = 'z';
};

/// Models of things of one kind.
struct ModelClass {
  std::string name;              ///< Of letters, digits, `_`, `-` and `.`, so that files can be named after it.
  std::vector<ModelFile> files;  ///< Sorted by name.
};

/// What is said of models that do not say it themselves (all but those of a meshes.csv).
struct CollectionOptions {
  double scale_to_m = 1;  ///< Metres per unit of the files.
  char up_axis = 'z';
  double height_m = 0;    ///< Above 0: every model is scaled to this height instead, for collections without a unit.
};

/// The classes of a collection, by name. It may have one of three forms:
///   - a table meshes.csv with the columns file, class, scale_to_m, up_axis (things of class `other` have none and are left out);
///   - the Princeton Shape Benchmark's: .cla files that list model numbers, and m<number>.off files anywhere below;
///   - one folder a class, with OFF, OBJ, PLY or STL files in or below it.
/// Errors: kNotFound (no such folder, no class in it), kCorruptData (a table or a .cla file, naming its line; a name that no file can have),
/// kTooLarge (a list of more than 16 MB).
Result<std::vector<ModelClass>> find_model_classes(const std::filesystem::path& root, const CollectionOptions& options = {});

/// One model of a class: any triangles, z up, metres, base at z = 0.
struct CollectionModel {
  std::string name;
  TriangleMesh mesh;
  std::string unreadable = {};  ///< Why there is no mesh; empty: there is one.
};

/// The models in a file: one, or each part of a *_pair. Vessels stand with their opening up, whatever axis was told.
/// Errors: those of read_mesh (bounded; naming file, line, value); kCorruptData (no triangles); kTooLarge (more than 2 m: scale_to_m?).
Result<std::vector<CollectionModel>> read_models(const ModelFile& file, double height_m = 0);

}  // namespace gfp
