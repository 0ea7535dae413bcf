#pragma once
// Scenes in memory, cameras, and frames as float buffers.
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include "runtime/cpu/cpu_backend.h"
#include "runtime/format/writer.h"
#include "runtime/frame/view.h"
#include "runtime/lod/build.h"
#include "runtime/reference/reference_backend.h"
#include "runtime/scene/scale_histogram.h"
#include "tests/support/test_support.h"

namespace voyager::test {

// A flat scene, with the footprint that load_scene() would give it; its Gaussians may be changed
// before it is drawn.
inline std::shared_ptr<Scene> flat_scene(const GaussianCloud& cloud) {
  auto scene = std::make_shared<Scene>(std::pmr::get_default_resource());
  scene->name = "flat";
  scene->sh_degree = cloud.sh_degree;
  scene->leaf_count = cloud.size();
  scene->native = known_scale(cloud);
  scene->origin = {cloud.origin[0], cloud.origin[1], cloud.origin[2]};
  for (size_t i = 0; i < cloud.size(); ++i)
    scene->gaussians.push_back(activate(cloud.words(i), true));
  scene->sh.assign(cloud.sh.begin(), cloud.sh.end());
  return scene;
}

// Through a file and load_scene().
inline std::shared_ptr<const Scene> loaded(const BakedScene& baked,
                                           Quality quality = Quality::lossless) {
  Workers workers;
  const TempFolder folder;
  write_scene_file(baked, partition_tree(baked.tree, kDefaultChunkBytes), folder.file("scene.voy"),
                   quality, workers);
  return load_scene(open_file_source(folder.file("scene.voy")), std::pmr::get_default_resource(),
                    workers);
}

// Through build_tree(), too.
inline std::shared_ptr<const Scene> baked_scene(const GaussianCloud& cloud,
                                                Quality quality = Quality::lossless,
                                                const TreeRule& rule = {}) {
  Workers workers;
  return loaded(build_tree(cloud, workers, {}, rule), quality);
}

// One grey Gaussian with SH degree 0, for scenes made by hand.
inline void add_gaussian(Scene& scene, const Vec3f& mean, const Vec3f& scale, float opacity,
                         const Vec3f& colour = {0.5f, 0.5f, 0.5f}, const Quatf& q = {1, 0, 0, 0}) {
  scene.gaussians.push_back({mean, opacity, scale, std::log(opacity), normalise(q)});
  for (int channel = 0; channel < 3; ++channel)
    scene.sh.push_back((colour[channel] - 0.5f) / static_cast<float>(kSh0));
  ++scene.leaf_count;
}

inline std::shared_ptr<Scene> empty_scene() {
  return flat_scene(GaussianCloud());
}

// Looks from `eye` to `target` with world y down, the principal point in the middle.
inline Camera look(const Vec3d& eye, const Vec3d& target, uint32_t width, uint32_t height,
                   double fov_x_degrees = 60) {
  const auto unit = [](const Vec3d& v) { return (1 / std::sqrt(dot(v, v))) * v; };
  const auto cross = [](const Vec3d& a, const Vec3d& b) {
    return Vec3d{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const Vec3d forward = unit(target - eye);
  const Vec3d down = std::fabs(forward.y) > 0.99 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  const Vec3d right = unit(cross(down, forward));
  Camera camera;
  camera.eye = eye;
  camera.world_to_view = {{right, cross(forward, right), forward}};
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 0.5 * width / std::tan(fov_x_degrees * 3.14159265358979323846 / 360);
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  return camera;
}

struct Frame {
  uint32_t width = 0, height = 0;
  std::vector<float> rgba, depth;
  FrameStats stats;
  std::vector<uint32_t> cut;

  const float* at(size_t x, size_t y) const { return &rgba[4 * (y * width + x)]; }
};

inline Frame render(View& view, const FrameInput& input) {
  Frame frame;
  frame.width = input.eyes[0].camera.width;
  frame.height = input.eyes[0].camera.height;
  const size_t pixels = size_t{frame.width} * frame.height;
  frame.rgba.assign(4 * pixels, NAN);  // what is left unwritten shows
  if (input.eyes[0].depth_wanted) frame.depth.assign(pixels, NAN);
  Image image;
  image.format = ColorFormat::rgba32f;
  image.width = frame.width;
  image.height = frame.height;
  image.color = frame.rgba.data();
  image.color_pitch = size_t{16} * frame.width;
  image.depth = input.eyes[0].depth_wanted ? frame.depth.data() : nullptr;
  image.depth_pitch = size_t{4} * frame.width;
  view.render(input, image);
  frame.stats = view.stats();
  if (view.instances() > 0) frame.cut.assign(view.cut().begin(), view.cut().end());
  return frame;
}

inline Frame render(Backend& backend, std::shared_ptr<const Scene> scene, const PipelineDesc& desc,
                    const FrameInput& input, unsigned threads = 0) {
  Workers workers(threads);
  View view(std::move(scene), backend, desc, std::pmr::get_default_resource(), workers);
  return render(view, input);
}

inline FrameInput frame_input(const Camera& camera, double tau = 3, bool depth = true) {
  FrameInput input;
  input.eyes[0].camera = camera;
  input.tau = tau;
  input.eyes[0].depth_wanted = depth;
  return input;
}

// Values whose bits differ.
inline size_t different_bits(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return SIZE_MAX;
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i)
    count += std::bit_cast<uint32_t>(a[i]) != std::bit_cast<uint32_t>(b[i]);
  return count;
}

inline void expect_same_bits(const Frame& a, const Frame& b) {
  EXPECT_EQ(different_bits(a.rgba, b.rgba), 0u) << "colour";
  EXPECT_EQ(different_bits(a.depth, b.depth), 0u) << "depth";
}

inline void expect_no_nan(const Frame& frame) {
  size_t bad = 0;
  for (const float v : frame.rgba) bad += std::isnan(v);
  for (const float v : frame.depth) bad += std::isnan(v);
  EXPECT_EQ(bad, 0u);
}

// What differs between two frames. `rough` counts pixels with a channel beyond
// `limit`: those where a threshold fell to the other side.
struct Difference {
  double psnr = INFINITY;  // dB against 1.0, colour and coverage
  double largest = 0;
  size_t rough = 0;
  double largest_smooth = 0;  // of the other pixels
};

inline Difference compare(const Frame& a, const Frame& b, double limit = 2.0 / 255) {
  Difference d;
  double squares = 0;
  for (size_t pixel = 0; pixel < a.rgba.size() / 4; ++pixel) {
    double most = 0;
    for (size_t k = 4 * pixel; k < 4 * pixel + 4; ++k) {
      const double e = std::fabs(double{a.rgba[k]} - double{b.rgba[k]});
      squares += e * e;
      most = std::fmax(most, e);
    }
    d.largest = std::fmax(d.largest, most);
    if (most > limit)
      ++d.rough;
    else
      d.largest_smooth = std::fmax(d.largest_smooth, most);
  }
  if (squares > 0) d.psnr = 10 * std::log10(static_cast<double>(a.rgba.size()) / squares);
  return d;
}

}  // namespace voyager::test
