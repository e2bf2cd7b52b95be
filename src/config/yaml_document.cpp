#include "config/yaml_document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

namespace gfp::config {
namespace {

/// Thrown and caught in this file only: yaml-cpp knows no other way to stop a parse.
struct LimitExceeded {
  int line;
  std::string what;
};

/// Walks the parser's events and counts, so that a hostile document is refused before its nodes are built. yaml-cpp
/// keeps the first of two equal keys silently; here they are seen, as scalars at an even place of a mapping.
class LimitGuard : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { leaf(mark, "null"); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    if (++aliases_ > kMaxAliases) throw LimitExceeded{mark.line, fmt::format("more than {} aliases", kMaxAliases)};
    leaf(mark, "");
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string& value) override { leaf(mark, value); }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override { enter(mark, false); }
  void OnSequenceEnd() override { levels_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override { enter(mark, true); }
  void OnMapEnd() override { levels_.pop_back(); }

 private:
  struct Level {
    bool is_map = false;
    bool key_is_next = false;
    std::set<std::string> keys;
  };

  void count(const YAML::Mark& mark) {
    if (++nodes_ > kMaxNodes) throw LimitExceeded{mark.line, fmt::format("more than {} values", kMaxNodes)};
  }
  void leaf(const YAML::Mark& mark, const std::string& value) {
    count(mark);
    if (levels_.empty() || !levels_.back().is_map) return;
    Level& map = levels_.back();
    if (map.key_is_next && !map.keys.insert(value).second) throw LimitExceeded{mark.line, fmt::format("key {} stands here twice", value)};
    map.key_is_next = !map.key_is_next;
  }
  void enter(const YAML::Mark& mark, bool is_map) {
    count(mark);
    if (levels_.size() >= kMaxDepth) throw LimitExceeded{mark.line, fmt::format("nested deeper than {} levels", kMaxDepth)};
    if (!levels_.empty() && levels_.back().is_map) {
      if (levels_.back().key_is_next) throw LimitExceeded{mark.line, "a key must be a plain word"};
      levels_.back().key_is_next = true;
    }
    levels_.push_back({is_map, is_map, {}});
  }

  int nodes_ = 0, aliases_ = 0;
  std::vector<Level> levels_;
};

}  // namespace

Result<YAML::Node> parse_yaml(std::string_view text, const std::string& source) {
  if (text.size() > kMaxFileBytes)
    return failure(ErrorCode::kTooLarge, fmt::format("{}: {} bytes, at most {} are read", source, text.size(), kMaxFileBytes));
  const auto corrupt = [&](int line, const std::string& what) {
    return failure(ErrorCode::kCorruptData, fmt::format("{}:{}: {}", source, line + 1, what));
  };
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    LimitGuard guard;
    int documents = 0;
    while (parser.HandleNextDocument(guard))
      if (++documents > 1) return corrupt(0, "more than one YAML document");
    return YAML::Load(std::string(text));
  } catch (const LimitExceeded& limit) {
    return corrupt(limit.line, limit.what);
  } catch (const YAML::Exception& error) {
    return corrupt(error.mark.line, error.msg);
  } catch (const std::exception& error) {
    return corrupt(0, error.what());
  }
}

Result<std::string> read_text(const std::filesystem::path& file) {
  std::error_code status;
  if (!std::filesystem::exists(file, status)) return failure(ErrorCode::kNotFound, fmt::format("{}: no such file", file.string()));
  if (std::filesystem::is_directory(file, status)) return failure(ErrorCode::kIo, fmt::format("{}: is a directory", file.string()));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return failure(ErrorCode::kIo, fmt::format("{}: {}", file.string(), std::strerror(errno)));
  std::string text(kMaxFileBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kMaxFileBytes) return failure(ErrorCode::kTooLarge, fmt::format("{}: more than {} bytes", file.string(), kMaxFileBytes));
  return text;
}

}  // namespace gfp::config
