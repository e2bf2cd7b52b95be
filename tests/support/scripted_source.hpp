#pragma once

#include <deque>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "gfp/frame/frame_source.hpp"

namespace gfp::test {

/// A source that plays a script: frames and errors of grab() in order, errors of open() where the script says so.
/// When the script is over, grab() says kEndOfStream.
class ScriptedSource final : public FrameSource {
 public:
  struct Step {
    std::variant<Frame, Error> outcome;
    bool at_open = false;
    std::function<void()> effect;  ///< Run just before the outcome is returned.
  };

  explicit ScriptedSource(std::vector<Step> script) : script_(script.begin(), script.end()) {}

  SourceInfo info() const override { return {"scripted", "fake", "0", 30, 0.4, 4, true}; }
  Result<void> open() override {
    ++opens;
    if (!script_.empty() && script_.front().at_open) return tl::unexpected<Error>(std::get<Error>(next().outcome));
    return {};
  }
  Result<Frame> grab(std::chrono::milliseconds) override {
    if (script_.empty()) return failure(ErrorCode::kEndOfStream, "the script is over");
    Step step = next();
    if (auto* error = std::get_if<Error>(&step.outcome)) return tl::unexpected<Error>(*error);
    return std::get<Frame>(std::move(step.outcome));
  }
  void close() noexcept override { ++closes; }

  int opens = 0, closes = 0;

 private:
  Step next() {
    Step step = std::move(script_.front());
    script_.pop_front();
    if (step.effect) step.effect();
    return step;
  }
  std::deque<Step> script_;
};

inline ScriptedSource::Step frame(std::uint64_t sequence) {
  Frame made;
  made.sequence = sequence;
  return {std::move(made), false, {}};
}
inline ScriptedSource::Step fault(ErrorCode code) { return {Error{code, std::string(to_string(code))}, false, {}}; }
inline ScriptedSource::Step paused() { return {Error{ErrorCode::kPaused, "somebody holds it"}, false, {}}; }
inline ScriptedSource::Step open_fault(ErrorCode code) { return {Error{code, std::string(to_string(code))}, true, {}}; }

}  // namespace gfp::test
