// What the eyes are shown, on runtimes of every kind, against `voyager render` of the same
// cameras.
#include <algorithm>
#include <cmath>

#include "tests/openxr_headset/headset_run.h"

namespace voyager::test {
namespace picture_test {
namespace {

std::string readback(const std::string& folder) {
  return " --readback " + folder;
}

TEST_F(Headset, EyesSeeWhatVoyagerRenders) {
  expect_well_behaved(Json::object(), "--frames 12" + readback(file("all")));
  expect_rendered("all", 12, 1, "everything");
  const Json cameras = read_json("all/cameras.json");
  EXPECT_NE(cameras[0]["cx"], cameras[2]["cx"]);  // the frusta change from frame to frame,
  EXPECT_NE(cameras[0]["fx"], cameras[2]["fx"]);
  EXPECT_NE(cameras[0]["position"], cameras[2]["position"]);  // and so do the poses
}

// The runtime's own account: what it was shown, and where it had the eyes then.
class Shown : public Headset {
 protected:
  // The city's first camera looks along z, so LOCAL space lies in the scene as this says.
  void show(Json script) const {
    const Json start = read_json("city.cameras.json")[0];
    script["local_in_scene"] = {{"position", start["position"]}, {"orientation", {1, 0, 0, 0}}};
    script["output"] = file("shown");
    expect_well_behaved(script, "--frames 3 --tau 3");
    const Outcome result = run("voyager render " + file("city.voy") + " --cameras " +
                               file("shown/cameras.json") + " --stereo --all -o " + file("exact"));
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  static Picture exact(int image) {
    char text[32];
    std::snprintf(text, sizeof text, "exact/%04d.png", image);
    return read_png(file(text));
  }
};

TEST_F(Shown, TheCompositorGetsTheEyesItAskedFor) {
  show({{"extensions", {"XR_KHR_composition_layer_depth"}}});
  for (int image = 0; image < 6; ++image)
    EXPECT_LE(largest_difference(eye_picture("shown", image / 2, image % 2 == 0 ? 'L' : 'R'),
                                 exact(image)),
              1)
        << image;
}

// What is out of sight is black, and not much; all else is as it is without a mask.
TEST_F(Shown, TheVisibilityMaskHidesNothingThatIsSeen) {
  show(Json::object());
  for (int image = 0; image < 6; ++image) {
    const Picture found = eye_picture("shown", image / 2, image % 2 == 0 ? 'L' : 'R');
    const Picture whole = exact(image);
    ASSERT_EQ(found.values.size(), whole.values.size());
    size_t masked = 0;
    for (size_t i = 0; i < found.values.size(); i += 3) {
      const bool equal = std::abs(found.values[i] - whole.values[i]) <= 1 &&
                         std::abs(found.values[i + 1] - whole.values[i + 1]) <= 1 &&
                         std::abs(found.values[i + 2] - whole.values[i + 2]) <= 1;
      if (equal) continue;
      ++masked;
      EXPECT_EQ(found.values[i] + found.values[i + 1] + found.values[i + 2], 0);
    }
    EXPECT_GT(masked, found.values.size() / 3 / 100);
    EXPECT_LT(masked, found.values.size() / 3 / 4);
  }
}

// In metres, as the compositor works them out from near and far.
TEST_F(Shown, TheDepthLayerHoldsVoyagersDepth) {
  show({{"extensions", {"XR_KHR_composition_layer_depth"}}});
  const Outcome result =
      run("voyager render " + file("city.voy") + " --cameras " + file("shown/cameras.json") +
          " --camera 0 -o " + file("left.png") + " --depth " + file("left.pfm"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Picture found = read_pfm(file("shown/0000_L.pfm")), expected = read_pfm(file("left.pfm"));
  ASSERT_EQ(found.values.size(), expected.values.size());
  size_t with_depth = 0, outliers = 0;
  for (size_t i = 0; i < found.values.size(); ++i) {
    const float z = expected.values[i];
    with_depth += std::isfinite(z);
    outliers += std::isfinite(z) ? std::abs(found.values[i] - z) > 0.01f * z
                                 : std::abs(found.values[i] - 10000) > 1000;
  }
  EXPECT_GT(with_depth, found.values.size() / 4);
  // One eye's cut is not quite two eyes'.
  EXPECT_LE(outliers, found.values.size() / 50);
}

// No depth layer, no visibility mask, formats and sizes as they come.
TEST_F(Headset, AMinimalRuntimeIsEnough) {
  const Json minimal = {{"extensions", Json::array()}};
  for (const Json& size : {Json{1, 1}, Json{97, 31}, Json{{64, 48}, {64, 48}}}) {
    Json script = minimal;
    script["recommended"] = size;
    expect_well_behaved(script, "--frames 4" + readback(file("minimal")));
    expect_rendered("minimal", 4, 1, size.dump());
  }
  for (const Json& formats :
       {Json::array({"D32_SFLOAT", "R8G8B8A8_UNORM", "B8G8R8A8_UNORM", "B8G8R8A8_SRGB"}),
        Json::array({"R8G8B8A8_UNORM", "R16G16B16A16_SFLOAT"}),
        Json::array({"R16G16B16A16_SFLOAT"})}) {
    Json script = minimal;
    script["formats"] = formats;
    expect_well_behaved(script, "--frames 4" + readback(file("formats")));
    expect_rendered("formats", 4, 1, formats.dump());
  }
}

// 8 bits of linear light: within half a step of it, which in the darks is many code values.
TEST_F(Headset, EightBitsOfLinearLightAreAsGoodAsTheyCanBe) {
  const auto linear = [](double code) {
    const double v = code / 255;
    return 255 * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  };
  expect_well_behaved({{"extensions", Json::array()}, {"formats", {"R8G8B8A8_UNORM"}}},
                      "--frames 2" + readback(file("linear")));
  const Outcome result = run("voyager render " + file("city.voy") + " --cameras " +
                             file("linear/cameras.json") + " --stereo --all -o " + file("exact"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Picture found = eye_picture("linear", 1, 'R'), expected = read_png(file("exact/0003.png"));
  ASSERT_EQ(found.values.size(), expected.values.size());
  double most = 0;
  for (size_t i = 0; i < found.values.size(); ++i)
    most = std::max(most,
                    std::abs(linear(double{found.values[i]}) - linear(double{expected.values[i]})));
  // Half a step, and what the code values' own rounding adds at the bright end.
  EXPECT_LT(most, 1.7);
}

TEST_F(Headset, EyesOfTwoSizesHaveASwapchainEach) {
  expect_well_behaved({{"recommended", {{96, 40}, {61, 72}}}},
                      "--frames 4" + readback(file("sizes")));
  EXPECT_EQ(read_json("report.json")["calls"]["xrCreateSwapchain"], 4);
  expect_rendered("sizes", 4, 1, "two sizes");
}

TEST_F(Headset, ARuntimeWithoutArrayImagesIsServed) {
  write_script({{"extensions", Json::array()},
                {"failures",
                 {{{"call", "xrCreateSwapchain"}, {"result", "XR_ERROR_FEATURE_UNSUPPORTED"}}}}});
  const Outcome result = run(headset("--frames 4" + readback(file("each"))));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  expect_rendered("each", 4, 1, "a swapchain an eye");
}

TEST_F(Headset, AFixedPoseIsTheFirstCameras) {
  expect_well_behaved(Json::object(), "--fixed-pose --frames 6" + readback(file("fixed")));
  expect_rendered("fixed", 6, 1, "fixed");
  const Json cameras = read_json("fixed/cameras.json");
  const Json first = read_json("city.cameras.json")[0];
  for (size_t i = 0; i < cameras.size(); i += 2)
    for (size_t axis = 0; axis < 3; ++axis) {
      const double left = cameras[i]["position"][axis], right = cameras[i + 1]["position"][axis];
      EXPECT_NEAR((left + right) / 2, first["position"][axis].get<double>(), 1e-6);
      EXPECT_NEAR(cameras[i]["rotation"][axis][2].get<double>(),
                  first["rotation"][axis][2].get<double>(), 0.2);
    }
  EXPECT_NE(cameras[0]["cx"], cameras[2]["cx"]);  // still the runtime's FOVs
}

// 3 m/s with the stick all the way forward, whichever way the city lies.
TEST_F(Headset, ThumbsticksWalkInMetres) {
  const Json touch = {{"frame", 0}, {"/user/hand/left", true}, {"/user/hand/right", true}};
  Json pressed = touch;
  pressed["frame"] = 10;
  pressed["/user/hand/left/input/thumbstick"] = {0, 1};
  const auto walk = [&](const Json& input) {
    expect_well_behaved({{"hz", 90}, {"input", input}}, "--frames 40" + readback(file("walk")));
    return read_json("walk/cameras.json");
  };
  const Json still = walk(Json::array({touch})), walked = walk(Json::array({touch, pressed}));
  double squared = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double way =
        walked[78]["position"][axis].get<double>() - still[78]["position"][axis].get<double>();
    squared += way * way;
  }
  // Shown frame 39 is the runtime's 42 or 43; the stick has been forward since 10.
  EXPECT_NEAR(std::sqrt(squared), 3.0 * 33 / 90, 3.0 * 2 / 90);
}

}  // namespace
}  // namespace picture_test
}  // namespace voyager::test
