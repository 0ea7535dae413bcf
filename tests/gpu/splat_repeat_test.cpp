// What a frame must not depend on: what its view and others drew before, how often, on how
// many multiprocessors; and what views leave behind.
#include <algorithm>

#include "runtime/base/error.h"
#include "tests/gpu/splat_test.h"

namespace voyager::test {
namespace splat_repeat_test {
namespace {

using SplatRepeat = SplatTest;

// Small steps, a jump, a turn; sizes and τ change in between.
std::vector<FrameInput> walk(size_t frames) {
  const std::pair<uint32_t, uint32_t> sizes[] = {
      {240, 150}, {64, 64}, {401, 33}, {1, 1}, {320, 200}};
  std::vector<FrameInput> path;
  for (size_t i = 0; i < frames; ++i) {
    const double at = 0.02 * static_cast<double>(i) + (i % 50 > 40 ? 9 : 0);
    const auto& [width, height] = sizes[i / 7 % std::size(sizes)];
    const double tau = i % 23 == 5 ? 25 : 4 + 0.01 * static_cast<double>(i % 9);
    path.push_back(
        frame_input(look({3 + at, -6, -24 + at}, {0.1, 0.2, 5}, width, height), tau, i % 11 != 3));
  }
  return path;
}

TEST_F(SplatRepeat, AFrameIsTheSameTwiceAndFromAViewThatSawOthers) {
  const auto scene = baked_scene(random_cloud(share_of(40000), 6, 1));
  for (const NamedDesc& named : all_exponentials(std::array{32u})) {
    SCOPED_TRACE(named.name);
    const auto one = view(scene, named.desc), other = view(scene, named.desc);
    for (const FrameInput& input : walk(60)) {
      const Frame frame = render(*one, input);
      expect_same_bits(frame, render(*one, input));
      if (input.eyes[0].camera.width != 64) continue;
      expect_same_bits(frame, render(*other, input));
      expect_same_bits(frame, draw(scene, named.desc, input));
    }
  }
}

TEST_F(SplatRepeat, ScenesAndViewsAlternate) {
  const auto baked = baked_scene(random_cloud(share_of(20000), 7, 2));
  const std::shared_ptr<const Scene> flat = flat_scene(random_cloud(share_of(9000), 8, 3));
  const std::vector<FrameInput> path = walk(40);
  std::vector<Frame> expected[2];
  for (const FrameInput& input : path) {
    expected[0].push_back(draw(baked, {}, input));
    expected[1].push_back(draw(flat, {}, input));
  }
  const auto first = view(baked), second = view(flat), third = view(baked);
  for (size_t i = 0; i < path.size(); ++i) {
    const size_t back = path.size() - 1 - i;
    expect_same_bits(expected[0][i], render(*first, path[i]));
    expect_same_bits(expected[1][i], render(*second, path[i]));
    expect_same_bits(expected[0][back], render(*third, path[back]));
  }
}

TEST_F(SplatRepeat, APartOfTheMultiprocessorsGivesTheSameBits) {
  std::unique_ptr<Backend> part;
  try {
    part = create_backend(16);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unsupported) throw;
    VOYAGER_SKIP_WITHOUT(CUDA, error.what());  // a driver without green contexts
  }
  const GaussianCloud cloud = random_cloud(share_of(60000), 9, 3);
  const std::shared_ptr<const Scene> flat = flat_scene(cloud);
  const auto baked = baked_scene(cloud);
  for (const NamedDesc& named : all_exponentials(std::array{32u}))
    for (const auto& scene : {baked, flat}) {
      SCOPED_TRACE(named.name);
      const auto whole_view = view(scene, named.desc), part_view = view(*part, scene, named.desc);
      for (const FrameInput& input : varied_frames()) {
        const Frame whole = render(*whole_view, input), found = render(*part_view, input);
        expect_same_bits(whole, found);
        EXPECT_TRUE(whole.cut == found.cut);
      }
    }
}

// What a device is asked once, and what a kernel is allowed on it, is its own: an eye of a headset
// takes more shared memory in the bins than a kernel has unasked.
TEST_F(SplatRepeat, ASecondDeviceGivesTheSameBits) {
  int devices = 0;
  cuda::check(cudaGetDeviceCount(&devices), "devices");
  if (devices < 2) GTEST_SKIP() << "one CUDA device";
  const auto second = cuda::create_cuda_backend({1, 0, nullptr});
  const auto scene = baked_scene(random_cloud(share_of(20000), 14, 1));
  const FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 2064, 2208), 3);
  expect_same_bits(draw(scene, {}, input), draw(*second, scene, {}, input));
}

TEST_F(SplatRepeat, MemoryStandsStillAfterTheFirstRound) {
  const auto scene = baked_scene(random_cloud(share_of(20000), 10, 1));
  const auto one = view(scene), other = view(scene, {.exponential = Exponential::ex2});
  const std::vector<FrameInput> path = walk(300);
  const auto round = [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      render(*one, path[i]);
      render(*other, path[path.size() - 1 - i]);
    }
  };
  round(0, 150);  // every size, τ and place once
  const size_t free = free_bytes();
  round(150, 300);
  EXPECT_EQ(free_bytes(), free);
}

TEST_F(SplatRepeat, ViewsGoInAnyOrderAndLeaveNothing) {
  const GaussianCloud cloud = random_cloud(share_of(20000), 11, 1);
  const FrameInput input = walk(1)[0];
  const auto baked = baked_scene(cloud);
  const std::shared_ptr<const Scene> flat = flat_scene(cloud);
  const auto round = [&](std::array<size_t, 4> order) {
    std::vector<std::unique_ptr<View>> views;
    for (const auto& scene : {baked, flat, baked, flat}) views.push_back(view(scene));
    const Frame frames[] = {render(*views[0], input), render(*views[1], input)};
    for (size_t k = 0; k < order.size(); ++k) {
      views[order[k]].reset();
      for (size_t left = 0; left < views.size(); ++left)
        if (views[left]) expect_same_bits(frames[left % 2], render(*views[left], input));
    }
  };
  round({0, 1, 2, 3});
  const size_t free = free_bytes();
  std::array<size_t, 4> order{0, 1, 2, 3};
  while (std::next_permutation(order.begin(), order.end())) round(order);
  EXPECT_EQ(free_bytes(), free);
}

}  // namespace
}  // namespace splat_repeat_test
}  // namespace voyager::test
