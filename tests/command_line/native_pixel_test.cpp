// Where a bake has the native pixel from, as a user says it and is told.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/format/reader.h"
#include "tests/command_line/program.h"
#include "tests/support/sealed.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace native_pixel_command_test {
namespace {

class NativePixelCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(
        run("voyager synth city --gaussians 10000 --sh-degree 0 -o " + file("c.ply")).exit_code, 0);
    std::string ply = file_bytes(file("c.ply"));
    const std::string format = "format binary_little_endian 1.0\n";
    ply.insert(ply.find(format) + format.size(), "comment SplatRenderMode: mip\n");
    std::ofstream(file("mip.ply"), std::ios::binary) << ply;
  }

  std::string file(const std::string& name) const { return folder_.file(name); }
  // Of what is baked with these arguments.
  NativeScale bake(const std::string& arguments) const {
    const Outcome baked = run("voyager bake " + arguments + " -o " + file("o.voy"));
    EXPECT_EQ(baked.exit_code, 0) << baked.output;
    said_ = baked.output;
    return SceneFile(open_file_source(file("o.voy"))).info().native;
  }

  const TempFolder folder_;
  mutable std::string said_;
};

TEST_F(NativePixelCommand, IsGivenFoundByCamerasOrEstimated) {
  EXPECT_EQ(bake(file("c.ply") + " --native-pixel 0.25"),
            (NativeScale{NativeSource::given, 0.25, kPixelVariance}));
  EXPECT_EQ(bake(file("c.ply")).source, NativeSource::estimated);
  for (const std::string& work : {std::string(), " --work " + file("work")}) {
    const NativeScale found =
        bake(file("c.ply") + " --training-cameras " + file("c.cameras.json") + work);
    EXPECT_EQ(found.source, NativeSource::cameras);
    EXPECT_NE(said_.find("they see"), std::string::npos) << said_;
    // Of a walk and a flight, at 960 pixels: blocks in the street, and seen from above.
    EXPECT_NE(said_.find("half of them with pixels below 0.09"), std::string::npos) << said_;
    EXPECT_NE(said_.find("each block of Gaussians gets its own"), std::string::npos) << said_;
    EXPECT_NEAR(found.pixel, 0.188, 0.02);
    EXPECT_GE(found.levels, 4);
    const Outcome text = run("voyager info " + file("o.voy"));
    EXPECT_NE(text.output.find(" to 0.1"), std::string::npos) << text.output;
    EXPECT_NE(text.output.find(" m, training cameras"), std::string::npos) << text.output;
    const auto json =
        nlohmann::json::parse(run("voyager info " + file("o.voy") + " --json").output);
    EXPECT_EQ(json["native_pixel"], found.pixel);
    EXPECT_DOUBLE_EQ(json["least_native_pixel"], found.pixel_of(found.levels - 1));
  }
}

TEST_F(NativePixelCommand, ACompensatedFilterIsTheFilesOwnHoweverItIsRead) {
  const NativeScale mip = compensated_scale(kMipSplattingLowPass);
  EXPECT_EQ(bake(file("mip.ply")), mip);
  EXPECT_EQ(bake(file("mip.ply") + " --work " + file("work")), mip);
  EXPECT_EQ(bake("- < " + file("mip.ply")), mip);
  EXPECT_EQ(run("voyager export " + file("o.voy") + " -o " + file("again.ply")).exit_code, 0);
  const Outcome info = run("voyager info " + file("again.ply") + " --json");
  EXPECT_EQ(nlohmann::json::parse(info.output)["low_pass"], 0.1) << info.output;
  for (const std::string& option :
       {std::string(" --native-pixel 0.1"), " --training-cameras " + file("c.cameras.json")}) {
    const Outcome refused =
        run("voyager bake " + file("mip.ply") + option + " -o " + file("n.voy"));
    EXPECT_EQ(refused.exit_code, 2) << refused.output;
    EXPECT_NE(refused.output.find("mip.ply: found a scene that was trained with a compensated"),
              std::string::npos)
        << refused.output;
    EXPECT_FALSE(std::filesystem::exists(file("n.voy")));
  }
}

// Where nodes learn from is another question; cameras that see nothing are wrong for that, too.
TEST_F(NativePixelCommand, CamerasMayGuideWhatLearnsOfACompensatedFilter) {
  std::ofstream(file("away.json"))
      << R"([{"id": 0, "img_name": "away", "width": 64, "height": 48, "position": [0, 0, 9000],)"
         R"( "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "fx": 60, "fy": 60}])";
  const Outcome refused = run("voyager bake " + file("mip.ply") + " --training-cameras " +
                              file("away.json") + " --optimize draft -o " + file("n.voy"));
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("training cameras: found none that sees a Gaussian"),
            std::string::npos)
      << refused.output;
}

// From afar 3DGS's own picture swells: it is farther from the truth.
TEST_F(NativePixelCommand, AntialiasedPicturesAreNearerToTheTruth) {
  bake(file("c.ply") + " --native-pixel 0.05");
  std::ofstream(file("far.json"))
      << R"([{"id": 0, "img_name": "far", "width": 64, "height": 48, "position": [0, -400, -400],)"
         R"( "rotation": [[1, 0, 0], [0, 0.6, 0.8], [0, -0.8, 0.6]], "fx": 60, "fy": 60}])";
  const auto drawn = [&](const std::string& with, const std::string& lod = " --lod off") {
    const Outcome found = run("voyager render " + file("o.voy") + " --cameras " + file("far.json") +
                              " --camera 0 --backend cpu" + lod + " -o " + file("o.pfm") + with);
    EXPECT_EQ(found.exit_code, 0) << found.output;
    const std::string bytes = file_bytes(file("o.pfm"));
    std::vector<float> values(64 * 48 * 3);
    const size_t size = values.size() * sizeof(float);
    EXPECT_GT(bytes.size(), size) << with;
    if (bytes.size() > size) std::memcpy(values.data(), &bytes[bytes.size() - size], size);
    return values;
  };
  const std::vector<float> truth = drawn(" --supersample 8");
  EXPECT_EQ(drawn(" --supersample 8", ""), truth);
  const auto squares = [&](const std::vector<float>& values) {
    double sum = 0;
    for (size_t i = 0; i < values.size(); ++i) {
      const double d = double{values[i]} - double{truth[i]};
      sum += d * d;
    }
    return sum;
  };
  const double on = squares(drawn("")), off = squares(drawn(" --antialias off"));
  EXPECT_GT(on, 0);
  EXPECT_LT(4 * on, off);
}

// Of files of version 4 the truth is not known.
TEST_F(NativePixelCommand, ATruthTakesANativePixel) {
  bake(file("c.ply") + " --native-pixel 0.05");
  const std::string whole = file_bytes(file("o.voy"));
  Bytes bytes(whole.size());
  std::memcpy(bytes.data(), whole.data(), whole.size());
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  header.native_pixel = 0;
  header.native_source = static_cast<uint32_t>(NativeSource::unknown);
  std::memcpy(bytes.data(), &header, sizeof header);
  bytes = sealed(bytes);
  std::ofstream(file("o.voy"), std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  const std::string render =
      "voyager render " + file("o.voy") + " --size 32x24 --backend cpu -o " + file("o.png");
  EXPECT_EQ(run(render).exit_code, 0);
  const Outcome refused = run(render + " --supersample 4");
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("o.voy: found no native pixel, expected one, without which the "
                                "truth of the scene is not known: bake it anew"),
            std::string::npos)
      << refused.output;
}

}  // namespace
}  // namespace native_pixel_command_test
}  // namespace voyager::test
