#include "replay/mcap_streams.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>

#include "replay/ros_messages.hpp"
#include "wire/recorded_messages.hpp"
#include "wire/topics.hpp"

namespace gfp {
namespace {

constexpr std::string_view kRosImage = "sensor_msgs/msg/Image", kRosCompressed = "sensor_msgs/msg/CompressedImage", kRosInfo = "sensor_msgs/msg/CameraInfo";
constexpr std::string_view kRawImage = "foxglove.RawImage", kCalibration = "foxglove.CameraCalibration";

tl::unexpected<Error> pass_on(const Error& error) { return tl::unexpected<Error>(error); }

bool is_image(std::string_view schema) { return schema == kRosImage || schema == kRosCompressed || schema == kRawImage; }
bool is_camera(std::string_view schema) { return schema == kRosInfo || schema == kCalibration; }

/// Up to the last `/`, trailing ones aside: topics of one camera share it, or a parent of it.
std::string parent_of(std::string topic) {
  while (topic.ends_with('/')) topic.pop_back();
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos ? std::string() : topic.substr(0, slash);
}

/// What the topics of each sensor that a gfpd recorded begin with.
std::set<std::string> sensor_topics(const McapReader& reader) {
  std::set<std::string> topics;
  for (const auto& [id, channel] : reader.registry().channels)
    if (const McapSchema* schema = reader.schema_of(channel); schema != nullptr && schema->name == wire::kFrameSchema) topics.insert(parent_of(channel.topic));
  return topics;
}

std::string name_of(const std::string& sensor_topic) { return sensor_topic.substr(sensor_topic.rfind('/') + 1); }

/// How many leading names two topics share.
std::size_t kinship(const std::string& a, const std::string& b) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && a[i] == b[i]; ++i) shared += a[i] == '/' ? 1 : 0;
  return shared;
}

std::map<std::uint64_t, McapMessageRef> by_time(const std::vector<McapMessageRef>& refs) {
  std::map<std::uint64_t, McapMessageRef> map;
  for (const McapMessageRef& ref : refs) map.emplace(ref.log_time_ns, ref);
  return map;
}

}  // namespace

std::string McapStreams::schema_name(const McapChannel& channel) const {
  const McapSchema* schema = reader_.schema_of(channel);
  return schema == nullptr ? std::string() : schema->name;
}

const McapChannel* McapStreams::channel_of(const std::string& topic) const {
  for (const auto& [id, channel] : reader_.registry().channels)
    if (channel.topic == topic) return &channel;
  return nullptr;
}

/// Messages of one topic may come on several channels (a recorder that was started anew): all of them, by time.
Result<std::vector<McapMessageRef>> McapStreams::refs_of(const McapChannel& channel) {
  return reader_.messages([&](const McapChannel& other) { return other.topic == channel.topic && schema_name(other) == schema_name(channel); });
}

std::string McapStreams::what_is_there() const {
  std::string topics;
  for (const auto& [id, channel] : reader_.registry().channels)
    if (topics.size() < 1000) topics += fmt::format(" {} ({})", channel.topic, schema_name(channel));
  return topics;
}

Result<McapStreams> McapStreams::open(const std::filesystem::path& file, const ReplayOptions& options) {
  auto reader = McapReader::open(file);
  if (!reader) return pass_on(reader.error());
  McapStreams streams(std::move(*reader), options, file);
  std::set<std::string> recorded = sensor_topics(streams.reader_);
  if (!options.topic.empty()) std::erase_if(recorded, [&](const std::string& sensor) { return sensor + "/frame/" != options.topic && sensor + "/depth/" != options.topic; });
  std::optional<std::string> ours;
  if (const auto namesake = recorded.find(parent_of(wire::sensor_topic(options.sensor, "depth"))); namesake != recorded.end()) {
    ours = *namesake;
  } else if (!recorded.empty()) {
    ours = *recorded.begin();
    for (auto other = std::next(recorded.begin()); other != recorded.end(); ++other) streams.left_out_.insert(*other + "/depth/");
  }
  if (auto chosen = ours ? streams.choose_ours(*ours) : streams.choose_theirs(); !chosen) return pass_on(chosen.error());
  if (streams.depth_.empty()) return failure(ErrorCode::kUnsupported, fmt::format("{}: frames = 0, expected depth images", file.string()));
  return streams;
}

Result<std::vector<std::string>> McapStreams::recorded_sensors(const std::filesystem::path& file) {
  const auto reader = McapReader::open(file);
  if (!reader) return pass_on(reader.error());
  std::vector<std::string> names;
  for (const std::string& sensor : sensor_topics(*reader)) names.push_back(name_of(sensor));
  return names;
}

Result<void> McapStreams::choose_ours(const std::string& sensor) {
  is_ours_ = true;
  recorded_sensor_ = name_of(sensor);
  const auto refs = [&](const char* stream) -> Result<std::vector<McapMessageRef>> {
    const McapChannel* channel = channel_of(sensor + "/" + stream + "/");
    return channel != nullptr ? refs_of(*channel) : std::vector<McapMessageRef>();
  };
  auto depth = refs("depth"), info = refs("frame"), color = refs("color");
  for (const auto* found : {&depth, &info, &color})
    if (!*found) return pass_on(found->error());
  info_ = by_time(*info);
  color_ = by_time(*color);
  std::erase_if(*depth, [&](const McapMessageRef& ref) { return !info_.contains(ref.log_time_ns); });
  depth_ = std::move(*depth);
  return {};
}

Result<void> McapStreams::choose_theirs() {
  const McapChannel *depth = nullptr, *camera = nullptr;
  for (const auto& [id, channel] : reader_.registry().channels) {
    if (!is_image(schema_name(channel))) continue;
    const bool is_named = !options_.topic.empty() && channel.topic == options_.topic;
    const bool is_depth = options_.topic.empty() && channel.topic.find("depth") != std::string::npos &&
                          (schema_name(channel) != kRosCompressed || channel.topic.find("compressedDepth") != std::string::npos);
    const auto rank = [](const McapChannel& c) { return std::tuple(c.topic.size(), c.topic); };
    if ((is_named || is_depth) && (depth == nullptr || rank(channel) < rank(*depth))) depth = &channel;
  }
  if (depth == nullptr)
    return failure(ErrorCode::kUnsupported, fmt::format("{}: no depth images{}; there are:{}", file_.string(),
                                                        options_.topic.empty() ? "" : " on topic " + options_.topic, what_is_there()));
  for (const auto& [id, channel] : reader_.registry().channels) {
    if (!is_camera(schema_name(channel))) continue;
    if (camera == nullptr || kinship(channel.topic, depth->topic) > kinship(camera->topic, depth->topic)) camera = &channel;
  }
  auto refs = refs_of(*depth);
  if (!refs) return pass_on(refs.error());
  depth_ = std::move(*refs);
  depth_schema_ = schema_name(*depth);
  if (camera != nullptr) {
    const auto cameras = refs_of(*camera);
    if (!cameras) return pass_on(cameras.error());
    camera_ = by_time(*cameras);
    camera_schema_ = schema_name(*camera);
  }
  const McapChannel* color = options_.color_topic.empty() ? nullptr : channel_of(options_.color_topic);
  if (!options_.color_topic.empty() && (color == nullptr || !is_image(schema_name(*color))))
    return failure(ErrorCode::kUnsupported, fmt::format("{}: no images on topic {}; there are:{}", file_.string(), options_.color_topic, what_is_there()));
  if (color == nullptr) return {};
  const auto colors = refs_of(*color);
  if (!colors) return pass_on(colors.error());
  color_ = by_time(*colors);
  color_schema_ = schema_name(*color);
  return {};
}

Result<LoadedFrame> McapStreams::load(std::size_t index) {
  auto loaded = is_ours_ ? load_ours(index) : load_theirs(index);
  if (!loaded) return loaded;
  loaded->report.file = file_;
  if (index == 0 && !left_out_.empty()) loaded->report.notes.push_back(fmt::format("other sensors left out: {}", fmt::join(left_out_, ", ")));
  loaded->frame.sensor = options_.sensor.empty() ? recorded_sensor_ : options_.sensor;
  return loaded;
}

Result<LoadedFrame> McapStreams::load_ours(std::size_t index) {
  const std::uint64_t time_ns = depth_[index].log_time_ns;
  const auto info = reader_.read(info_.at(time_ns));
  if (!info) return pass_on(info.error());
  auto frame = wire::frame_from_info(info->data);
  if (!frame) return pass_on(frame.error());
  LoadedFrame loaded{std::move(*frame), {}};
  loaded.report.camera_origin = CameraOrigin::kFile;
  const auto image = reader_.read(depth_[index]);
  if (!image) return pass_on(image.error());
  auto depth = wire::depth_from_raw_image(image->data, options_.depth_scale_m.value_or(loaded.frame.depth.scale_m));
  if (!depth) return pass_on(depth.error());
  loaded.frame.depth = std::move(*depth);
  if (const auto color = color_.find(time_ns); color != color_.end()) {
    const auto message = reader_.read(color->second);
    auto pixels = message ? wire::color_from_raw_image(message->data) : Result<Image<Rgb8>>(pass_on(message.error()));
    if (pixels) loaded.frame.color = std::move(*pixels);
    else loaded.report.notes.push_back("colour left out: " + pixels.error().what);
  }
  if (auto placed = put_camera(loaded, time_ns); !placed) return pass_on(placed.error());
  return loaded;
}

Result<LoadedFrame> McapStreams::load_theirs(std::size_t index) {
  const std::uint64_t time_ns = depth_[index].log_time_ns;
  const auto message = reader_.read(depth_[index]);
  if (!message) return pass_on(message.error());
  LoadedFrame loaded;
  loaded.frame.noise = options_.noise;
  const double scale = options_.depth_scale_m.value_or(0.001);
  auto depth = depth_schema_ == kRawImage        ? wire::depth_from_raw_image(message->data, scale)
               : depth_schema_ == kRosCompressed ? depth_from_ros_compressed(message->data, scale)
                                                 : depth_from_ros_image(message->data, scale);
  if (!depth) return failure(depth.error().code, fmt::format("{}: {}", file_.string(), depth.error().what));
  loaded.frame.depth = std::move(*depth);
  const auto stamp = depth_schema_ == kRawImage ? Result<Nanoseconds>(Nanoseconds(static_cast<std::int64_t>(message->publish_time_ns))) : ros_stamp(message->data);
  if (!stamp) return pass_on(stamp.error());
  loaded.frame.stamps = {*stamp, *stamp, *stamp};
  if (!color_.empty()) {
    auto nearest = color_.lower_bound(time_ns);
    if (nearest == color_.end()) --nearest;
    const auto image = reader_.read(nearest->second);
    auto pixels = !image ? Result<Image<Rgb8>>(pass_on(image.error())) : color_schema_ == kRawImage ? wire::color_from_raw_image(image->data) : color_from_ros_image(image->data);
    if (pixels) loaded.frame.color = std::move(*pixels);
    else loaded.report.notes.push_back("colour left out: " + pixels.error().what);
  }
  if (auto placed = put_camera(loaded, time_ns); !placed) return pass_on(placed.error());
  return loaded;
}

/// The options' camera, else the recording's (the last one before the frame, else the first), else the usual Kinect's.
Result<void> McapStreams::put_camera(LoadedFrame& loaded, std::uint64_t time_ns) {
  Frame& frame = loaded.frame;
  if (options_.camera) {
    frame.camera = options_.camera->camera;
    frame.T_world_sensor = options_.camera->T_world_sensor;
    loaded.report.camera_origin = CameraOrigin::kGiven;
  } else if (!is_ours_ && !camera_.empty()) {
    auto at = camera_.upper_bound(time_ns);
    if (at != camera_.begin()) --at;
    if (!cameras_.contains(at->first)) {
      const auto message = reader_.read(at->second);
      if (!message) return pass_on(message.error());
      auto camera = camera_schema_ == kRosInfo ? camera_from_ros_info(message->data) : wire::camera_from_calibration(message->data);
      if (!camera) return failure(camera.error().code, fmt::format("{}: {}", file_.string(), camera.error().what));
      cameras_ = {{at->first, std::move(*camera)}};
    }
    frame.camera = cameras_.at(at->first);
    loaded.report.camera_origin = CameraOrigin::kFile;
  } else if (!is_ours_) {
    frame.camera = default_kinect_camera(frame.depth.pixels.width, frame.depth.pixels.height);
    loaded.report.camera_origin = CameraOrigin::kAssumed;
    loaded.report.notes.emplace_back("no camera is known: the usual Kinect camera is assumed");
  }
  const auto camera = camera_for_image(frame.camera, frame.depth.pixels.width, frame.depth.pixels.height);
  if (!camera) return failure(camera.error().code, fmt::format("{}: {}", file_.string(), camera.error().what));
  frame.camera = *camera;
  if (frame.color.width != frame.camera.width || frame.color.height != frame.camera.height) {
    if (!frame.color.empty()) loaded.report.notes.push_back(fmt::format("colour of {} x {} pixels left out: it is not registered to depth", frame.color.width, frame.color.height));
    frame.color = {};
  }
  return {};
}

}  // namespace gfp
