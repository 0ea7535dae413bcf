#pragma once
#include <gtest/gtest.h>

#include <string>

#include "tests/command_line/program.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"

namespace voyager::test {

// What `voyager render` makes on the CPU of a scene in the folder. Leaves out.png, and the depth in
// depth.pfm.
inline Picture rendered(const TempFolder& folder, const std::string& scene,
                        const std::string& cameras_json) {
  write_bytes(folder.file("cameras.json"), cameras_json);
  const Outcome result =
      run("voyager render " + folder.file(scene) + " --cameras " + folder.file("cameras.json") +
          " --backend cpu -o " + folder.file("out.png") + " --depth " + folder.file("depth.pfm"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  return read_png(folder.file("out.png"));
}

}  // namespace voyager::test
