#include "cli/exit_code.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace gfp {
namespace {

// A shell script must be able to tell "no such file" from "broken file" from "wrong arguments".
TEST(ExitCode, FollowsSysexits) {
  EXPECT_EQ(exit_code_of({ErrorCode::kInvalidArgument, ""}), 64);
  EXPECT_EQ(exit_code_of({ErrorCode::kCorruptData, ""}), 65);
  EXPECT_EQ(exit_code_of({ErrorCode::kTooLarge, ""}), 65);
  EXPECT_EQ(exit_code_of({ErrorCode::kUnsupported, ""}), 65);
  EXPECT_EQ(exit_code_of({ErrorCode::kNotFound, ""}), 66);
  EXPECT_EQ(exit_code_of({ErrorCode::kDeviceLost, ""}), 69);
  EXPECT_EQ(exit_code_of({ErrorCode::kIo, ""}), 74);
}

TEST(ExitStatus, KeepsTheFirstErrorAndNamesEverySubject) {
  std::ostringstream err;
  ExitStatus status;
  EXPECT_EQ(status.code(), 0);
  status.fail(err, "a.pcd", {ErrorCode::kCorruptData, "WIDTH missing"});
  status.fail(err, "b.pcd", {ErrorCode::kNotFound, "no such file"});
  EXPECT_EQ(status.code(), 65);
  EXPECT_EQ(err.str(), "gfp: a.pcd: WIDTH missing (corrupt_data)\ngfp: b.pcd: no such file (not_found)\n");
}

}  // namespace
}  // namespace gfp
