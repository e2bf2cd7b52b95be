// gfp calibrate: hands over to gfp-calibrate beside this program, so that only calibrating loads OpenCV.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "cli/commands.hpp"

namespace gfp {

void add_calibrate_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("calibrate", "Calibrate a stereo camera from pictures of a chessboard (gfp calibrate --help)");
  command.prefix_command();  // everything behind it is gfp-calibrate's
  command.set_help_flag();
  command.callback([&command, &status] {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "gfp-calibrate";
    std::vector<std::string> words = command.remaining();
    std::vector<char*> arguments;
    std::string name = "gfp-calibrate";
    arguments.push_back(name.data());
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    std::cerr << "gfp: calibrate: " << program.string() << ": " << std::strerror(errno) << " (it is built where libopencv-calib3d-dev is installed)\n";
    status.fail(kExitUnavailable);
  });
}

}  // namespace gfp
