#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/scene_diff.hpp"
#include "gfp/core/mesh.hpp"
#include "gfp/frame/read_file.hpp"
#include "gfp/recording/mcap_reader.hpp"
#include "wire/recorded_messages.hpp"

namespace gfp {
namespace {

using nlohmann::json;

DiffFrame frame_of(Scene scene) {
  DiffFrame frame{scene.sensor, scene.stamps.sensor, {}};
  for (SceneObject& object : scene.objects) {
    FittedModel& model = object.model;
    const Eigen::Vector3d extents = model.vertices.empty() ? Eigen::Vector3d::Zero() : bounds(model.vertices).size();
    frame.objects.push_back({object.id, model.class_name, model.method, model.T_camera_object, extents, model.topology->hash, std::move(model.vertices),
                             std::move(object.grasps.grasps), object.grasps.no_grasp_reason});
  }
  return frame;
}

Result<std::vector<DiffFrame>> load_recording(const std::filesystem::path& file) {
  auto reader = McapReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  const auto has_schema = [&](std::string_view name) {
    return [&reader, name](const McapChannel& channel) {
      const McapSchema* schema = reader->schema_of(channel);
      return schema != nullptr && schema->name == name;
    };
  };
  const auto meshes = reader->messages(has_schema(wire::kTopologySchema));
  if (!meshes) return tl::unexpected(meshes.error());
  const auto scenes = reader->messages(has_schema(wire::kSceneSchema));
  if (!scenes) return tl::unexpected(scenes.error());
  if (scenes->empty()) return failure(ErrorCode::kUnsupported, fmt::format("{}: scenes = 0, expected a recording with objects", file.string()));
  wire::RecordedScenes recorded;
  for (const McapMessageRef& ref : *meshes) {
    const auto message = reader->read(ref);
    if (!message) return tl::unexpected(message.error());
    if (auto put = recorded.put_topology(message->data); !put) return tl::unexpected(put.error());
  }
  std::vector<DiffFrame> frames;
  for (const McapMessageRef& ref : *scenes) {
    const auto message = reader->read(ref);
    if (!message) return tl::unexpected(message.error());
    auto scene = recorded.scene(message->data);
    if (!scene) return failure(scene.error().code, fmt::format("{}: {}", file.string(), scene.error().what));
    frames.push_back(frame_of(std::move(*scene)));
  }
  return frames;
}

Eigen::Vector3d vector_of(const json& array) { return {array.at(0).get<double>(), array.at(1).get<double>(), array.at(2).get<double>()}; }

Transform transform_of(const json& rows) {
  Transform transform = Transform::Identity();
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) transform.matrix()(r, c) = rows.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c)).get<double>();
  return transform;
}

DiffObject object_of(const json& line) {
  DiffObject object;
  object.id = line.at("id").get<std::uint64_t>();
  object.class_name = line.at("class").get<std::string>();
  object.method = line.at("method").get<std::string>();
  object.T_camera_object = transform_of(line.at("T_camera_object"));
  object.extents_m = vector_of(line.at("extents_m"));
  for (const json& sent : line.at("grasps")) {
    Grasp grasp;
    grasp.T_camera_tcp = transform_of(sent.at("T_camera_tcp"));
    grasp.width_m = sent.at("width_m").get<double>();
    grasp.epsilon = sent.at("epsilon").get<double>();
    object.grasps.push_back(std::move(grasp));
  }
  if (const json& reason = line.at("no_grasp_reason"); reason.is_string()) object.no_grasp_reason = reason.get<std::string>();
  return object;
}

/// Throws json::exception where a key is missing or of another type.
DiffFrame frame_of(const json& line) {
  DiffFrame frame{line.at("sensor").get<std::string>(), Nanoseconds(line.at("stamp_ns").get<std::int64_t>()), {}};
  for (const json& object : line.at("objects")) frame.objects.push_back(object_of(object));
  return frame;
}

Result<std::vector<DiffFrame>> load_lines(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMaxBytes = 1U << 30U;
  const auto text = read_file(file, kMaxBytes);
  if (!text) return tl::unexpected(text.error());
  std::vector<DiffFrame> frames;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text->size();) {
    const std::size_t end = std::min(text->find('\n', begin), text->size());
    ++number;
    try {
      if (end > begin) frames.push_back(frame_of(json::parse(std::string_view(*text).substr(begin, end - begin))));
    } catch (const json::exception& error) {
      return failure(ErrorCode::kCorruptData, fmt::format("{}:{}: no line of gfp fit --json: {}", file.string(), number, error.what()));
    }
    begin = end + 1;
  }
  if (frames.empty()) return failure(ErrorCode::kUnsupported, fmt::format("{}: scenes = 0, expected lines of gfp fit --json", file.string()));
  return frames;
}

}  // namespace

Result<std::vector<DiffFrame>> load_scenes(const std::filesystem::path& file) {
  auto source = open_source(file);
  if (!source) return tl::unexpected(source.error());
  std::string head;
  if (auto read = (*source)->read_at(0, 5, head); !read) return tl::unexpected(read.error());
  return head == "\x89MCAP" ? load_recording(file) : load_lines(file);
}

}  // namespace gfp
