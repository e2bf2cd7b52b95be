// gfp_make_primitives FILE: writes the primitives of all families as one PrimitiveSet. Runs at build time; its output is
// embedded into the library.
#include <fstream>
#include <iostream>

#include "gfp/primitive/families.hpp"
#include "gfp/recognition/train_views.hpp"
#include "wire/primitive_file.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: gfp_make_primitives FILE\n";
    return 64;
  }
  std::vector<gfp::Primitive> primitives;
  for (const auto& name : gfp::family_names()) {
    primitives.push_back(gfp::build_family_primitive(name));
    primitives.back().training_views = gfp::train_views(primitives.back());
  }
  const std::string bytes = gfp::wire::encode_primitives(primitives);
  std::ofstream file(argv[1], std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    std::cerr << argv[1] << ": cannot be written\n";
    return 74;
  }
  return 0;
}
