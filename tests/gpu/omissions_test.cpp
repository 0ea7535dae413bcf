// What a scene or a view does not need is not in the device's memory, and the image is the same to
// the bit as where it is.
#include "cuda/device_parents.h"
#include "runtime/scene/sh_bands.h"
#include "tests/gpu/splat_test.h"

namespace voyager::test {
namespace {

using cuda::buffer_bytes;

class SplatOmissions : public SplatTest {
 protected:
  // Of the device, that a view of the scene takes before its first frame, and its scene with it.
  size_t bytes_of(const std::shared_ptr<const Scene>& scene, const PipelineDesc& desc) {
    const size_t before = buffer_bytes;
    const auto one = view(scene, desc);
    return buffer_bytes - before;
  }
};

TEST_F(SplatOmissions, AViewOfEveryLeafHasNoParentsAndNoSearch) {
  const GaussianCloud cloud = random_cloud(20000, 90, 1);
  const auto scene = baked_scene(cloud);
  const size_t parents = cuda::DeviceParents::bytes(*scene), search = scene->search.bytes();
  const size_t leaves = bytes_of(scene, {.lod = Lod::all_leaves}), cut = bytes_of(scene, {});
  EXPECT_GE(cut + 2 * sizeof(uint32_t) * cloud.size(), leaves + parents + search);
  const FrameInput input = varied_frames()[0];
  const auto every_leaf = view(scene, {.lod = Lod::all_leaves});
  const Frame alone = render(*every_leaf, input);
  expect_same_bits(alone, draw(flat_scene(cloud), {}, input));
  EXPECT_FALSE(alone.stats.searched);
  // A view that draws a cut brings what it needs, for as long as it is there.
  const size_t before = buffer_bytes;
  {
    const auto of_cut = view(scene);
    EXPECT_GE(buffer_bytes - before, parents + search);
    expect_same_bits(render(*of_cut, input), draw(scene, {}, input));
    expect_same_bits(alone, render(*every_leaf, input));
  }
  EXPECT_EQ(buffer_bytes, before);
}

TEST_F(SplatOmissions, BandsThatAreZeroEverywhereAreNeitherThereNorRead) {
  const GaussianCloud bare = random_cloud(20000, 91, 0);
  GaussianCloud padded = bare;
  change_sh_degree(padded.sh, 0, 3);
  padded.sh_degree = 3;
  const size_t saved = cuda::coefficient_bytes(3, true) - cuda::coefficient_bytes(0, true);
  const auto without = flat_scene(bare), with = flat_scene(padded);
  EXPECT_EQ(bytes_of(with, {}) - bytes_of(without, {}), saved * bare.size());
  const auto tree = baked_scene(padded);  // which leaves them out as it loads
  const auto full = std::const_pointer_cast<Scene>(baked_scene(padded));
  change_sh_degree(full->sh, 0, 3);
  full->sh_degree = 3;
  for (const FrameInput& input : varied_frames())
    for (const auto& [a, b] :
         {std::pair<std::shared_ptr<const Scene>, std::shared_ptr<const Scene>>(without, with),
          {tree, full}}) {
      const Frame less = draw(a, {}, input), more = draw(b, {}, input);
      expect_same_bits(less, more);
      EXPECT_EQ(more.stats.bytes[kProject] - less.stats.bytes[kProject], saved * less.stats.splats);
    }
}

TEST_F(SplatOmissions, DepthIsThereOnceItIsAskedFor) {
  const auto one = view(flat_scene(random_cloud(2000, 92, 0)));
  const FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 240, 150), 3, false);
  FrameInput deep = input;
  deep.eyes[0].depth_wanted = true;
  const Frame flat = render(*one, input);
  ASSERT_EQ(one->omissions().front().what, "depth");
  EXPECT_EQ(one->omissions().front().frame_bytes, 240u * 150 * 4);
  const size_t before = buffer_bytes;
  const Frame with = render(*one, deep);
  EXPECT_EQ(buffer_bytes - before, 240u * 150 * 4);
  EXPECT_EQ(different_bits(flat.rgba, with.rgba), 0u);
}

}  // namespace
}  // namespace voyager::test
