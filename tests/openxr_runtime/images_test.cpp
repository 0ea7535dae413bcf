// What was shown comes back as files: pixels, depth, and the poses that it was shown with.
#include <png.h>

#include <cmath>
#include <filesystem>

#include "tests/openxr_runtime/client.h"

namespace test_runtime::test {
namespace images_test {
namespace {

struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

Picture read_png(const std::string& path) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << path;
  image.format = PNG_FORMAT_RGB;
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr), 0) << path;
  picture.width = image.width;
  picture.height = image.height;
  return picture;
}

void expect_colour(const Picture& picture, int r, int g, int b) {
  for (size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    ASSERT_EQ(picture.rgb[i], r) << i;
    ASSERT_EQ(picture.rgb[i + 1], g) << i;
    ASSERT_EQ(picture.rgb[i + 2], b) << i;
  }
}

std::vector<float> read_pfm(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic;
  size_t width = 0, height = 0;
  float scale = 0;
  file >> magic >> width >> height >> scale;
  file.get();
  EXPECT_EQ(magic, "Pf");
  std::vector<float> values(width * height);
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(float)));
  EXPECT_TRUE(file.good()) << path;
  return values;
}

// Cameras that turn, move and look off-centre, in a scene whose y points down.
Json headset_cameras(int pairs) {
  Json cameras = Json::array();
  for (int i = 0; i < 2 * pairs; ++i) {
    const double a = 0.1 * i, c = std::cos(a), s = std::sin(a);
    cameras.push_back({{"id", i},
                       {"img_name", "camera"},
                       {"width", 200},
                       {"height", 120},
                       {"position", {100 + 0.1 * i, -20 + 0.03 * i, 50.0}},
                       {"rotation", {{c, 0.0, s}, {0.0, 1.0, 0.0}, {-s, 0.0, c}}},
                       {"fx", 90.0 + i},
                       {"fy", 80.0 + i},
                       {"cx", i % 2 ? 70.0 : 130.0},
                       {"cy", 55.0 + i}});
  }
  return cameras;
}

TEST(Images, CodeValuesOfEachEyeAreWritten) {
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  for (int i = 0; i < 5; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  for (const char* number : {"0000", "0001"}) {
    const Picture left = read_png(stage.file("shown/" + std::string(number) + "_L.png"));
    EXPECT_EQ(left.width, Client::kWidth);
    EXPECT_EQ(left.height, Client::kHeight);
    expect_colour(left, 51, 102, 153);
    expect_colour(read_png(stage.file("shown/" + std::string(number) + "_R.png")), 255, 0, 204);
  }
  EXPECT_FALSE(std::filesystem::exists(stage.file("shown/0002_L.png")));
}

// Linear 0.2 is code 124 of sRGB, as the image holds it.
TEST(Images, SrgbIsNotDecodedAndHalfFloatsAreEncoded) {
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT}) {
    const Stage stage(Json::object());
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    client.colour = client.create_swapchain(format, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT);
    client.paint[0] = {{0.2f, 0, 1, 1}};
    for (int i = 0; i < 4; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    expect_colour(read_png(stage.file("shown/0000_L.png")), 124, 0, 255);
  }
}

TEST(Images, BlueFirstFormatsComeOutRight) {
  const Stage stage(Json{{"formats", {"D32_SFLOAT", "B8G8R8A8_UNORM", "R8G8B8A8_UNORM"}}});
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  int64_t formats[3] = {};
  uint32_t count = 0;
  EXPECT_EQ(xrEnumerateSwapchainFormats(client.session, 3, &count, formats), XR_SUCCESS);
  EXPECT_EQ(formats[0], VK_FORMAT_D32_SFLOAT);
  EXPECT_EQ(formats[1], VK_FORMAT_B8G8R8A8_UNORM);
  client.colour =
      client.create_swapchain(VK_FORMAT_B8G8R8A8_UNORM, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT);
  for (int i = 0; i < 4; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  expect_colour(read_png(stage.file("shown/0000_L.png")), 51, 102, 153);
}

// Depth one half: near 0.1 m at 0 and infinity at 1 put it at 0.2 m; turned round, likewise.
TEST(Images, DepthIsInMetres) {
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  for (int i = 0; i < 4; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  ASSERT_EQ(client.wait(), XR_SUCCESS);
  ASSERT_EQ(client.begin(), XR_SUCCESS);
  client.draw();
  client.make_layer();
  std::swap(client.depth_info[0].nearZ, client.depth_info[0].farZ);
  client.depth_info[1].nearZ = 1;
  client.depth_info[1].farZ = 3;
  ASSERT_EQ(client.end(true), XR_SUCCESS);
  for (const char* name : {"shown/0000_L.pfm", "shown/0001_L.pfm"})
    for (const float z : read_pfm(stage.file(name))) ASSERT_NEAR(z, 0.2f, 1e-6f) << name;
  for (const float z : read_pfm(stage.file("shown/0001_R.pfm"))) ASSERT_NEAR(z, 1.5f, 1e-6f);
}

TEST(Images, ARectangleIsCutOut) {
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  for (int i = 0; i < 3; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  ASSERT_EQ(client.wait(), XR_SUCCESS);
  ASSERT_EQ(client.begin(), XR_SUCCESS);
  ASSERT_EQ(client.locate(), XR_SUCCESS);
  client.draw();
  client.make_layer();
  client.layer_views[0].subImage.imageRect = {{3, 2}, {7, 5}};
  ASSERT_EQ(client.end(true), XR_SUCCESS);
  const Picture left = read_png(stage.file("shown/0000_L.png"));
  EXPECT_EQ(left.width, 7u);
  EXPECT_EQ(left.height, 5u);
  expect_colour(left, 51, 102, 153);
}

// An application that shows what it was told to gets the motion's own cameras back.
TEST(Images, CamerasRepeatTheMotion) {
  const Json motion = headset_cameras(3);
  const Stage stage(Json{{"motion", "motion.json"}});
  std::ofstream(stage.file("motion.json")) << motion;
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    for (int i = 0; i < 8; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  }
  const Json shown = stage.read("shown/cameras.json");
  ASSERT_EQ(shown.size(), 10u);  // frames 3 to 7, and the motion has three pairs
  for (size_t i = 0; i < shown.size(); ++i) {
    const Json& a = shown[i];
    const Json& b = motion[i % motion.size()];
    EXPECT_EQ(a["width"], Client::kWidth);
    const double x = double{Client::kWidth} / 200, y = double{Client::kHeight} / 120;
    EXPECT_NEAR(a["fx"], b["fx"].get<double>() * x, 1e-5);
    EXPECT_NEAR(a["fy"], b["fy"].get<double>() * y, 1e-5);
    EXPECT_NEAR(a["cx"], b["cx"].get<double>() * x, 1e-5);
    EXPECT_NEAR(a["cy"], b["cy"].get<double>() * y, 1e-5);
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(a["position"][k], b["position"][k].get<double>(), 1e-6);
      for (size_t j = 0; j < 3; ++j)
        EXPECT_NEAR(a["rotation"][k][j], b["rotation"][k][j].get<double>(), 1e-6);
    }
  }
}

TEST(Images, IndicesComeInTheOrderThatTheScriptSays) {
  for (const char* order : {"ascending", "descending", "shuffled"}) {
    const Stage stage(Json{
        {"image_order", order}, {"images", 4}, {"events", {{{"frame", 5}, {"do", "swap_image"}}}}});
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    std::vector<uint32_t> indices;
    for (int i = 0; i < 9; ++i) {
      client.wait();
      client.begin();
      uint32_t index = 99;
      ASSERT_EQ(client.acquire(client.colour, index), XR_SUCCESS);
      ASSERT_LT(index, 4u);
      if (!indices.empty()) {
        EXPECT_NE(index, indices.back()) << "the image that is displayed";
      }
      indices.push_back(index);
      client.wait_image(client.colour);
      client.release(client.colour);
      client.end(false);
    }
    if (std::string(order) == "ascending") {
      EXPECT_EQ(indices, (std::vector<uint32_t>{0, 1, 2, 3, 0, 2, 3, 0, 1}));
    }
    if (std::string(order) == "descending") {
      EXPECT_EQ(indices[0], 3u);
    }
  }
}

TEST(Images, AWaitMayTimeOutAndIsRepeated) {
  const Stage stage(Json{{"image_timeout_frames", {{1, 1}}}});
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  client.whole_frame();
  client.wait();
  client.begin();
  uint32_t index = 0;
  ASSERT_EQ(client.acquire(client.colour, index), XR_SUCCESS);
  EXPECT_EQ(client.wait_image(client.colour, 1000), XR_TIMEOUT_EXPIRED);
  EXPECT_EQ(client.wait_image(client.colour, 1000), XR_SUCCESS);
  EXPECT_EQ(client.release(client.colour), XR_SUCCESS);
}

}  // namespace
}  // namespace images_test
}  // namespace test_runtime::test
