// gfp primitive list | show NAME | export NAME: what the library holds, built in or one's own.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/builtin_library.hpp"
#include "cli/commands.hpp"
#include "cli/primitive_commands.hpp"
#include "cli/primitive_report.hpp"
#include "gfp/core/mesh_io.hpp"
#include "gfp/frame/png.hpp"

namespace gfp {
namespace {

struct PrimitiveArguments {
  std::string name, png, out, primitives;
  std::vector<double> modes;
  std::vector<double> size_m;
  bool json = false;
};

void list(const PrimitiveArguments& arguments, ExitStatus& status) {
  const auto library = library_with(arguments.primitives);
  if (!library) return status.fail(std::cerr, "--primitives", library.error());
  nlohmann::json all = nlohmann::json::array();
  for (const PrimitivePtr& primitive : library->all()) {
    if (arguments.json) all.push_back(primitive_json(*primitive));
    const Eigen::Vector3d size_mm = 1e3 * primitive->typical_size_m();
    if (!arguments.json)
      std::cout << fmt::format("{:<14} {:>4.0f} x {:>4.0f} x {:>4.0f} mm  {:>5} points  {} modes  genus {}  {}\n", primitive->name, size_mm.x(), size_mm.y(),
                               size_mm.z(), primitive->size(), primitive->modes.size(), primitive->genus, primitive->hollow ? "hollow" : "solid");
  }
  if (arguments.json) std::cout << all.dump() << "\n";
}

void show(const PrimitiveArguments& arguments, const Primitive& primitive, ExitStatus& status) {
  if (arguments.json) std::cout << primitive_json(primitive).dump() << "\n";
  else print_primitive(std::cout, primitive);
  if (arguments.png.empty()) return;
  if (const auto written = write_png(arguments.png, draw_primitive(primitive)); !written) status.fail(std::cerr, arguments.png, written.error());
}

/// Control points are drawn in another colour than regular ones.
std::vector<Rgb8> type_colors(const Primitive& primitive) {
  std::vector<Rgb8> colors;
  for (const PointType type : primitive.topology->types) colors.push_back(type == PointType::kControl ? Rgb8{255, 200, 40} : Rgb8{120, 170, 220});
  return colors;
}

Result<void> write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh, const std::vector<Rgb8>& colors) {
  if (file.extension() == ".ply") return write_ply(file, mesh, colors);
  if (file.extension() == ".obj") return write_obj(file, mesh, colors);
  if (file.extension() == ".glb") return write_glb(file, mesh, colors);
  return failure(ErrorCode::kInvalidArgument, "--out " + file.string() + ": expected a name that ends in .ply, .obj or .glb");
}

void export_shape(const PrimitiveArguments& arguments, const Primitive& primitive, ExitStatus& status) {
  if (arguments.modes.size() > primitive.modes.size())
    return status.fail(std::cerr, "--modes", {ErrorCode::kInvalidArgument, fmt::format("{} coefficients, expected at most {}", arguments.modes.size(), primitive.modes.size())});
  const Eigen::Vector3d size_m = arguments.size_m.empty() ? primitive.typical_size_m() : Eigen::Vector3d(arguments.size_m[0], arguments.size_m[1], arguments.size_m[2]);
  const std::string file = arguments.out.empty() ? primitive.name + ".ply" : arguments.out;
  const auto written = write_mesh(file, {shape(primitive, size_m, arguments.modes), primitive.topology->triangles}, type_colors(primitive));
  if (!written) return status.fail(std::cerr, file, written.error());
  if (arguments.json) std::cout << nlohmann::json{{"primitive", primitive.name}, {"file", file}}.dump() << "\n";
  else std::cout << file << "\n";
}

/// Runs `action` on the named primitive, or says which there are.
template <class Action>
void with_primitive(const PrimitiveArguments& arguments, ExitStatus& status, Action&& action) {
  const auto library = library_with(arguments.primitives);
  if (!library) return status.fail(std::cerr, "--primitives", library.error());
  const auto primitive = find_class(*library, arguments.name);
  if (!primitive) return status.fail(std::cerr, "primitive", as_argument(primitive.error()));
  action(arguments, **primitive, status);
}

}  // namespace

void add_primitive_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("primitive", "List, show, export, build, retype and check generic primitives");
  command.require_subcommand(1);
  const auto arguments = std::make_shared<PrimitiveArguments>();  // lives as long as the callbacks that read it

  CLI::App& list_command = *command.add_subcommand("list", "One line a primitive");
  list_command.callback([arguments, &status] { list(*arguments, status); });
  CLI::App& show_command = *command.add_subcommand("show", "Size, modes, typing, symmetry and stable poses of a primitive");
  show_command.add_option("NAME", arguments->name, "Name, class or alias")->required();
  show_command.add_option("--png", arguments->png, "Sheet of the mean shape and its modes at -2, 0 and +2 sigma");
  show_command.callback([arguments, &status] { with_primitive(*arguments, status, show); });
  CLI::App& export_command = *command.add_subcommand("export", "Write a shape of the primitive as a mesh, object frame, metres");
  export_command.add_option("NAME", arguments->name, "Name, class or alias")->required();
  export_command.add_option("--out", arguments->out, "File: .ply, .obj or .glb (default NAME.ply)");
  export_command.add_option("--size", arguments->size_m, "Reference size x,y,z in metres (default: the typical size)")->delimiter(',')->expected(3)->check(CLI::Range(1e-3, 10.0));
  export_command.add_option("--modes", arguments->modes, "Coefficients in standard deviations, as in 1,0,-2")->delimiter(',')->check(CLI::Range(-5.0, 5.0));
  export_command.callback([arguments, &status] { with_primitive(*arguments, status, export_shape); });
  add_primitive_build_command(command, status);
  add_primitive_retype_command(command, status);
  add_primitive_qa_command(command, status);
  for (CLI::App* subcommand : {&list_command, &show_command, &export_command}) {
    subcommand->add_option("--primitives", arguments->primitives, kPrimitivesHelp);
    subcommand->add_flag("--json", arguments->json, "Machine-readable output");
  }
}

}  // namespace gfp
