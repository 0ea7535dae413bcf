// METHOD §6: what a limit on depth leaves of a frame.
#include <algorithm>

#include "runtime/math/sort_key.h"
#include "tests/support/depth_limits.h"

namespace voyager::depth_limit_test {
namespace {

using test::expect_same_bits;
using test::Frame;
using test::frame_input;
using test::limited;
using test::LimitImage;
using test::look;
using test::random_limits;
using test::render;

std::vector<FrameInput> frames() {
  Camera headset = look({-12, 3, -9}, {0, 0, 0}, 61, 90);
  headset.cx = 12, headset.cy = 71;
  return {frame_input(look({3, -6, -24}, {0, 0, 0}, 133, 77), 3),
          frame_input(look({3, -6, -24}, {0, 0, 0}, 133, 77), 12),
          frame_input(look({1, 1, 1}, {5, 2, 9}, 64, 70, 110), 6), frame_input(headset, 8)};
}

struct Drawer {
  std::string name;
  std::shared_ptr<Backend> backend;
  PipelineDesc desc;

  Frame draw(const std::shared_ptr<const Scene>& scene, const FrameInput& input) const {
    return render(*backend, scene, desc, input);
  }
};

// Every backend, exponential and filter of the host.
std::vector<Drawer> drawers() {
  const std::shared_ptr<Backend> cpu = create_cpu_backend(), reference = create_reference_backend();
  std::vector<Drawer> all{{"reference", reference, {}}};
  for (const bool filter : {true, false})
    for (const Exponential e : {Exponential::exact, Exponential::ex2, Exponential::lut})
      all.push_back({"CPU, exponential " + std::to_string(static_cast<int>(e)) + ", filter " +
                         std::to_string(filter),
                     cpu,
                     {.alpha_filter = filter, .exponential = e}});
  return all;
}

TEST(DepthLimit, InfinityAndNanAreNone) {
  const auto scene = test::baked_scene(test::random_cloud(2000, 1, 1));
  for (const Drawer& drawer : drawers())
    for (FrameInput input : frames())
      for (const float none : {INFINITY, NAN}) {
        SCOPED_TRACE(drawer.name);
        const LimitImage limits(input.eyes[0].camera, none);
        expect_same_bits(drawer.draw(scene, input), drawer.draw(scene, limited(input, limits)));
        input.eyes[0].depth_wanted = false;
        expect_same_bits(drawer.draw(scene, input), drawer.draw(scene, limited(input, limits)));
      }
}

TEST(DepthLimit, BeforeEverySplatLeavesTheBackground) {
  const auto scene = test::baked_scene(test::random_cloud(2000, 2, 1));
  for (const Drawer& drawer : drawers())
    for (FrameInput input : frames())
      for (const float z : {1e-45f, 0.0f, -3.0f, -INFINITY, 0.2f}) {
        SCOPED_TRACE(drawer.name + " " + std::to_string(z));
        input.background = {0.25f, 0.5f, 2};
        const LimitImage limits(input.eyes[0].camera, z);
        const Frame frame = drawer.draw(scene, limited(input, limits));
        for (size_t i = 0; i < frame.depth.size(); ++i) {
          ASSERT_EQ(frame.rgba[4 * i], 0.25f);
          ASSERT_EQ(frame.rgba[4 * i + 2], 2.0f);
          ASSERT_EQ(frame.rgba[4 * i + 3], 0.0f);
          ASSERT_EQ(frame.depth[i], INFINITY);
        }
      }
}

// A pixel's splats are the first of those it has without a limit: T is no less, and the
// median depth is the same or not reached.
TEST(DepthLimit, EndsPixelsAndChangesNothingBefore) {
  const auto scene = test::baked_scene(test::random_cloud(3000, 3, 2));
  uint32_t seed = 0;
  for (const Drawer& drawer : drawers()) {
    size_t shorter = 0, kept = 0, cut = 0;
    for (const FrameInput& input : frames()) {
      SCOPED_TRACE(drawer.name);
      const Frame whole = drawer.draw(scene, input);
      LimitImage limits = random_limits(input, whole, ++seed);
      const Frame frame = drawer.draw(scene, limited(input, limits));
      test::expect_no_nan(frame);
      for (size_t i = 0; i < whole.depth.size(); ++i) {
        ASSERT_LE(frame.rgba[4 * i + 3], whole.rgba[4 * i + 3]);
        shorter += frame.rgba[4 * i + 3] < whole.rgba[4 * i + 3];
        const float limit = limits.at(i % frame.width, i / frame.width);
        const bool reached = std::isnan(limit) || whole.depth[i] <= limit;
        ASSERT_EQ(frame.depth[i], reached ? whole.depth[i] : INFINITY) << limit;
        (reached ? kept : cut) += whole.depth[i] < INFINITY;
      }
    }
    EXPECT_GT(shorter, 1000u);
    EXPECT_GT(std::min(kept, cut), 500u);
  }
}

TEST(DepthLimit, TheAlphaFilterAndThreadsChangeNoBit) {
  const auto scene = test::baked_scene(test::random_cloud(3000, 4, 1));
  const auto cpu = create_cpu_backend();
  for (const Exponential e : {Exponential::exact, Exponential::ex2, Exponential::lut})
    for (const FrameInput& input : frames()) {
      const LimitImage limits = random_limits(input, render(*cpu, scene, {}, input), 5);
      const FrameInput with = limited(input, limits);
      const Frame on = render(*cpu, scene, {.exponential = e}, with, 1);
      expect_same_bits(on, render(*cpu, scene, {.alpha_filter = false, .exponential = e}, with));
      FrameInput without_depth = with;
      without_depth.eyes[0].depth_wanted = false;
      EXPECT_EQ(test::different_bits(on.rgba,
                                     render(*cpu, scene, {.exponential = e}, without_depth).rgba),
                0u);
    }
}

// A view keeps nothing of one frame's limits.
TEST(DepthLimit, IsOfOneFrame) {
  const auto scene = test::baked_scene(test::random_cloud(2000, 5, 1));
  for (const Drawer& drawer : drawers()) {
    Workers workers;
    View view(scene, *drawer.backend, drawer.desc, std::pmr::get_default_resource(), workers);
    for (const FrameInput& input : frames()) {
      const Frame before = render(view, input);
      const LimitImage limits(input.eyes[0].camera, 8);
      EXPECT_GT(test::different_bits(before.rgba, render(view, limited(input, limits)).rgba), 0u);
      expect_same_bits(before, render(view, input));
    }
  }
}

float key_of(const Scene& scene, size_t i, const Camera& camera) {
  const Vec3d& axis = camera.world_to_view.row[2];
  return view_depth(
      camera_relative(scene.gaussians[i].mean, scene.origin, camera.eye),
      {static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z)});
}

// The flat scene of those Gaussians of a cloud whose z is at most `limit`, or of the others.
std::shared_ptr<Scene> part_of(const GaussianCloud& cloud, const Camera& camera, float limit,
                               bool before) {
  const auto whole = test::flat_scene(cloud);
  auto part = test::empty_scene();
  part->sh_degree = whole->sh_degree;
  part->native = whole->native;
  const size_t words = whole->sh.size() / whole->gaussians.size();
  for (size_t i = 0; i < whole->gaussians.size(); ++i) {
    if ((key_of(*whole, i, camera) <= limit) != before) continue;
    part->gaussians.push_back(whole->gaussians[i]);
    const auto sh = whole->sh.begin() + static_cast<ptrdiff_t>(i * words);
    part->sh.insert(part->sh.end(), sh, sh + static_cast<ptrdiff_t>(words));
    ++part->leaf_count;
  }
  return part;
}

// The depth of a splat in the midst of the frame's.
float middle_key(const GaussianCloud& cloud, const Camera& camera) {
  const auto scene = test::flat_scene(cloud);
  std::vector<float> keys;
  for (size_t i = 0; i < cloud.size(); ++i)
    if (const float z = key_of(*scene, i, camera); z > 0.2f) keys.push_back(z);
  const auto middle = keys.begin() + static_cast<ptrdiff_t>(keys.size() / 2);
  std::nth_element(keys.begin(), middle, keys.end());
  return *middle;
}

// z <= limit is blended, z > limit is not.
TEST(DepthLimit, APlaneHidesTheSplatsBehindIt) {
  const GaussianCloud cloud = test::random_cloud(3000, 6, 1);
  const auto scene = test::flat_scene(cloud);
  for (const Drawer& drawer : drawers())
    for (const FrameInput& input : frames()) {
      const float key = middle_key(cloud, input.eyes[0].camera);
      for (const float z : {key, std::nextafter(key, 0.0f), std::nextafter(key, INFINITY)}) {
        SCOPED_TRACE(drawer.name);
        const LimitImage limits(input.eyes[0].camera, z);
        expect_same_bits(drawer.draw(scene, limited(input, limits)),
                         drawer.draw(part_of(cloud, input.eyes[0].camera, z, true), input));
      }
    }
}

// As a host composites: what lies before the plane, over what lies behind.
TEST(DepthLimit, WhatLiesBeforeOverWhatLiesBehindIsTheWhole) {
  const GaussianCloud cloud = test::random_cloud(3000, 7, 1);
  const auto scene = test::flat_scene(cloud);
  for (const Drawer& drawer : drawers()) {
    if (drawer.desc.exponential == Exponential::lut) continue;  // α as elsewhere
    for (const FrameInput& input : frames()) {
      SCOPED_TRACE(drawer.name);
      const float z = middle_key(cloud, input.eyes[0].camera);
      const LimitImage limits(input.eyes[0].camera, z);
      const Frame whole = drawer.draw(scene, input),
                  before = drawer.draw(scene, limited(input, limits)),
                  behind = drawer.draw(part_of(cloud, input.eyes[0].camera, z, false), input);
      for (size_t i = 0; i < whole.rgba.size(); ++i) {
        const float left = 1 - before.rgba[i / 4 * 4 + 3];
        // A pixel ends where a splat, with at most 0.99, would bring T below 1e-4.
        const bool open = whole.rgba[i / 4 * 4 + 3] < 0.99f;
        ASSERT_NEAR(whole.rgba[i], before.rgba[i] + left * behind.rgba[i], open ? 1e-5 : 0.05);
      }
    }
  }
}

}  // namespace
}  // namespace voyager::depth_limit_test
