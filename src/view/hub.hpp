#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "gfp/frame/replay_control.hpp"
#include "publish/inbox.hpp"
#include "view/client.hpp"

namespace gfp::view {

/// What the view publishes, and to whom: channels, the last value of each, the clients. Nothing is encoded that no client wants.
/// The view's thread only.
class Hub {
 public:
  /// Takes a request whose reply comes with take(), as one of its content; empty: no service is offered.
  using Ask = std::function<void(PeerRequest)>;

  /// `playback`: the knobs of the recording that is played; empty: nothing is offered to be steered.
  Hub(std::string name, std::uint64_t session, std::shared_ptr<ReplayControl> playback = {}, Ask ask = {});

  void join(Client& client);   ///< Says who we are and what there is.
  void leave(Client& client);
  std::size_t clients() const { return clients_.size(); }

  /// One text message of a client. What is wrong with it, it is told.
  void heard(Client& client, std::string_view text);
  void heard_binary(Client& client, std::string_view bytes);

  void take(Inbox::Content content);

 private:
  enum class Stream : std::uint8_t { kScene, kMesh, kMarkers, kStatus, kLog, kDepth, kColor, kCamera, kCloud, kTransforms, kShadow };
  struct Entry {
    Stream stream = Stream::kScene;
    std::string name;  ///< Of the sensor, of a shadow the method; empty where the stream is of all.
    Channel channel;
  };
  struct KnownTopology {
    std::shared_ptr<const Topology> topology;
    std::size_t vertices = 0;
  };

  Entry& channel_for(Stream stream, const std::string& name);
  bool is_wanted(const Entry& entry) const;

  void call(Client& client, const ServiceCall& call);
  void answer(const PeerReply& reply);
  void steer(Client& client, const PlaybackRequest& request);
  void tell_playback();
  PlaybackState playback_now() const;
  void take_frame(const FramePtr& frame);
  void take_scene(const ScenePtr& scene);
  void take_shadow(const ScenePtr& shadow);
  void take_topologies(const Scene& scene);
  void send_last(Client& client, const Entry& entry);
  void send_frame_stream(const Entry& entry, const Frame& frame, Client* only);
  void send_scene_stream(const Entry& entry, const Scene& scene, Client* only);
  void send_topology(const Entry& entry, std::uint64_t hash, const KnownTopology& known, Client* only);
  void send_status(const Entry& entry, const v1::SensorStatus& status, Client* only);
  void deliver(const Entry& entry, const std::string& key, std::uint64_t log_time_ns, const google::protobuf::MessageLite& message, Client* only);

  static constexpr std::size_t kMaxTopologies = 256, kMaxCalls = 16;

  const std::string name_;
  const std::uint64_t session_;
  const std::shared_ptr<ReplayControl> playback_;
  const Ask ask_;
  struct Call {
    Client* client = nullptr;
    std::uint32_t id = 0;
  };
  std::map<std::string, Call> calls_;  ///< That wait for their replies, by the peer that these come back to.
  std::uint64_t next_call_ = 0;
  std::optional<PlaybackState> told_;  ///< To those who steer.
  std::set<Client*> clients_;
  std::map<std::pair<Stream, std::string>, Entry> channels_;
  std::map<std::uint32_t, const Entry*> by_id_;
  std::map<std::string, FramePtr> frames_;   ///< The last one of each sensor, as those below.
  std::map<std::string, ScenePtr> scenes_;
  std::map<std::string, ScenePtr> shadows_;
  std::map<std::string, v1::SensorStatus> statuses_;
  std::map<std::uint64_t, KnownTopology> topologies_;
};

}  // namespace gfp::view
