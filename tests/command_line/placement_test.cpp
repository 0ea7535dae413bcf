// Several inputs of a bake, each in its place.
#include <gtest/gtest.h>

#include "tests/command_line/program.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace placement_test {
namespace {

class PlacedBake : public ::testing::Test {
 protected:
  void SetUp() override {
    const Bytes bytes = ply_of(random_cloud(500, 3, 1));
    write_bytes(input, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }

  GaussianCloud leaves() {
    EXPECT_EQ(failure_of({"voyager export " + scene + " -o " + folder.file("leaves.ply")}), "");
    return import_file(folder.file("leaves.ply"));
  }

  TempFolder folder;
  const std::string input = folder.file("input.ply"), scene = folder.file("scene.voy");
};

TEST_F(PlacedBake, IsTheSameInMemoryAndInParts) {
  const std::string inputs = "voyager bake " + input + " " + input +
                             " --up -y --up y --transform 'scale 2, rotate 0 1 0 90' --transform "
                             "'translate 500 0 0' --quality lossless -o ";
  const Outcome whole = run(inputs + scene);
  ASSERT_EQ(whole.exit_code, 0) << whole.output;
  const std::string parts = folder.file("parts.voy"), work = folder.file("work");
  const Outcome apart = run(inputs + parts + " --work " + work);
  ASSERT_EQ(apart.exit_code, 0) << apart.output;
  EXPECT_TRUE(file_bytes(scene) == file_bytes(parts));
}

// Each has the pixel of its own estimate: two inputs, one twice as large.
TEST_F(PlacedBake, InputsOfAnotherScaleHaveAnotherPixel) {
  const auto line = [&](const std::string& inputs) {
    EXPECT_EQ(failure_of({"voyager bake " + inputs + " -o " + scene}), "");
    const std::string text = run("voyager info " + scene).output;
    const size_t at = text.find("native pixel");
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(line(input + " " + input).find(" to "), std::string::npos);
  EXPECT_NE(line(input + " " + input + " --transform 'scale 2' --transform 'translate 500 0 0'")
                .find(" to "),
            std::string::npos);
}

TEST_F(PlacedBake, AWorkFolderIsOfOnePlacement) {
  const std::string bake = "voyager bake " + input + " -o " + scene + " --work " +
                           folder.file("work") + " --step split --transform ";
  ASSERT_EQ(run(bake + "'translate 1 0 0'").exit_code, 0);
  EXPECT_EQ(run(bake + "'translate 2 0 0'").exit_code, 2);
}

TEST_F(PlacedBake, MovesEveryGaussian) {
  ASSERT_EQ(failure_of({"voyager bake " + input + " -o " + scene + " --quality lossless"}), "");
  const GaussianCloud before = leaves();
  ASSERT_EQ(failure_of({"voyager bake " + input + " -o " + scene +
                        " --quality lossless --transform 'translate 100 0 -7'"}),
            "");
  const GaussianCloud after = leaves();
  ASSERT_EQ(after.size(), before.size());
  double sum = 0;
  for (size_t i = 0; i < before.size(); ++i)
    sum += double{after.position[3 * i]} - double{before.position[3 * i]};
  EXPECT_NEAR(sum / static_cast<double>(before.size()), 100, 1e-3);
}

TEST_F(PlacedBake, RefusesAnotherNumberOfPlaces) {
  const Outcome result =
      run("voyager bake " + input + " " + input + " " + input + " -o " + scene + " --up z --up y");
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_NE(result.output.find("one for each of the 3 inputs"), std::string::npos) << result.output;
  EXPECT_EQ(run("voyager bake " + input + " -o " + scene + " --transform 'scale 0'").exit_code, 2);
  EXPECT_EQ(run("voyager bake " + input + " -o " + scene + " --transform 'scale'").exit_code, 1);
}

}  // namespace
}  // namespace placement_test
}  // namespace voyager::test
