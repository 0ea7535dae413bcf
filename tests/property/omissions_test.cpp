// What a scene or a view does not need is not there: memory, threads and work are counted, and
// the image is the same to the bit as where it is.
#include <filesystem>

#include "runtime/frame/draw_list.h"
#include "runtime/frame/open_streamed.h"
#include "runtime/frame/scene_gaussians.h"
#include "tests/support/counting_memory.h"
#include "tests/support/depth_limits.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"
#include "tests/support/stereo.h"

namespace voyager::test {
namespace omissions_test {
namespace {

size_t threads() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return static_cast<size_t>(std::distance(begin(tasks), end(tasks)));
}

const Omission* find(const std::vector<Omission>& all, const std::string& what) {
  for (const Omission& omission : all)
    if (omission.what == what) return &omission;
  return nullptr;
}

class Omissions : public ::testing::Test {
 protected:
  // The frame of a view whose memory is counted.
  Frame draw(const std::shared_ptr<const Scene>& scene, const PipelineDesc& desc,
             const FrameInput& seen) {
    View view(scene, *cpu, desc, &memory, workers);
    const Frame frame = desc.eyes == 1 ? render(view, seen) : render_stereo(view, seen)[0];
    used = memory.used();
    listed = view.omissions();
    return frame;
  }

  const std::unique_ptr<Backend> cpu = create_cpu_backend();
  const GaussianCloud cloud = random_cloud(5000, 70, 1);
  const std::shared_ptr<const Scene> baked = baked_scene(cloud), flat = flat_scene(cloud);
  const FrameInput input = frame_input(look({3, -6, -24}, {0.1, 0.2, 5}, 240, 150), 6, false);
  const uint64_t pixels = 240 * 150;
  CountingMemory memory;
  Workers workers{1};
  size_t used = 0;
  std::vector<Omission> listed;
};

TEST_F(Omissions, AFlatSceneHasNoTreeAndNoSearchAndDrawsWhatTheTreesLeavesDraw) {
  EXPECT_EQ(flat->tree.size() + flat->search.bytes() + flat->node_code.size() +
                flat->partition.subtrees.size() + flat->slot_ids.size(),
            0u);
  const Frame frame = draw(flat, {}, input);
  const size_t flat_view = used;
  EXPECT_FALSE(frame.stats.searched);
  EXPECT_EQ(frame.stats.nodes_tested + frame.stats.bytes_read, 0u);
  expect_same_bits(frame, draw(baked, {.lod = Lod::all_leaves}, input));
  EXPECT_EQ(used, flat_view);
  EXPECT_EQ(find(listed, "search")->bytes, baked->search.subtree_count() * 20u);
}

TEST_F(Omissions, AViewOfAllLeavesKeepsNoSearch) {
  View leaves(baked, *cpu, {.lod = Lod::all_leaves}, &memory, workers);
  const size_t list = memory.used();
  EXPECT_LE(list, cloud.size() * sizeof(DrawItem) + 4096);
  View cut(baked, *cpu, {}, &memory, workers);
  EXPECT_GE(memory.used() - list, baked->search.subtree_count() * 20u);
  EXPECT_EQ(find(cut.omissions(), "search"), nullptr);
}

TEST_F(Omissions, DepthThatNoFrameAskedForTakesNoMemory) {
  FrameInput with = input;
  with.eyes[0].depth_wanted = true;
  const Frame frame = draw(baked, {}, input);
  const size_t without = used;
  const Omission listed_depth = *find(listed, "depth");
  const Frame deep = draw(baked, {}, with);
  EXPECT_EQ(different_bits(frame.rgba, deep.rgba), 0u);
  EXPECT_EQ(used - without, pixels * sizeof(float));
  EXPECT_EQ(listed_depth.bytes, pixels * sizeof(float));
  EXPECT_EQ(find(listed, "depth"), nullptr);
}

// Limits that hide nothing give the image of none.
TEST_F(Omissions, DepthLimitsAreLeftOutUntilAFrameHasThem) {
  const LimitImage everywhere(input.eyes[0].camera, INFINITY);
  const Frame frame = draw(baked, {}, input);
  EXPECT_NE(find(listed, "depth limits"), nullptr);
  const Frame with = draw(baked, {}, limited(input, everywhere));
  EXPECT_EQ(find(listed, "depth limits"), nullptr);
  EXPECT_EQ(different_bits(frame.rgba, with.rgba), 0u);
}

TEST_F(Omissions, AViewOfOneEyeHasNoBuffersOfASecond) {
  FrameInput pair = input;
  pair.eyes.push_back(pair.eyes[0]);
  const Frame one = draw(baked, {}, input);
  const size_t mono = used;
  const Omission second = *find(listed, "second eye");
  const Frame left = draw(baked, {.eyes = 2}, pair);
  EXPECT_EQ(different_bits(one.rgba, left.rgba), 0u);
  EXPECT_GE(used - mono, second.bytes);
  EXPECT_GE(second.bytes, pixels * 16);
  EXPECT_EQ(find(listed, "second eye"), nullptr);
}

TEST_F(Omissions, OnlyTheLutsExponentialHasALut) {
  const auto used_by = [&](Exponential exponential, uint32_t lut_size) {
    const size_t before = memory.used();
    const View view(flat, *cpu, {.exponential = exponential, .lut_size = lut_size}, &memory,
                    workers);
    return memory.used() - before;
  };
  draw(flat, {.exponential = Exponential::ex2, .lut_size = 4096}, input);
  EXPECT_EQ(find(listed, "table of the exponential")->bytes, 4097 * sizeof(float));
  draw(flat, {.exponential = Exponential::lut}, input);
  EXPECT_EQ(find(listed, "table of the exponential"), nullptr);
  const size_t without = used_by(Exponential::exact, 4096);
  EXPECT_EQ(used_by(Exponential::ex2, 32), without);
  EXPECT_EQ(used_by(Exponential::lut, 4096), without + 4097 * sizeof(float));
}

TEST_F(Omissions, AResidentSceneHasNoReadersAndNoTablesOfWhatIsThere) {
  const TempFolder folder;
  const Bytes bytes = scene_bytes(bake(cloud), Quality::lossless);
  workers.for_blocks(2, 1, [](size_t, size_t) {});  // the pool's own threads, if it has any
  const size_t before = threads();
  const auto resident = load_scene(source_of(bytes), std::pmr::get_default_resource(), workers);
  const Frame frame = draw(resident, {}, input);
  EXPECT_EQ(threads(), before);
  EXPECT_EQ(resident->slot_ids.size(), 0u);
  EXPECT_FALSE(resident->search.chunks_come_and_go);
  EXPECT_NE(find(listed, "residency"), nullptr);

  StreamingDesc desc;
  desc.readers = 2;
  const auto streamed =
      open_streamed(source_of(bytes), desc, *cpu, std::pmr::get_default_resource(), workers);
  EXPECT_GE(threads(), before + 2);
  EXPECT_GT(streamed->slot_ids.size(), 0u);
  FrameInput wait = input;
  wait.wait_resident = true;
  expect_same_bits(frame, draw(streamed, {}, wait));
  EXPECT_EQ(find(listed, "residency"), nullptr);
  EXPECT_FALSE(streamed->profile.complete);
}

TEST_F(Omissions, TheProfileSaysWhatTheGaussiansAre) {
  GaussianCloud two = random_cloud(2, 71, 0);
  for (size_t i = 0; i < 6; ++i) two.log_scale[i] = std::log(i == 4 ? 3.0f : i == 2 ? 0.5f : 1.0f);
  two.opacity = {9, 9};
  const auto scene = baked_scene(two);
  const SceneProfile& profile = scene->profile;
  EXPECT_TRUE(profile.complete && profile.merged && profile.interpolated);
  EXPECT_LE(profile.least_anisotropy, 2.0f * 1.001f);
  EXPECT_GE(profile.greatest_anisotropy, 3.0f * 0.999f);
  uint64_t above_one = 0;
  const GaussianArrays arrays = gaussian_arrays(*scene);
  for (uint32_t i = 0; i < gaussian_count(*scene); ++i) above_one += arrays.opacity(i) > 1;
  EXPECT_EQ(profile.opacities_above_one, above_one);
  EXPECT_FALSE(baked_scene(random_cloud(1, 72, 0))->profile.merged);
}

}  // namespace
}  // namespace omissions_test
}  // namespace voyager::test
