// Long tile lists, and more splats and pairs than a view starts with.
#include <algorithm>
#include <numeric>

#include "cuda/device/buffer.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"

namespace voyager::test {
namespace splat_lists_test {
namespace {

enum class Depths { ascending, descending, shuffled, grouped, tied };
constexpr Depths kDepths[] = {Depths::ascending, Depths::descending, Depths::shuffled,
                              Depths::grouped, Depths::tied};

// `count` sheets over the whole image, along the axis of a camera at the origin. The i-th
// has the same colour and opacity whatever its depth.
std::shared_ptr<Scene> stack(size_t count, Depths depths) {
  std::vector<size_t> place(count);
  std::iota(place.begin(), place.end(), size_t{0});
  std::mt19937 random(static_cast<uint32_t>(count));
  if (depths == Depths::descending) std::reverse(place.begin(), place.end());
  if (depths == Depths::shuffled) std::shuffle(place.begin(), place.end(), random);
  auto scene = empty_scene();
  random.seed(5);
  for (size_t i = 0; i < count; ++i) {
    const size_t at = depths == Depths::tied      ? 0
                      : depths == Depths::grouped ? random() % 13
                                                  : place[i];
    const auto code = static_cast<uint32_t>(i * 2654435761u >> 7);
    add_gaussian(*scene, {0, 0, 1 + 1e-4f * static_cast<float>(at)}, {1e4f, 1e4f, 1e-6f},
                 0.004f + 1e-6f * static_cast<float>(code % 1000),
                 {static_cast<float>(code % 2), static_cast<float>(code / 2 % 2), 0.5f});
  }
  return scene;
}

// The same by depth, ties as they stand: what METHOD §6 says the order is.
std::shared_ptr<Scene> sorted(const Scene& scene) {
  std::vector<uint32_t> order(scene.gaussians.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return scene.gaussians[a].mean.z < scene.gaussians[b].mean.z;
  });
  auto result = empty_scene();
  for (const uint32_t i : order) {
    result->gaussians.push_back(scene.gaussians[i]);
    result->sh.insert(result->sh.end(), &scene.sh[3 * i], &scene.sh[3 * i] + 3);
  }
  result->leaf_count = order.size();
  return result;
}

using SplatLists = SplatTest;

// Around what a block sorts at once, and around what it merges.
constexpr size_t kLengths[] = {1,    2,    31,   32,   33,   255,  256,  257,   511,   512,
                               513,  1023, 1024, 1025, 2047, 2048, 2049, 2065,  4095,  4096,
                               4097, 6144, 6145, 8191, 8192, 8193, 9999, 20000, 100000};

TEST_F(SplatLists, AListOfAnyLengthAndOrderIsDrawnByDepthThenId) {
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 16, 16));
  for (const size_t length : kLengths)
    for (const Depths depths : kDepths) {
      SCOPED_TRACE(std::to_string(length) + ", order " + std::to_string(static_cast<int>(depths)));
      const auto scene = stack(length, depths);
      const Frame found = draw(scene, {}, input);
      EXPECT_EQ(found.stats.pairs_after, length);
      expect_same_bits(found, draw(sorted(*scene), {}, input));
      const Difference d = compare(found, draw(*cpu, scene, {}, input));
      EXPECT_LE(d.largest, 1e-4);
    }
}

// On the axis α does not depend on the depth: only the order is left.
TEST_F(SplatLists, EqualDepthsGoByTheInputsOrder) {
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 1, 1));
  for (const size_t length : kLengths) {
    const Frame tied = draw(stack(length, Depths::tied), {}, input);
    const Frame rising = draw(stack(length, Depths::ascending), {}, input);
    EXPECT_EQ(different_bits(tied.rgba, rising.rgba), 0u) << length;
  }
}

// A pixel is full behind 14 sheets of opacity 1/2, and a warp takes 32 at a time.
TEST_F(SplatLists, PlacesThatNoPixelComesToAreNotCountedAsRead) {
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 16, 16));
  const auto read = [&](float opacity, size_t length, const PipelineDesc& desc) {
    const auto scene = stack(length, Depths::shuffled);
    for (Gaussian& g : scene->gaussians) g.opacity = opacity, g.log_opacity = std::log(opacity);
    return draw(scene, desc, input).stats.places_read;
  };
  const PipelineDesc counting{.count_pixels = true};
  for (const size_t length : {size_t{20}, size_t{1000}, size_t{9999}}) {
    EXPECT_EQ(read(0.5f, length, counting), std::min<size_t>(length, 32)) << length;
    EXPECT_EQ(read(0.5f, length, {}), 0u) << "it is counted unasked";
  }
  EXPECT_EQ(read(0.004f, 1000, counting), 1000u);
}

// Lists of every length side by side: a tile's length falls with its distance from the middle.
TEST_F(SplatLists, ManyLengthsInOneImage) {
  auto scene = empty_scene();
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0, 1.2f);
  for (int i = 0; i < 60000; ++i) {
    const float z = 6 + static_cast<float>(random() % 4000) / 1000;
    add_gaussian(*scene, {normal(random), normal(random), z}, {0.03f, 0.03f, 0.03f},
                 0.02f + static_cast<float>(random() % 100) / 300,
                 {static_cast<float>(random() % 2), static_cast<float>(random() % 2), 0.3f});
  }
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 331, 271));
  Agreement with_cpu("lists, CUDA against the CPU");
  const Frame found = draw(scene, {}, input);
  with_cpu.add(found, draw(*cpu, scene, {}, input));
  with_cpu.expect();
  EXPECT_GT(found.stats.pairs_after, 4 * scene->gaussians.size() / 3);
}

constexpr uint64_t kFirstSlots = uint64_t{1} << 18, kFirstPairs = uint64_t{1} << 20;

TEST_F(SplatLists, AViewsFirstFrameIsWholeHoweverLargeItIs) {
  GaussianCloud cloud = random_cloud(500000, 12, 0);
  const std::shared_ptr<const Scene> scene = flat_scene(cloud);
  const FrameInput small = frame_input(look({3, -6, -24}, {0, 0, 0}, 64, 40)),
                   large = frame_input(look({3, -6, -24}, {0, 0, 0}, 960, 540));
  const auto cold = view(scene), warm = view(scene);
  const Frame first = render(*cold, large);
  EXPECT_GT(first.stats.splats, kFirstSlots);
  EXPECT_GT(first.stats.pairs_after, kFirstPairs);
  EXPECT_EQ(first.stats.pairs_dropped, 0u);
  EXPECT_GT(first.stats.redraws, 0u);
  const Frame second = render(*cold, large);
  EXPECT_EQ(second.stats.redraws, 0u);
  expect_same_bits(first, second);
  render(*warm, small);
  render(*warm, large);
  render(*warm, small);
  expect_same_bits(first, render(*warm, large));
  Agreement with_cpu("a large first frame, CUDA against the CPU");
  with_cpu.add(first, draw(*cpu, scene, {}, large));
  with_cpu.expect();
}

// The leaves of a tree go in the order of its nodes into slots that are numbered by the input's.
TEST_F(SplatLists, AllLeavesOfALargeTreeAreWholeInTheFirstFrame) {
  const auto scene = baked_scene(random_cloud(300000, 13, 0));
  const FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 320, 200));
  const auto cold = view(scene, {.lod = Lod::all_leaves});
  const Frame first = render(*cold, input);
  EXPECT_GT(first.stats.cut_size, kFirstSlots);
  expect_same_bits(first, render(*cold, input));
  Agreement with_cpu("all leaves of a tree, CUDA against the CPU");
  with_cpu.add(first, draw(*cpu, scene, {.lod = Lod::all_leaves}, input));
  with_cpu.expect();
}

// Holds all device memory but `left` bytes while it lives.
class TakenMemory {
 public:
  explicit TakenMemory(size_t left) {
    for (size_t piece = size_t{1} << 37; piece >= size_t{1} << 20; piece /= 2) {
      size_t free = 0, all = 0;
      while (cudaMemGetInfo(&free, &all) == cudaSuccess && free > left + piece) {
        void* taken = nullptr;
        if (cudaMalloc(&taken, piece) != cudaSuccess) break;
        pieces_.push_back(taken);
      }
    }
    cudaGetLastError();
  }
  ~TakenMemory() {
    for (void* piece : pieces_) cudaFree(piece);
  }

 private:
  std::vector<void*> pieces_;
};

TEST_F(SplatLists, WithoutMemoryAFrameSaysWhatItLeftOutAndTheNextIsWhole) {
  const auto scene = stack(100000, Depths::shuffled);
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 256, 128));
  const Frame whole = draw(scene, {}, input);
  EXPECT_EQ(whole.stats.pairs_dropped, 0u);
  const auto poor = view(scene);
  {
    const TakenMemory taken(size_t{64} << 20);
    for (int frame = 0; frame < 3; ++frame) {
      const Frame found = render(*poor, input);
      EXPECT_GT(found.stats.pairs_dropped, 0u);
      EXPECT_LT(found.stats.pairs_dropped, found.stats.pairs_after);
      expect_no_nan(found);
    }
  }
  const Frame found = render(*poor, input);
  EXPECT_EQ(found.stats.pairs_dropped, 0u);
  expect_same_bits(found, whole);
}

constexpr uint32_t kSide = 800;

// 600 small Gaussians in the middle, and `lines` lines over the upper half.
std::shared_ptr<Scene> heap_and_lines(int lines) {
  auto scene = empty_scene();
  std::mt19937 random(9);
  std::normal_distribution<float> normal(0, 0.02f);
  for (int i = 0; i < 600; ++i)
    add_gaussian(*scene, {normal(random), normal(random), 4 + 1e-3f * static_cast<float>(i)},
                 {0.01f, 0.02f, 0.01f}, 0.01f + static_cast<float>(random() % 100) / 1000,
                 {static_cast<float>(random() % 2), 0.4f, static_cast<float>(random() % 2)});
  for (int i = 0; i < lines; ++i)
    add_gaussian(*scene, {0, -3, 4}, {1.5f, 0.02f, 0.01f}, 0.01f, {0.5f, 0.5f, 0.5f});
  return scene;
}

// A list that is long beside all others is blended by more warps, a pixel a lane. What else is in
// the image, and so which lists those are, changes nothing of it.
TEST_F(SplatLists, ALongListIsTheSameBesideShortOnesAndBesideLonger) {
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, kSide, kSide, 90));
  const Frame few = draw(heap_and_lines(0), {}, input);
  const Frame many = draw(heap_and_lines(60000), {}, input);
  EXPECT_GT(many.stats.pairs_after, 1500000u);
  constexpr size_t kHalf = size_t{2} * kSide * kSide;  // floats of the upper half
  EXPECT_EQ(different_bits(std::vector<float>(few.rgba.begin() + kHalf, few.rgba.end()),
                           std::vector<float>(many.rgba.begin() + kHalf, many.rgba.end())),
            0u);
  EXPECT_GT(few.at(kSide / 2, kSide / 2)[3], 0.9f);
}

// What a view makes room for is what may reach its image, not what is drawn in all directions.
TEST_F(SplatLists, WhatIsOutOfSightTakesNoRoomForSplats) {
  auto scene = empty_scene();
  for (size_t i = 0; i < 4 * kFirstSlots; ++i)
    add_gaussian(*scene, {0, 0, i == 7 ? 2.0f : -2.0f}, {0.1f, 0.1f, 0.1f}, 0.5f, {0.3f, 0.5f, 1});
  const auto away = view(scene);
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 16, 16));
  const size_t before = cuda::buffer_bytes;
  const Frame found = render(*away, input);
  EXPECT_EQ(found.stats.splats, 1u);
  EXPECT_EQ(found.stats.pairs_dropped, 0u);
  EXPECT_LT(cuda::buffer_bytes - before, scene->gaussians.size());
  EXPECT_LE(compare(found, draw(*cpu, scene, {}, input)).largest, 1e-4);
}

// Few splats, many pairs; and the other way round.
TEST_F(SplatLists, SlotsAndPairsGrowEachForItself) {
  const auto sheets = stack(4000, Depths::shuffled);
  const FrameInput wide = frame_input(look({0, 0, 0}, {0, 0, 1}, 333, 320));
  const Frame pairs = draw(sheets, {}, wide);
  EXPECT_LT(pairs.stats.splats, kFirstSlots);
  EXPECT_GT(pairs.stats.pairs_after, kFirstPairs);
  expect_same_bits(pairs, draw(sorted(*sheets), {}, wide));
  EXPECT_LE(compare(pairs, draw(*cpu, sheets, {}, wide)).largest, 1e-4);

  const auto crowd = stack(kFirstSlots + 1000, Depths::shuffled);
  const FrameInput tiny = frame_input(look({0, 0, 0}, {0, 0, 1}, 9, 16));
  const Frame slots = draw(crowd, {}, tiny);
  EXPECT_GT(slots.stats.splats, kFirstSlots);
  EXPECT_LT(slots.stats.pairs_after, kFirstPairs);
  expect_same_bits(slots, draw(sorted(*crowd), {}, tiny));
  EXPECT_LE(compare(slots, draw(*cpu, crowd, {}, tiny)).largest, 1e-4);
}

}  // namespace
}  // namespace splat_lists_test
}  // namespace voyager::test
