#pragma once
// A small city and cameras of several sizes for samples/vulkan_host, and what it wrote.
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/command_line/program.h"
#include "tests/support/needs_vulkan.h"
#include "tests/support/test_support.h"

namespace voyager::test {

struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<float> values;  // PNG: code values, 0 to 255

  size_t channels() const { return values.size() / (size_t{width} * height); }
};

inline Picture read_png(const std::string& path) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << path << image.message;
  image.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> bytes(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr), 0) << image.message;
  picture.width = image.width;
  picture.height = image.height;
  picture.values.assign(bytes.begin(), bytes.end());
  return picture;
}

// Rows from the top.
inline Picture read_pfm(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic;
  Picture picture;
  float scale = 0;
  file >> magic >> picture.width >> picture.height >> scale;
  file.get();
  EXPECT_LT(scale, 0) << path;
  const size_t row = size_t{picture.width} * (magic == "PF" ? 3 : 1);
  picture.values.resize(row * picture.height);
  for (uint32_t y = picture.height; y-- > 0;)
    file.read(reinterpret_cast<char*>(&picture.values[row * y]),
              static_cast<std::streamsize>(row * sizeof(float)));
  EXPECT_TRUE(file.good()) << path;
  return picture;
}

inline float largest_difference(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height) return INFINITY;
  float most = 0;
  for (size_t i = 0; i < a.values.size(); ++i)
    most = std::max(most, std::abs(a.values[i] - b.values[i]));
  return most;
}

class VulkanHost : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    set_up_failure_ =
        failure_of({"voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("city.ply"),
                    "voyager bake " + file("city.ply") + " -o " + file("city.voy")});
    if (set_up_failure_.empty()) write_cameras();
  }
  static void TearDownTestSuite() { delete folder_; }

  void SetUp() override {
    ASSERT_EQ(set_up_failure_, "");
    const Outcome result = run(host("--frames 1 -o " + file("probe")));
    if (result.exit_code == 4 && result.output.find("found no Vulkan") != std::string::npos)
      VOYAGER_SKIP_WITHOUT_VULKAN(result.output);
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }

  static std::string file(const std::string& name) { return folder_->file(name); }
  static std::string host(const std::string& rest, const std::string& cameras = "cameras.json") {
    return "vulkan_host " + file("city.voy") + " --offscreen --camera-file " + file(cameras) + " " +
           rest;
  }
  static void expect_success(const std::string& command) {
    const Outcome result = run(command);
    EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.output;
  }

  static std::string numbered(const std::string& name, int number, const char* extension) {
    char text[16];
    std::snprintf(text, sizeof text, "/%04d.%s", number, extension);
    return file(name) + text;
  }

  static constexpr int kCameras = 6;
  static TempFolder* folder_;

 private:
  static std::string set_up_failure_;

  // Out of the walk and the flight. cameras.json: no two after one another of one size, odd ones
  // among them, so that each frame is of a new target. steady.json: all of one size, so that
  // frames are in flight together.
  static void write_cameras() {
    constexpr uint32_t kSizes[][2] = {{96, 54}, {61, 47}, {1, 1}, {128, 40}, {33, 97}, {80, 64}};
    std::ifstream source(file("city.cameras.json"));
    const nlohmann::json all = nlohmann::json::parse(source);
    nlohmann::json changing = nlohmann::json::array(), steady = changing;
    for (size_t i = 0; i < kCameras; ++i) {
      const nlohmann::json& camera = all[i * (all.size() - 1) / (kCameras - 1)];
      changing.push_back(resized(camera, kSizes[i]));
      steady.push_back(resized(camera, kSizes[0]));
    }
    std::ofstream(file("cameras.json")) << changing;
    std::ofstream(file("steady.json")) << steady;
  }
  static nlohmann::json resized(nlohmann::json camera, const uint32_t (&size)[2]) {
    const double scale = size[0] / camera["width"].get<double>();
    for (const char* focal : {"fx", "fy"}) camera[focal] = camera[focal].get<double>() * scale;
    camera["width"] = size[0];
    camera["height"] = size[1];
    return camera;
  }
};
inline TempFolder* VulkanHost::folder_ = nullptr;
inline std::string VulkanHost::set_up_failure_;

}  // namespace voyager::test
