#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "gfp/client/subscriber.hpp"
#include "support/temporary_folder.hpp"

namespace gfp::test {

/// A child process with its output in a file; killed with its owner.
class ChildProcess {
 public:
  ChildProcess(std::vector<std::string> command, const std::string& output, const std::string& runtime_directory = "") {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable != nullptr; ++variable)
      if (!std::string_view(*variable).starts_with("RUNTIME_DIRECTORY=") || runtime_directory.empty()) variables.emplace_back(*variable);
    if (!runtime_directory.empty()) variables.push_back("RUNTIME_DIRECTORY=" + runtime_directory);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    if (posix_spawn(&pid_, command[0].c_str(), &actions, nullptr, pointers(command).data(), pointers(variables).data()) != 0) pid_ = -1;
    posix_spawn_file_actions_destroy(&actions);
  }
  ~ChildProcess() {
    signal(SIGKILL);
    wait();
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const {
    if (pid_ > 0) kill(pid_, number);
  }
  /// Its exit status, as waitpid() gives it; -1 where there is none any more.
  int wait() {
    int status = -1;
    if (pid_ > 0)
      while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
      }
    pid_ = -1;
    return status;
  }
  double rss_mb() const {
    std::ifstream file("/proc/" + std::to_string(pid_) + "/statm");
    double total = 0, resident = 0;
    file >> total >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
  }
  long descriptors() const {
    std::error_code error;
    return std::distance(std::filesystem::directory_iterator("/proc/" + std::to_string(pid_) + "/fd", error), {});
  }

 private:
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> list;
    for (std::string& text : texts) list.push_back(text.data());
    list.push_back(nullptr);
    return list;
  }
  pid_t pid_ = -1;
};

/// A gfpd on its demo, 30 frames a second, with endpoints of its own; `settings` as after --set, where {folder} is that of its sockets.
class DaemonProcess {
 public:
  explicit DaemonProcess(const std::vector<std::string>& settings = {}, const std::vector<std::string>& flags = {})
      : process_(command(settings, flags), log_file(), folder_.path().string()) {}

  ChildProcess& process() { return process_; }
  std::string endpoint(const std::string& name) const { return "ipc://" + (folder_ / "gfp" / name).string(); }
  const TemporaryFolder& folder() const { return folder_; }
  int view_port() const { return view_port_; }
  std::string log_file() const { return (folder_ / "log").string(); }
  std::string log() const {
    std::ifstream file(log_file());
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Listens to these topics over ipc.
  Subscriber subscribe(const std::vector<std::string>& topics) const {
    SubscriberOptions options;
    options.endpoints = {endpoint("sensor"), endpoint("state")};
    return std::move(*Subscriber::connect(topics, options));
  }
  /// A scene with an object came.
  bool is_serving() const { return subscribe({"/gfp/objects/"}).receive(std::chrono::seconds(60)).has_value(); }

 private:
  std::vector<std::string> command(const std::vector<std::string>& settings, const std::vector<std::string>& flags) const {
    std::vector<std::string> words = {GFP_DAEMON_PROGRAM, "--config", GFP_DEMO_CONFIG, "--set", "view.port=" + std::to_string(view_port_)};
    for (std::string setting : settings) {
      for (std::size_t at; (at = setting.find("{folder}")) != std::string::npos;) setting.replace(at, 8, (folder_ / "gfp").string());
      words.insert(words.end(), {"--set", setting});
    }
    words.insert(words.end(), flags.begin(), flags.end());
    return words;
  }

  TemporaryFolder folder_;
  const int view_port_ = 20'000 + getpid() % 20'000;
  ChildProcess process_;  ///< Last: it uses all of the above.
};

/// A tcp port beside the view's, by its offset.
inline int soak_port(int offset) { return 40'000 + 8 * (getpid() % 2'000) + offset; }

/// Waits for a condition, in steps of 20 ms; the seconds that it took, or -1 where it did not come.
template <class Condition>
double seconds_until(Condition&& condition, double patience_s) {
  const Nanoseconds begin = monotonic_now();
  const auto passed = [&] { return std::chrono::duration<double>(monotonic_now() - begin).count(); };
  while (!condition()) {
    if (passed() > patience_s) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return passed();
}

}  // namespace gfp::test
