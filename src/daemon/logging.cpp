#include "daemon/logging.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace gfp {
namespace {

v1::LogRecord::Level level_of(spdlog::level::level_enum level) {
  if (level >= spdlog::level::err) return v1::LogRecord::LEVEL_ERROR;
  if (level == spdlog::level::warn) return v1::LogRecord::LEVEL_WARNING;
  return level == spdlog::level::info ? v1::LogRecord::LEVEL_INFO : v1::LogRecord::LEVEL_DEBUG;
}

/// Hands records to the publisher's inbox; the base class locks around both calls.
class PublisherSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  void set_publisher(Publisher* publisher) {
    const std::lock_guard lock(mutex_);
    publisher_ = publisher;
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (publisher_ == nullptr || message.level < spdlog::level::info) return;
    v1::LogRecord record;
    record.set_stamp_ns(std::chrono::duration_cast<Nanoseconds>(message.time.time_since_epoch()).count());
    record.set_level(level_of(message.level));
    record.set_text(std::string(message.payload.data(), message.payload.size()));
    publisher_->put(std::move(record));
  }
  void flush_() override {}

 private:
  Publisher* publisher_ = nullptr;
};

std::shared_ptr<PublisherSink>& publisher_sink() {
  static auto sink = std::make_shared<PublisherSink>();
  return sink;
}

}  // namespace

Result<void> start_logging(const LogOptions& options) {
  spdlog::sink_ptr out;
  try {
    if (options.file.empty()) out = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    else out = std::make_shared<spdlog::sinks::basic_file_sink_mt>(options.file);
  } catch (const spdlog::spdlog_ex& error) {
    return failure(ErrorCode::kIo, fmt::format("log.file = {}: {}", options.file, error.what()));
  }
  auto logger = std::make_shared<spdlog::logger>("gfpd", spdlog::sinks_init_list{out, publisher_sink()});
  logger->set_level(spdlog::level::from_str(options.level));
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %v");
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
  return {};
}

void publish_log_to(Publisher* publisher) { publisher_sink()->set_publisher(publisher); }

}  // namespace gfp
