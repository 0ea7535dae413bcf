#pragma once
// A host whose views draw as many scenes as they are told.
#include <voyager/voyager_experiment.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "hostile.h"

// The first `first` Gaussians of a .ply of ply_bytes(), or those behind them.
inline std::string part_of(const std::string& ply, size_t count, size_t first, bool behind) {
  const size_t body = ply.find("end_header\n") + 11, each = (ply.size() - body) / count;
  std::string head = ply.substr(0, body);
  const std::string all = "vertex " + std::to_string(count);
  head.replace(head.find(all), all.size(),
               "vertex " + std::to_string(behind ? count - first : first));
  return head + (behind ? ply.substr(body + first * each) : ply.substr(body, first * each));
}

struct Picture {
  std::vector<float> pixels, depth;
  bool operator==(const Picture& other) const {
    return pixels == other.pixels && depth == other.depth;
  }
};

inline double largest_difference(const Picture& a, const Picture& b) {
  double largest = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max(largest, std::fabs(double{a.pixels[i]} - double{b.pixels[i]}));
  return largest;
}

inline double psnr(const Picture& a, const Picture& b) {
  double squares = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    squares += std::pow(double{a.pixels[i]} - double{b.pixels[i]}, 2);
  return squares == 0 ? kInf : 10 * std::log10(static_cast<double>(a.pixels.size()) / squares);
}

inline VoyInstancePose pose_of(double x, double y, double z, double degrees = 0, double scale = 1) {
  VoyInstancePose instance = VOY_INSTANCE_POSE_INIT;
  const double half = degrees * 3.14159265358979323846 / 360;
  const double axis[3] = {0.36, -0.48, 0.8};
  for (int i = 0; i < 3; ++i) instance.pose.orientation[i] = axis[i] * std::sin(half);
  instance.pose.orientation[3] = std::cos(half);
  instance.pose.position[0] = x, instance.pose.position[1] = y, instance.pose.position[2] = z;
  instance.scale = scale;
  return instance;
}

struct Stage : Host {
  Stage(const Library& library, VoyBackend wanted)
      : Host(library, device_for(wanted), kGaussians) {}

  VoyScene open(const std::string& ply) {
    sources.push_back(std::make_unique<BytesHost>());
    sources.back()->bytes = ply;
    const VoyByteSource source = sources.back()->source();
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.source = &source;
    VoyScene opened = nullptr;
    EXPECT_EQ(voy.OpenScene(device, &desc, &opened), VOY_SUCCESS) << voy.message();
    return opened;
  }
  VoyView view_of(const std::vector<VoyScene>& scenes) {
    VoyViewDesc desc = view_desc();
    VoyExperiment experiment = VOY_EXPERIMENT_INIT;
    experiment.exponential = VOY_EXPONENTIAL_EXACT;
    desc.next = &experiment;
    desc.antialias = VOY_ANTIALIAS_OFF;  // halves estimate native pixels of their own
    desc.instanceCount = static_cast<uint32_t>(scenes.size());
    desc.scenes = scenes.data();
    VoyView made = nullptr;
    EXPECT_EQ(voy.CreateView(device, &desc, &made), VOY_SUCCESS) << voy.message();
    return made;
  }
  Picture draw(VoyView drawn, const VoyFrameEye& from, std::span<const VoyInstancePose> poses = {},
               double near = 0.2) {
    VoyFrame wanted = frame(from);
    wanted.instanceCount = static_cast<uint32_t>(poses.size());
    wanted.instances = poses.empty() ? nullptr : poses.data();
    wanted.nearZ = near;
    EXPECT_EQ(voy.RenderFrame(drawn, &wanted), VOY_SUCCESS) << voy.message();
    return {pixels, depth};
  }
  std::string whole() const { return bytes.bytes; }
  std::string part(size_t first, bool behind) const {
    return part_of(bytes.bytes, kGaussians, first, behind);
  }

  static constexpr int kGaussians = 2000;
  std::vector<std::unique_ptr<BytesHost>> sources;
};
