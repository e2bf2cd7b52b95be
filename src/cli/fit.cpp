// gfp fit: recordings in, closed meshes with grasps out (DESIGN, command-line contract).
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/builtin_library.hpp"
#include "app/run_input.hpp"
#include "cli/commands.hpp"
#include "cli/fit_output.hpp"
#include "cli/overlay.hpp"
#include "config/camera_file.hpp"
#include "gfp/frame/png.hpp"
#include "wire/scene_json.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;

/// The command line, as the user gave it.
struct FitArguments {
  std::vector<std::string> inputs;
  std::string camera, axes, mask, out, png, primitives;
  std::optional<double> depth_scale_m;
  int upsampling = 0;
  bool json = false;
  PipelineOptions pipeline;
};

/// Everything that all inputs share, checked before the first is opened.
struct FitJob {
  PrimitiveLibrary library;
  InputOptions input;
  Image<std::uint8_t> mask;
  PipelineOptions pipeline;
};

Result<void> make_folder(const std::string& folder) {
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) return failure(ErrorCode::kIo, "--out " + folder + ": " + error.message());
  return {};
}

Result<FitJob> prepare(const FitArguments& arguments) {
  FitJob job;
  job.input.depth_scale_m = arguments.depth_scale_m;
  job.input.axes = arguments.axes;
  job.pipeline = arguments.pipeline;
  if (auto valid = validate(job.pipeline); !valid) return tl::unexpected(as_argument(valid.error()));
  auto library = library_with(arguments.primitives, arguments.upsampling);
  if (!library) return tl::unexpected(library.error());
  job.library = std::move(*library);
  if (!job.pipeline.recognition.only_class.empty()) {
    const auto known = find_class(job.library, job.pipeline.recognition.only_class);
    if (!known) return tl::unexpected(as_argument(known.error()));
    job.pipeline.recognition.only_class = (*known)->class_name;
  }
  if (!arguments.camera.empty()) {
    auto camera = config::load_camera(arguments.camera);
    if (!camera) return tl::unexpected(camera.error());
    job.input.camera = *camera;
  }
  if (!arguments.mask.empty()) {
    auto mask = read_png_grey(arguments.mask);
    if (!mask) return tl::unexpected(mask.error());
    job.mask = std::move(*mask);
  }
  if (auto folder = make_folder(arguments.out); !folder) return tl::unexpected(folder.error());
  return job;
}

/// Where two inputs have the same stem, the later ones get a number, so that no file is written over.
std::string unique_stem(const std::string& stem, std::set<std::string>& used) {
  std::string name = stem;
  for (int count = 2; !used.insert(name).second; ++count) name = stem + "-" + std::to_string(count);
  return name;
}

/// Runs all inputs; every result goes out as soon as it is there.
class FitRun {
 public:
  FitRun(const FitArguments& arguments, FitJob job, ExitStatus& status) : arguments_(arguments), job_(std::move(job)), status_(status) {}

  void run() {
    for (const std::string& name : arguments_.inputs) {
      auto input = open_input(name, job_.input);
      if (!input) {
        status_.fail(std::cerr, name, input.error());
        continue;
      }
      run(*input);
    }
  }

 private:
  void run(Input& input) {
    const std::string stem = unique_stem(input.stem, stems_);
    const bool many = arguments_.inputs.size() > 1 || input.has_many_frames();
    run_input(input, job_.library, job_.pipeline, job_.mask,
              {[&](const Frame& frame, const FrameReport& report, const PipelineResult& result) { show(input.name, stem, many, frame, report, result); },
               [&](const Error& error) { status_.fail(std::cerr, input.name, error); }});
  }

  void show(const std::string& name, const std::string& stem, bool many, const Frame& frame, const FrameReport& report, const PipelineResult& result) {
    for (const std::string& note : report.notes)
      if (notes_.insert(name + note).second) std::cerr << "gfp: " << name << ": note: " << note << "\n";
    std::map<std::uint64_t, std::string> meshes;
    if (!arguments_.out.empty()) {
      auto written = write_meshes(arguments_.out, stem, result.scene);
      if (written) meshes = std::move(*written);
      else status_.fail(std::cerr, arguments_.out, written.error());
    }
    if (arguments_.json) std::cout << scene_json(result.scene, {name, job_.pipeline.method, meshes}).dump() << std::endl;  // a line is out as soon as it is there
    else print_table(std::cout, name, result.scene);
    if (!arguments_.png.empty()) draw(name, many, frame, result);
  }

  void draw(const std::string& name, bool many, const Frame& frame, const PipelineResult& result) {
    const fs::path file = many ? numbered(arguments_.png, pictures_) : fs::path(arguments_.png);
    ++pictures_;
    const std::string title = name + " frame " + std::to_string(frame.sequence);
    const auto written = write_png(file, draw_overlay(frame, result.scene, result.memory, job_.pipeline.gripper, title));
    if (!written) status_.fail(std::cerr, file.string(), written.error());
  }

  const FitArguments& arguments_;
  FitJob job_;
  ExitStatus& status_;
  std::set<std::string> stems_, notes_;
  std::size_t pictures_ = 0;
};

void fit(const FitArguments& arguments, ExitStatus& status) {
  auto job = prepare(arguments);
  if (!job) return status.fail(std::cerr, "fit", job.error());
  FitRun(arguments, std::move(*job), status).run();
}

}  // namespace

void add_fit_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("fit", "Fit closed models and grasps to every object of recorded frames");
  const auto arguments = std::make_shared<FitArguments>();  // lives as long as the callback that reads it
  PipelineOptions& pipeline = arguments->pipeline;
  command.add_option("INPUT", arguments->inputs, "Organised .pcd, .pclzf, 16-bit depth .png, .oni, .mcap, or a folder: of these, TUM-style, or recorded by libfreenect")->required();
  command.add_option("--profile", pipeline.profile, "What the stages do")->capture_default_str();
  command.add_option("--method", pipeline.method, "How objects are modelled; by default as the profile does");
  command.add_option("--class", pipeline.recognition.only_class, "The objects' class, where it is known");
  command.add_option("--primitives", arguments->primitives, kPrimitivesHelp);
  command.add_option("--upsampling", arguments->upsampling, kUpsamplingHelp)->check(CLI::Range(0, kMaxUpsampling))->capture_default_str();
  command.add_option("--camera", arguments->camera, "Camera file (YAML), or fx,fy,cx,cy in pixels");
  command.add_option("--depth-scale", arguments->depth_scale_m, "Metres per unit of 16-bit depth")->check(CLI::Range(1e-6, 1.0));
  command.add_option("--axes", arguments->axes, "The file's right, down and forward axes, as in xyz or x-y-z");
  command.add_option("--mask", arguments->mask, "Grey PNG: its non-zero pixels are the one object");
  command.add_option("--seed", pipeline.grasp.seed, "Of everything random")->capture_default_str();
  command.add_option("--out", arguments->out, "Folder for <input>_<frame>_<id>.ply, .obj and .glb, camera frame");
  command.add_option("--png", arguments->png, "Picture of the frame with fits and grasps; several frames are numbered");
  command.add_flag("--json", arguments->json, "A JSON line per frame");
  command.callback([arguments, &status, &command] {
    if (command.count("--method") == 0 && arguments->pipeline.profile == "paper") arguments->pipeline.method = "gfp_paper";
    fit(*arguments, status);
  });
}

}  // namespace gfp
