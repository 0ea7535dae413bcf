#pragma once
// A small city and cameras of several sizes for samples/vulkan_host, and what it wrote.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/command_line/program.h"
#include "tests/support/needs.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"

namespace voyager::test {

class VulkanHost : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    set_up_failure_ =
        failure_of({"voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("city.ply"),
                    "voyager bake " + file("city.ply") + " -o " + file("city.voy")});
    if (!set_up_failure_.empty()) return;
    write_cameras();
    probe_ = run(host("--frames 1 -o " + file("probe")));
  }
  static void TearDownTestSuite() { delete folder_; }

  void SetUp() override {
    ASSERT_EQ(set_up_failure_, "");
    if (probe_.exit_code == 4 && probe_.output.find("found no Vulkan") != std::string::npos)
      VOYAGER_SKIP_WITHOUT(VULKAN, probe_.output);
    ASSERT_EQ(probe_.exit_code, 0) << probe_.output;
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
  static inline std::string set_up_failure_;
  static inline Outcome probe_;

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

}  // namespace voyager::test
