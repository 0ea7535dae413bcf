// What the extension writes into Godot's textures, and what it says where it cannot.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <regex>

#include "../headless/scene_bytes.h"
#include "tests/command_line/program.h"
#include "tests/godot/imitated_godot.h"
#include "tests/support/needs.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace godot_splats_test {
namespace {

constexpr uint32_t kWidth = 96, kHeight = 64;
constexpr std::array<int32_t, 2> kSize = {96, 64};

class GodotSplats : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    write_bytes(file("scene.ply"), ply_bytes(800));
    write_bytes(file("other.ply"), ply_bytes(50));
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string file(const std::string& name) { return folder_->file(name); }

  static GodotCamera camera(double x = 1) { return GodotCamera::at({x, 2, 12}, -0.1, -0.15, 0.2); }

  struct Textures {
    explicit Textures(ImitatedGodot& godot, uint32_t width = kWidth, uint32_t height = kHeight)
        : colour(godot.make_texture(VK_FORMAT_R8G8B8A8_UNORM, width, height)),
          depth(godot.make_texture(VK_FORMAT_R32_SFLOAT, width, height)) {}
    std::unique_ptr<GodotTexture> colour, depth;
  };

  static Picture rgb_of(const std::vector<uint8_t>& rgba) {
    Picture picture{kWidth, kHeight, {}};
    for (size_t i = 0; i < rgba.size(); ++i)
      if (i % 4 != 3) picture.values.push_back(rgba[i]);
    return picture;
  }
  static Picture shoot(ImitatedGodot& godot, const GodotCamera& camera, Textures& into) {
    EXPECT_TRUE(godot.shoot(camera, *into.colour, *into.depth)) << godot.last_error();
    return rgb_of(godot.read(*into.colour));
  }
  static Picture reference(const GodotCamera& camera) {
    write_bytes(file("cameras.json"), camera.cameras_json(kWidth, kHeight));
    const Outcome result =
        run("voyager render " + file("scene.ply") + " --cameras " + file("cameras.json") +
            " --backend cpu -o " + file("out.png") + " --depth " + file("depth.pfm"));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return read_png(file("out.png"));
  }
  static void expect_error(ImitatedGodot& godot, const std::string& part) {
    EXPECT_NE(godot.last_error().find(part), std::string::npos) << godot.last_error();
  }

  static inline TempFolder* folder_ = nullptr;
};

#define VOYAGER_NEEDS_VULKAN(godot) \
  if (!(godot).has_device()) VOYAGER_SKIP_WITHOUT(VULKAN, "no Vulkan device")

// Without any extension of Vulkan, as with Godot 4.3, and with those that Voyager can use.
TEST_F(GodotSplats, PicturesAndDepthAreWhatVoyagerRenders) {
  for (const bool enables : {false, true}) {
    GodotHabits habits;
    habits.enables_extensions = enables;
    ImitatedGodot godot(habits);
    VOYAGER_NEEDS_VULKAN(godot);
    EXPECT_EQ(godot.mode(), "");
    godot.open_scene(file("scene.ply"));
    Textures textures(godot);
    for (const double x : {1.0, -3.0, 0.5, 2.0}) {
      const Picture drawn = shoot(godot, camera(x), textures), expected = reference(camera(x));
      EXPECT_LE(largest_difference(drawn, expected), 1) << x;
      EXPECT_GT(*std::max_element(expected.values.begin(), expected.values.end()), 100);
    }
    const std::vector<uint8_t> bytes = godot.read(*textures.depth);
    const Picture metres = read_pfm(file("depth.pfm"));
    std::vector<float> depth(metres.values.size());
    std::memcpy(depth.data(), bytes.data(), bytes.size());
    for (size_t i = 0; i < depth.size(); ++i) {
      if (std::isinf(metres.values[i]))
        EXPECT_TRUE(std::isinf(depth[i])) << i;
      else
        EXPECT_NEAR(depth[i], metres.values[i], 1e-3f) << i;
    }
    EXPECT_EQ(godot.last_error(), "");
    EXPECT_NE(godot.mode(), "");
    if (!enables) {
      EXPECT_EQ(godot.mode().rfind("copied from host memory: ", 0), 0u) << godot.mode();
    }
  }
}

TEST_F(GodotSplats, ScenesAreReplacedAndTexturesChange) {
  ImitatedGodot godot;
  VOYAGER_NEEDS_VULKAN(godot);
  godot.open_scene(file("other.ply"));
  Textures small(godot, 40, 30), textures(godot);
  EXPECT_TRUE(godot.shoot(camera(), *small.colour, *small.depth)) << godot.last_error();
  godot.open_scene(file("other.ply"));
  godot.open_scene(file("scene.ply"));
  EXPECT_LE(largest_difference(shoot(godot, camera(), textures), reference(camera())), 1);
  godot.close_scene();
  EXPECT_FALSE(godot.draw(godot.rendering_device(), textures.colour->rid, textures.depth->rid,
                          kSize, camera().transform(), camera().projection()));
  EXPECT_EQ(godot.last_error(), "") << "nothing is open";
  godot.open_scene(file("scene.ply"));  // and the object is freed while it opens
}

// The splats of an object that never drew, and of one that opens in vain.
TEST_F(GodotSplats, AreFreedInEveryState) {
  { ImitatedGodot godot; }
  ImitatedGodot godot;
  godot.open_scene(file("scene.ply"));
}

TEST_F(GodotSplats, SayWhyTheyCannotDraw) {
  ImitatedGodot godot;
  VOYAGER_NEEDS_VULKAN(godot);
  Textures textures(godot);
  const auto draw = [&](GodotObject* device, uint64_t rid, std::array<int32_t, 2> size,
                        const std::array<float, 16>& projection) {
    return godot.draw(device, rid, textures.depth->rid, size, camera().transform(), projection);
  };
  const uint64_t rid = textures.colour->rid;
  const auto lens = camera().projection();
  EXPECT_FALSE(draw(nullptr, rid, kSize, lens));
  expect_error(godot, "found no RenderingDevice, expected the renderer Forward+ or Mobile");
  GodotObject other = {"Node"};
  EXPECT_FALSE(draw(&other, rid, kSize, lens));
  expect_error(godot, "expected a RenderingDevice");

  godot.open_scene(file("none.ply"));
  EXPECT_FALSE(godot.shoot(camera(), *textures.colour, *textures.depth));
  expect_error(godot, "VOY_ERROR_FILE_NOT_FOUND");
  godot.open_scene(file("scene.ply"));
  EXPECT_TRUE(godot.shoot(camera(), *textures.colour, *textures.depth)) << godot.last_error();
  EXPECT_FALSE(draw(&other, rid, kSize, lens));
  expect_error(godot, "expected a RenderingDevice");
  EXPECT_FALSE(draw(godot.rendering_device(), 7, kSize, lens));
  expect_error(godot, "found a RID without an image");
  EXPECT_FALSE(draw(godot.rendering_device(), rid, {-1, 64}, lens));
  expect_error(godot, "VOY_ERROR_INVALID_ARGUMENT");
  std::array<float, 16> flat = lens;
  flat[11] = 0;
  EXPECT_FALSE(draw(godot.rendering_device(), rid, kSize, flat));
  expect_error(godot, "orthogonal");
  EXPECT_LE(largest_difference(shoot(godot, camera(), textures), reference(camera())), 1);
}

TEST_F(GodotSplats, UntypedScriptsGetTheSamePictureAndAreToldOfMistakes) {
  ImitatedGodot godot;
  VOYAGER_NEEDS_VULKAN(godot);
  godot.open_scene(file("scene.ply"));
  Textures textures(godot);
  const Picture typed = shoot(godot, camera(), textures);
  Textures again(godot);
  GodotObject* device = godot.rendering_device();
  std::vector<GodotVariant> arguments = {
      GodotVariant::of(kGDObject, &device),
      GodotVariant::of(kGDRid, &again.colour->rid),
      GodotVariant::of(kGDRid, &again.depth->rid),
      GodotVariant::of(kGDVector2i, kSize.data()),
      GodotVariant::of(kGDTransform3D, camera().transform().data()),
      GodotVariant::of(kGDProjection, camera().projection().data())};
  GDCallError error = {};
  GodotVariant drawn = godot.call("draw", arguments, &error);
  EXPECT_EQ(error.error, 0);
  ASSERT_EQ(drawn.type, kGDBool);
  EXPECT_EQ(*static_cast<GDBool*>(drawn.value), 1) << godot.last_error();
  EXPECT_EQ(rgb_of(godot.read(*again.colour)).values, typed.values);

  std::swap(arguments[1], arguments[3]);
  EXPECT_EQ(godot.call("draw", arguments, &error).type, kGDNil);
  EXPECT_EQ(error.error, kGDInvalidArgument);
  EXPECT_EQ(error.argument, 1);
  EXPECT_EQ(godot.call("draw", {}, &error).type, kGDNil);
  EXPECT_EQ(error.error, kGDTooFewArguments);
  EXPECT_EQ(godot.call("close_scene", arguments, &error).type, kGDNil);
  EXPECT_EQ(error.error, kGDTooManyArguments);
  GodotVariant message = godot.call("last_error", {}, &error);
  ASSERT_EQ(message.type, kGDString);
  EXPECT_EQ(GodotText::at(message.value), "");
  message.destroy();
  drawn.destroy();
  for (GodotVariant& each : arguments) each.destroy();
}

TEST(GodotExtension, AnOlderGodotIsTold) {
  GodotHabits habits;
  habits.lacks = "classdb_register_extension_class3";
  const ImitatedGodot godot(habits);
  EXPECT_FALSE(godot.initialized());
}

TEST(GodotGuide, ScriptsCallWhatTheClassHasAndTheFileNamesTheEntry) {
  const ImitatedGodot godot;
  const std::string folder = VOYAGER_SOURCE_DIR "/samples/godot_extension/addon/";
  const std::string script = file_bytes(folder + "voyager_effect.gd");
  const std::regex call(R"(_splats\.(\w+)\()");
  int calls = 0;
  for (std::sregex_iterator found(script.begin(), script.end(), call), end; found != end; ++found) {
    ++calls;
    EXPECT_TRUE(godot.has_method((*found)[1])) << (*found)[1];
  }
  EXPECT_GE(calls, 3);
  const std::string description = file_bytes(folder + "voyager.gdextension");
  EXPECT_NE(description.find("\"voyager_godot_init\""), std::string::npos);
  EXPECT_NE(description.find("/" VOYAGER_SONAME "\""), std::string::npos)
      << "exported projects need " VOYAGER_SONAME;
}

}  // namespace
}  // namespace godot_splats_test
}  // namespace voyager::test
