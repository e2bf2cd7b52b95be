// What publishing costs beside what libzmq and memcpy cost in the same run.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstring>
#include <string>

#include "publish/outlet.hpp"
#include "support/shapes.hpp"
#include "wire/mesh_messages.hpp"
#include "wire/sensor_messages.hpp"

namespace gfp {
namespace {

const std::string kTopic = "/gfp/sensor/front/depth/";

FramePtr kinect_frame() {
  auto frame = std::make_shared<Frame>();
  frame->sensor = "front";
  frame->camera = default_kinect_camera();
  frame->depth.pixels = Image<std::uint16_t>(640, 480, 1000);
  return frame;
}

/// A publisher and one subscriber over ipc, both on this thread: a message is sent and received, then the next.
struct Wire {
  explicit Wire(const char* name) : endpoint("ipc:///tmp/gfp_bench_" + std::to_string(getpid()) + name) {}

  void connect(zmq::socket_t& publisher) {
    subscriber.set(zmq::sockopt::linger, 0);
    subscriber.set(zmq::sockopt::subscribe, kTopic);
    subscriber.connect(endpoint);
    zmq::message_t subscription;
    (void)publisher.recv(subscription);  // it has arrived
  }
  void receive() {
    zmq::message_t part;
    do (void)subscriber.recv(part);
    while (part.more());
  }

  std::string endpoint;
  zmq::context_t context{1};
  zmq::socket_t subscriber{context, zmq::socket_type::sub};
};

/// The floor: topic and pixels, not copied, nothing else.
void BM_PublishDepthRawZmq(benchmark::State& state) {
  Wire wire("raw");
  zmq::socket_t publisher(wire.context, zmq::socket_type::xpub);
  publisher.set(zmq::sockopt::linger, 0);
  publisher.bind(wire.endpoint);
  wire.connect(publisher);
  const FramePtr frame = kinect_frame();
  const auto blob = wire::depth_blob(*frame);
  for (auto _ : state) {
    publisher.send(zmq::buffer(kTopic), zmq::send_flags::sndmore);
    publisher.send(zmq::message_t(const_cast<std::byte*>(blob.data()), blob.size(), [](void*, void*) {}), zmq::send_flags::none);
    wire.receive();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(blob.size()));
}
BENCHMARK(BM_PublishDepthRawZmq)->UseRealTime()->Unit(benchmark::kMicrosecond);

/// Ours: envelope, header, pixels.
void BM_PublishDepth(benchmark::State& state) {
  Wire wire("ours");
  auto bound = bind_socket(wire.context, zmq::socket_type::xpub, {wire.endpoint}, {});
  if (!bound) return state.SkipWithError(bound.error().what.c_str());
  Outlet outlet(std::move(*bound), 1);
  outlet.socket().set(zmq::sockopt::linger, 0);
  wire.connect(outlet.socket());
  const FramePtr frame = kinect_frame();
  for (auto _ : state) {
    v1::DepthImage message;
    wire::fill_depth(*frame, message);
    outlet.send(kTopic, message, frame->stamps, 0, {wire::depth_blob(*frame), frame});
    wire.receive();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(wire::depth_blob(*frame).size()));
}
BENCHMARK(BM_PublishDepth)->UseRealTime()->Unit(benchmark::kMicrosecond);

FittedModel sphere_model() {
  const TriangleMesh mesh = test::sphere(0.05, 60, 40);
  FittedModel model;
  auto topology = std::make_shared<Topology>();
  topology->triangles = mesh.triangles;
  model.topology = topology;
  model.vertices = mesh.vertices;
  model.states.assign(mesh.vertices.size(), 1);
  model.sigma_m.assign(mesh.vertices.size(), 0.002F);
  return model;
}

/// What a mesh takes to become bytes: 0 float32, 1 int16.
void BM_SerialiseMesh(benchmark::State& state) {
  const FittedModel model = sphere_model();
  std::string bytes;
  for (auto _ : state) {
    v1::Vertices message;
    wire::fill(model, state.range(0) == 0 ? wire::VertexCoding::kFloat32 : wire::VertexCoding::kInt16, message);
    message.SerializeToString(&bytes);
    benchmark::DoNotOptimize(bytes.data());
  }
  state.counters["bytes"] = static_cast<double>(bytes.size());
}
BENCHMARK(BM_SerialiseMesh)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

/// The floor: the model's own bytes copied into a fresh buffer.
void BM_CopyMesh(benchmark::State& state) {
  const FittedModel model = sphere_model();
  const std::size_t position_bytes = model.vertices.size() * sizeof model.vertices[0], sigma_bytes = model.sigma_m.size() * sizeof(float);
  for (auto _ : state) {
    std::string bytes(position_bytes + model.states.size() + sigma_bytes, '\0');
    std::memcpy(bytes.data(), model.vertices.data(), position_bytes);
    std::memcpy(bytes.data() + position_bytes, model.states.data(), model.states.size());
    std::memcpy(bytes.data() + position_bytes + model.states.size(), model.sigma_m.data(), sigma_bytes);
    benchmark::DoNotOptimize(bytes.data());
  }
}
BENCHMARK(BM_CopyMesh)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace gfp
