#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace gfp::test {

/// How a run of the real program ended.
struct CommandResult {
  int exit_code = -1;  ///< 128 + signal where one ended it.
  std::string out, err;

  /// The JSON lines of `out`.
  std::vector<nlohmann::json> lines() const {
    std::vector<nlohmann::json> parsed;
    std::size_t start = 0;
    for (std::size_t end = out.find('\n'); end != std::string::npos; start = end + 1, end = out.find('\n', start))
      parsed.push_back(nlohmann::json::parse(out.substr(start, end - start), nullptr, false));
    return parsed;
  }
};

/// Runs `gfp <arguments>`, as a shell would, with at most 2 GB of address space.
inline CommandResult run_gfp(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string(), err = (folder / "err").string();
  const int status = std::system(("ulimit -v 2000000; " GFP_PROGRAM " " + arguments + " >" + out + " 2>" + err).c_str());
  const auto text = [](const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text(out), text(err)};
}

}  // namespace gfp::test
