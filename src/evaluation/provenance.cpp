#include <fstream>
#include <string>
#include <thread>

#include "gfp/evaluation/summary.hpp"
#include "gfp_commit.hpp"

namespace gfp {

std::string machine_name() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  std::string line, model = "unknown processor";
  while (std::getline(cpuinfo, line))
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
      model = line.substr(line.find(": ") + 2);
      break;
    }
  return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores";
}

std::string source_commit() { return GFP_COMMIT; }

}  // namespace gfp
