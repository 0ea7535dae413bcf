// What an image must not depend on: the α-filter, threads,
// earlier frames, the way the scene was stored.
#include <algorithm>

#include "runtime/frame/draw_list.h"
#include "runtime/frame/whole_tree.h"
#include "tests/support/render_scene.h"
#include "tests/support/tree_rules.h"

namespace voyager::image_test {
namespace {

using test::expect_same_bits;
using test::Frame;
using test::frame_input;
using test::look;
using test::render;

struct NamedDesc {
  const char* name;
  PipelineDesc desc;
};

std::vector<NamedDesc> exponentials() {
  std::vector<NamedDesc> all;
  all.push_back({"exact", {}});
  all.push_back({"ex2", {.exponential = Exponential::ex2}});
  for (const uint32_t m : {1u, 8u, 32u, 128u})
    all.push_back({"lut", {.exponential = Exponential::lut, .lut_size = m}});
  return all;
}

// Frames with interpolated nodes, with none, from inside and outside.
std::vector<FrameInput> frames() {
  std::vector<FrameInput> all;
  for (const double tau : {0.0, 3.0, 12.0, 40.0})
    all.push_back(frame_input(look({3, -6, -24}, {0, 0, 0}, 133, 77), tau));
  all.push_back(frame_input(look({1, 1, 1}, {5, 2, 9}, 64, 70, 110), 6));
  Camera headset = look({-12, 3, -9}, {0, 0, 0}, 61, 90);
  headset.cx = 12, headset.cy = 71;
  all.push_back(frame_input(headset, 8));
  return all;
}

size_t count_interpolated(const Scene& scene, const FrameInput& input) {
  Workers workers(1);
  size_t count = 0;
  const float target = target_size(input.tau, input.eyes[0].camera.fx);
  const Vec3f c = cut_centre(input.eyes[0].camera.eye, scene.origin);
  const auto whole = whole_tree(scene);
  ExhaustiveSearch search;
  search.run(*whole, {}, {c, target}, workers);
  for (const uint32_t n : search.cut()) {
    const uint32_t parent = whole->parent[n];
    if (parent != kNoNode)
      count += interpolation_weight(true, whole->screen_size(parent, c), whole->screen_size(n, c),
                                    target, whole->blend_share) < 1;
  }
  return count;
}

TEST(Image, TheAlphaFilterChangesNoBit) {
  const auto scene = test::baked_scene(test::random_cloud(3000, 5, 2), Quality::lossless,
                                       test::kHierarchicalGs);  // which blends most
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  size_t interpolated = 0;
  for (const FrameInput& input : frames()) {
    interpolated += count_interpolated(*scene, input);
    for (NamedDesc named : exponentials()) {
      SCOPED_TRACE(std::string(named.name) + " m = " + std::to_string(named.desc.lut_size) +
                   " tau = " + std::to_string(input.tau));
      named.desc.alpha_filter = true;
      const Frame on = render(*cpu, scene, named.desc, input);
      named.desc.alpha_filter = false;
      const Frame off = render(*cpu, scene, named.desc, input);
      expect_same_bits(on, off);
      test::expect_no_nan(on);
      EXPECT_LE(on.stats.pairs_after, off.stats.pairs_after);
      EXPECT_EQ(on.cut, off.cut);
    }
    expect_same_bits(render(*reference, scene, {}, input),
                     render(*reference, scene, {.alpha_filter = false}, input));
  }
  EXPECT_GT(interpolated, 500u);  // or the test would not see sibling correction
}

TEST(Image, DoesNotDependOnThreadsOrEarlierFrames) {
  const auto scene = test::baked_scene(test::random_cloud(20000, 6, 1));
  const auto backends = {create_cpu_backend().release(), create_reference_backend().release()};
  for (Backend* raw : backends) {
    const std::unique_ptr<Backend> backend(raw);
    Workers one(1), two(2), five(5);
    View a(scene, *backend, {}, std::pmr::get_default_resource(), one);
    View b(scene, *backend, {}, std::pmr::get_default_resource(), two);
    View c(scene, *backend, {}, std::pmr::get_default_resource(), five);
    std::vector<FrameInput> walk = frames();
    walk.resize(raw->device_name().find("CPU") == 0 ? walk.size() : 2);
    for (const FrameInput& input : walk) {
      const Frame first = render(a, input);
      expect_same_bits(first, render(b, input));
      expect_same_bits(first, render(c, input));
      expect_same_bits(first, render(b, input));
    }
    // Another size in between, larger and smaller, with and without depth.
    const Frame before = render(a, walk[0]);
    render(a, frame_input(look({0, 0, -30}, {0, 0, 0}, 300, 200), 1, false));
    render(a, frame_input(look({0, 0, -3}, {0, 0, 0}, 5, 3), 9));
    expect_same_bits(before, render(a, walk[0]));
  }
}

TEST(Image, AllLeavesOfALosslessBakeAreTheFlatScene) {
  for (const uint32_t seed : {1u, 2u}) {
    const GaussianCloud cloud = test::random_cloud(4000, seed, 3);
    const auto flat = test::flat_scene(cloud);
    const auto baked = test::baked_scene(cloud);
    for (const auto& backend : {create_cpu_backend(), create_reference_backend()})
      for (size_t i : {0u, 4u, 5u})
        expect_same_bits(render(*backend, flat, {}, frames()[i]),
                         render(*backend, baked, {.lod = Lod::all_leaves}, frames()[i]));
  }
}

#if defined(__SSE2__)
// A host whose threads flush subnormals and round up. Every entry of the plugin
// holds a FloatingPointMode; what is tested here is that the workers do too.
TEST(Image, WorkersDoNotTakeOverTheHostsFloatingPointMode) {
  constexpr unsigned kHostile = 0x1f80u | 0x8040u | 0x4000u;  // FTZ, DAZ, round up
  const auto scene = test::baked_scene(test::random_cloud(6000, 8, 1));
  const auto backend = create_cpu_backend();
  const FrameInput input = frames()[2];
  const Frame expected = render(*backend, scene, {}, input);
  const unsigned saved = _mm_getcsr();
  _mm_setcsr(kHostile);
  Workers workers(4);
  for (int i = 0; i < 20; ++i)  // the workers' threads start in the host's mode
    workers.run([] { tbb::parallel_for(0, 64, [](int) { _mm_setcsr(kHostile); }); });
  Frame found;
  {
    const FloatingPointMode entry;
    found = render(*backend, scene, {}, input, 4);
    View view(scene, *backend, {}, std::pmr::get_default_resource(), workers);
    expect_same_bits(found, render(view, input));
  }
  const unsigned left = _mm_getcsr() & ~0x3fu;
  _mm_setcsr(saved);
  EXPECT_EQ(left, kHostile) << "the host's mode was not put back";
  expect_same_bits(expected, found);
  EXPECT_EQ(expected.cut, found.cut);
}
#endif

TEST(Image, PermutingTheInputPermutesOnlyTies) {
  // Equal depths: the earlier index lies in front.
  for (const bool swapped : {false, true}) {
    auto scene = test::empty_scene();
    test::add_gaussian(*scene, {0, 0, 2}, {1, 1, 1}, 0.99f,
                       swapped ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0});
    test::add_gaussian(*scene, {0, 0, 2}, {1, 1, 1}, 0.99f,
                       swapped ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0});
    for (const auto& backend : {create_cpu_backend(), create_reference_backend()}) {
      const Frame f = render(*backend, scene, {}, frame_input(look({0, 0, 0}, {0, 0, 1}, 9, 9)));
      EXPECT_GT(f.at(4, 4)[swapped ? 1 : 0], 0.9f);
      EXPECT_LT(f.at(4, 4)[swapped ? 0 : 1], 0.1f);
    }
  }
  // Distinct depths: the order of the input is nothing.
  auto scene = test::flat_scene(test::random_cloud(2000, 9, 0));
  auto turned = test::flat_scene(test::random_cloud(2000, 9, 0));
  std::reverse(turned->gaussians.begin(), turned->gaussians.end());
  for (size_t i = 0; i < 2000; ++i) std::copy_n(&scene->sh[3 * i], 3, &turned->sh[3 * (1999 - i)]);
  const auto backend = create_cpu_backend();
  expect_same_bits(render(*backend, scene, {}, frames()[0]),
                   render(*backend, turned, {}, frames()[0]));
}

TEST(Image, Rgba8RoundsToNearestAndPaddingIsLeftAlone) {
  const auto scene = test::flat_scene(test::random_cloud(2000, 10, 1));
  const auto backend = create_cpu_backend();
  FrameInput input = frames()[0];
  input.background = {0.25f, 0.5f, 2.0f};
  const Frame exact = render(*backend, scene, {}, input);
  Workers workers(2);
  View view(scene, *backend, {}, std::pmr::get_default_resource(), workers);
  const size_t pitch = 4 * exact.width + 13, depth_pitch = 4 * exact.width + 8;
  std::vector<uint8_t> codes(pitch * exact.height, 0xa5);
  std::vector<float> depth(depth_pitch / 4 * exact.height, -7.0f);
  view.render(input, {ColorFormat::rgba8, exact.width, exact.height, codes.data(), pitch,
                      depth.data(), depth_pitch});
  for (size_t y = 0; y < exact.height; ++y) {
    for (size_t i = 0; i < 4 * exact.width; ++i) {
      const double value = std::clamp(double{exact.rgba[4 * y * exact.width + i]}, 0.0, 1.0);
      ASSERT_NEAR(codes[y * pitch + i], value * 255, 0.5 + 1e-4);
    }
    for (size_t i = 4 * exact.width; i < pitch; ++i) ASSERT_EQ(codes[y * pitch + i], 0xa5);
    for (size_t x = 0; x < exact.width; ++x)
      ASSERT_EQ(depth[y * depth_pitch / 4 + x], exact.depth[y * exact.width + x]);
    for (size_t x = exact.width; x < depth_pitch / 4; ++x)
      ASSERT_EQ(depth[y * depth_pitch / 4 + x], -7.0f);
  }
}

TEST(Image, BackgroundFillsWhatIsLeft) {
  const auto scene = test::flat_scene(test::random_cloud(500, 11, 1));
  for (const auto& backend : {create_cpu_backend(), create_reference_backend()}) {
    FrameInput input = frames()[0];
    const Frame black = render(*backend, scene, {}, input);
    input.background = {0.25f, 0.5f, 1.0f};
    const Frame filled = render(*backend, scene, {}, input);
    for (size_t i = 0; i < black.rgba.size(); i += 4) {
      const float left = 1 - black.rgba[i + 3];
      ASSERT_NEAR(filled.rgba[i], black.rgba[i] + left * 0.25f, 1e-6f);
      ASSERT_NEAR(filled.rgba[i + 2], black.rgba[i + 2] + left, 1e-6f);
      ASSERT_EQ(filled.rgba[i + 3], black.rgba[i + 3]);
    }
  }
}

}  // namespace
}  // namespace voyager::image_test
