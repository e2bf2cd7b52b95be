// gfp primitive build DIR: a collection of models to primitives, one class after the other. A class is finished when its record
// (OUT/report/<class>.json) is written, last of its files; what it was made of is in the record's key, so that another run skips it.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/collection_page.hpp"
#include "cli/interrupt.hpp"
#include "cli/primitive_commands.hpp"
#include "cli/primitive_report.hpp"
#include "cli/progress_bar.hpp"
#include "evaluation/html_page.hpp"
#include "gfp/collection/build_primitive.hpp"
#include "gfp/collection/manual_layer.hpp"
#include "gfp/core/sha256.hpp"
#include "gfp/core/version.hpp"
#include "gfp/frame/read_file.hpp"
#include "gfp/primitive/type_points.hpp"
#include "gfp/recognition/train_views.hpp"
#include "wire/primitive_file.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kRecordVersion = 1;                        ///< Raised when the same models would give another primitive.
constexpr std::uintmax_t kMaxModelBytes = 512U << 20U;
constexpr std::uintmax_t kMaxRecordBytes = 64U << 20U;
constexpr int kExitInterrupted = 130;                    ///< As a shell says of SIGINT.

struct BuildArguments {
  std::string collection, out = "primitives", up = "z", only;
  bool json = false, force = false;
  CollectionOptions reading;
  BuildPrimitiveOptions building;
};

double seconds_since(std::chrono::steady_clock::time_point start) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }

/// Everything that the class's primitive depends on, as a number in hexadecimal.
std::string key_of(const ModelClass& models, BuildArguments arguments) {
  Sha256 hash;
  const auto put_text = [&](std::string_view text) {
    hash.put_value(static_cast<std::uint64_t>(text.size()));
    hash.put(std::as_bytes(std::span(text)));
  };
  hash.put_value(kRecordVersion);
  put_text(version());
  put_text(models.name);
  visit_fields(arguments.building, [&](std::string_view name, auto& value, auto, auto) {
    put_text(name);
    hash.put_value(value);
  });
  hash.put_value(arguments.reading.height_m);
  for (const ModelFile& file : models.files) {
    put_text(file.name);
    hash.put_value(file.scale_to_m);
    hash.put_value(file.up_axis);
    const auto content = read_file(file.path, kMaxModelBytes);
    put_text(content ? *content : content.error().what);
  }
  return fmt::format("{:016x}", hash.digest64());
}

std::vector<CollectionModel> read_all(const ModelClass& models, double height_m) {
  std::vector<CollectionModel> all;
  for (const ModelFile& file : models.files) {
    auto read = read_models(file, height_m);
    if (!read) {
      CollectionModel& missing = all.emplace_back();
      missing.name = file.name;
      missing.unreadable = read.error().what;
      continue;
    }
    for (CollectionModel& model : *read) all.push_back(std::move(model));
  }
  return all;
}

json member_json(const MemberReport& member) {
  return {{"name", member.name},           {"kept", member.rejected.empty()}, {"reason", member.rejected.empty() ? json() : json(member.rejected)}, {"residual", member.residual},
          {"genus", member.genus},         {"volume_m3", member.volume_m3},   {"size_m", {member.size_m.x(), member.size_m.y(), member.size_m.z()}}};
}

double typing_ms(const Primitive& primitive) {
  const TriangleMesh typical = shape_mesh(primitive);
  const auto start = std::chrono::steady_clock::now();
  const PointTyping typing = type_points(typical);
  return typing.types.empty() ? 0 : 1e3 * seconds_since(start);
}

/// One class on its way from models to files.
class ClassBuild {
 public:
  ClassBuild(const BuildArguments& arguments, const ModelClass& models)
      : arguments_(arguments), models_(models), file_(fs::path(arguments.out) / (models.name + ".gfp")), report_(fs::path(arguments.out) / "report"), key_(key_of(models, arguments)) {}

  /// The record of an earlier run with the same key, if what it made is still there.
  std::optional<json> finished() const {
    const auto text = read_file(report_ / (models_.name + ".json"), kMaxRecordBytes);
    if (!text) return std::nullopt;
    json record = json::parse(*text, nullptr, false);
    if (record.is_discarded() || !record.is_object() || record.value("key", "") != key_ || !record.contains("primitive")) return std::nullopt;
    if (!record["primitive"].is_null() && !wire::read_primitive(file_)) return std::nullopt;
    record["skipped"] = true;
    return record;
  }

  /// Builds, writes the primitive, its pictures and its record. A refused class is a record too. Errors: kIo; kTimeout when interrupted.
  Result<json> run() const {
    const auto start = std::chrono::steady_clock::now();
    ProgressBar bar(std::cerr, models_.name);
    std::stop_source stop;
    std::vector<MemberReport> members;
    auto built = build_primitive(
        models_.name, read_all(models_, arguments_.reading.height_m), arguments_.building,
        [&](int done, int of) {
          bar.show(static_cast<std::size_t>(done), static_cast<std::size_t>(of));
          if (interrupted()) stop.request_stop();
        },
        stop.get_token(), &members);
    if (stop.stop_requested()) return failure(ErrorCode::kTimeout, "interrupted");
    json record{{"class", models_.name}, {"key", key_}, {"skipped", false}, {"reason", nullptr}, {"primitive", nullptr}, {"file", nullptr}, {"template", nullptr}, {"mean_moved", 0.0}, {"typing_ms", 0.0}, {"members", json::array()}};
    for (const MemberReport& member : members) record["members"].push_back(member_json(member));
    if (built) {
      built->primitive.training_views = train_views(built->primitive);
      if (const auto before = wire::read_primitive(file_)) carry_manual_types(*before, built->primitive);
      record["primitive"] = primitive_json(built->primitive);
      record["mean_moved"] = built->mean_moved;
      record["template"] = built->members[built->template_member].name;
      record["file"] = file_.filename().string();
      record["typing_ms"] = typing_ms(built->primitive);
      if (auto written = wire::write_primitive(file_, built->primitive); !written) return tl::unexpected(written.error());
    } else {
      record["reason"] = built.error().what;
      std::error_code ignored;
      fs::remove(file_, ignored);  // what is there was made of other models
    }
    record["seconds"] = seconds_since(start);
    if (auto drawn = draw_class(report_, models_.name, built ? &built->primitive : nullptr, members); !drawn) return tl::unexpected(drawn.error());
    if (auto written = write_text(report_ / (models_.name + ".json"), record.dump(1) + "\n"); !written) return tl::unexpected(written.error());
    return record;
  }

 private:
  const BuildArguments& arguments_;
  const ModelClass& models_;
  fs::path file_, report_;
  std::string key_;
};

void print(const json& record) {
  const json& members = record.at("members");
  std::size_t kept = 0;
  for (const json& member : members) kept += member.at("kept").get<bool>() ? 1 : 0;
  if (record.at("primitive").is_null()) {
    std::cout << fmt::format("{:<14} refused: {}\n", record.at("class").get<std::string>(), record.at("reason").get<std::string>());
  } else {
    const json& primitive = record.at("primitive");
    std::cout << fmt::format("{:<14} {} of {} members, {} points, {} modes, genus {}, {}, {:.1f} s{}\n", record.at("class").get<std::string>(), kept, members.size(),
                             primitive.at("vertices").get<int>(), primitive.at("modes").get<int>(), primitive.at("genus").get<int>(), primitive.at("hollow").get<bool>() ? "hollow" : "solid",
                             record.at("seconds").get<double>(), record.at("skipped").get<bool>() ? " (unchanged, skipped)" : "");
    for (const json& member : members)
      if (!member.at("kept").get<bool>()) std::cout << fmt::format("{:<14} left out {}: {}\n", "", member.at("name").get<std::string>(), member.at("reason").get<std::string>());
  }
  std::cout << std::flush;
}

void build(BuildArguments arguments, ExitStatus& status) {
  arguments.reading.up_axis = arguments.up[0];
  const auto classes = find_model_classes(arguments.collection, arguments.reading);
  if (!classes) return status.fail(std::cerr, "primitive build", classes.error());
  std::error_code error;
  fs::create_directories(fs::path(arguments.out) / "report", error);
  if (error) return status.fail(std::cerr, "--out " + arguments.out, {ErrorCode::kIo, error.message()});
  catch_interrupts();
  json records = json::array();
  for (const ModelClass& models : *classes) {
    if (!arguments.only.empty() && models.name != arguments.only) continue;
    const ClassBuild one(arguments, models);
    auto record = arguments.force ? std::nullopt : one.finished();
    if (!record) {
      auto fresh = one.run();
      if (!fresh && interrupted()) break;
      if (!fresh) return status.fail(std::cerr, models.name, fresh.error());
      record = std::move(*fresh);
    }
    if (!arguments.json) print(*record);
    records.push_back(std::move(*record));
  }
  if (records.empty() && !interrupted()) return status.fail(std::cerr, "--only " + arguments.only, {ErrorCode::kNotFound, "no such class in the collection"});
  if (auto written = write_collection_page(fs::path(arguments.out) / "report", records); !written) return status.fail(std::cerr, arguments.out, written.error());
  if (arguments.json) std::cout << json{{"collection", arguments.collection}, {"out", arguments.out}, {"interrupted", interrupted()}, {"classes", records}}.dump() << "\n";
  else std::cout << fmt::format("{}\n", (fs::path(arguments.out) / "report/index.html").string());
  if (interrupted()) {
    std::cerr << "gfp: primitive build: interrupted; the classes above are finished, another run goes on from there\n";
    status.fail(kExitInterrupted);
  }
}

}  // namespace

void add_primitive_build_command(CLI::App& primitive, ExitStatus& status) {
  const auto arguments = std::make_shared<BuildArguments>();
  BuildArguments& a = *arguments;
  CLI::App& command = *primitive.add_subcommand("build", "Build primitives from a collection of models; classes that are already built from the same models are skipped");
  command.add_option("DIR", a.collection, "A folder with a meshes.csv, with .cla lists (Princeton Shape Benchmark), or with one folder of OFF, OBJ, PLY or STL files a class")->required();
  command.add_option("--out", a.out, "Folder for CLASS.gfp and report/index.html")->capture_default_str();
  command.add_option("--only", a.only, "Only the class of this name");
  command.add_option("--scale-to-m", a.reading.scale_to_m, "Metres per unit of the models (a meshes.csv has its own)")->check(CLI::Range(1e-6, 1e3))->capture_default_str();
  command.add_option("--up", a.up, "The models' up axis (a meshes.csv has its own)")->check(CLI::IsMember({"x", "y", "z"}))->capture_default_str();
  command.add_option("--height", a.reading.height_m, "Scale every model to this height in metres: for collections without a unit")->check(CLI::Range(0.001, 2.0));
  command.add_option("--vertices", a.building.vertices, "Points of a primitive, about")->check(CLI::Range(100, 5000))->capture_default_str();
  command.add_option("--voxels", a.building.voxels, "Along a model's longest side, where it must be closed")->check(CLI::Range(24, 256))->capture_default_str();
  command.add_option("--max-residual", a.building.max_residual, "Mean distance of a member from the morphed template, as a share of its longest side; what is farther is left out")->check(CLI::Range(0.001, 1.0))->capture_default_str();
  command.add_flag("--force", a.force, "Build every class anew");
  command.add_flag("--json", a.json, "Machine-readable output");
  command.callback([arguments, &status] { build(*arguments, status); });
}

}  // namespace gfp
