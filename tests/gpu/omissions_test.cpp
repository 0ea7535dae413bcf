// What a scene or a view does not need is not in the device's memory, and the image is the same to
// the bit as where it is.
#include <algorithm>

#include "cuda/device/stream.h"
#include "cuda/frame/draws.h"
#include "cuda/scene/device_parents.h"
#include "runtime/frame/whole_tree.h"
#include "runtime/scene/sh_bands.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/depth_limits.h"

namespace voyager::test {
namespace omissions_test {
namespace {

using cuda::buffer_bytes;

const Omission* find(const std::vector<Omission>& all, const char* what) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Omission& o) { return o.what == what; });
  return found == all.end() ? nullptr : &*found;
}

// What `work` launches into a stream, which is recorded and not run.
template <class Work>
size_t launches(const Work& work) {
  const cuda::Stream stream;
  cuda::check(cudaStreamBeginCapture(stream.get(), cudaStreamCaptureModeRelaxed), "capture");
  work(stream.get());
  cudaGraph_t graph = nullptr;
  cuda::check(cudaStreamEndCapture(stream.get(), &graph), "capture");
  size_t count = 0;
  cuda::check(cudaGraphGetNodes(graph, nullptr, &count), "launches");
  cuda::check(cudaGraphDestroy(graph), "capture");
  return count;
}

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

TEST_F(SplatOmissions, AViewOfEveryLeafLaunchesNoSearch) {
  const GaussianCloud cloud = random_cloud(20000, 93, 0);
  const std::shared_ptr<const Scene> scene = baked_scene(cloud), flat = flat_scene(cloud);
  const auto on = device();
  on->use();
  const auto launched = [&](const std::shared_ptr<const Scene>& of, Lod lod,
                            std::unique_ptr<cuda::CutSearch> search) {
    const auto draws = cuda::create_draws(*of, lod, std::move(search));
    const auto update = [&](cudaStream_t stream) {
      draws->update({{3, -6, -24}, 0.05f}, {}, stream);
      draws->weigh(stream);
    };
    const cuda::Stream first;  // which loads the kernels
    update(first.get());
    first.wait();
    return launches(update);
  };
  EXPECT_EQ(launched(flat, Lod::cut, nullptr), 0u);
  EXPECT_EQ(launched(scene, Lod::all_leaves, nullptr), 0u);
  // The cut and the weights of its nodes.
  EXPECT_GE(launched(scene, Lod::cut,
                     cuda::create_exhaustive_search(on, *scene, *whole_tree(*scene), true)),
            2u);
}

TEST_F(SplatOmissions, BandsThatAreZeroEverywhereAreNeitherThereNorRead) {
  const GaussianCloud bare = random_cloud(20000, 91, 0);
  GaussianCloud padded = bare;
  change_sh_degree(padded.sh, 0, 3);
  padded.sh_degree = 3;
  const size_t saved = cuda::coefficient_bytes(3, cuda::ShForm::half) -
                       cuda::coefficient_bytes(0, cuda::ShForm::half);
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

// Limits that hide nothing give the image of none.
TEST_F(SplatOmissions, DepthLimitsAreThereOnceAFrameHasThem) {
  const auto one = view(flat_scene(random_cloud(2000, 94, 0)));
  FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 240, 150), 3, false);
  input.eyes[0].depth_wanted = true;
  const LimitImage everywhere(input.eyes[0].camera, INFINITY);
  const Frame without = render(*one, input);
  const auto listed = one->omissions();
  const Omission* limits = find(listed, "depth limits");
  ASSERT_NE(limits, nullptr);
  const size_t before = buffer_bytes;
  const Frame with = render(*one, limited(input, everywhere));
  EXPECT_EQ(buffer_bytes - before, limits->bytes);
  EXPECT_EQ(limits->bytes, 240u * 150 * 4);
  EXPECT_EQ(find(one->omissions(), "depth limits"), nullptr);
  expect_same_bits(without, with);
}

TEST_F(SplatOmissions, KernelsWithoutSiblingsOrCountingAreListed) {
  const GaussianCloud cloud = random_cloud(2000, 95, 0);
  const auto flat = view(flat_scene(cloud)), cut = view(baked_scene(cloud));
  const auto counting = view(flat_scene(cloud), {.count_pixels = true});
  EXPECT_NE(find(flat->omissions(), "weights of siblings"), nullptr);
  EXPECT_EQ(find(cut->omissions(), "weights of siblings"), nullptr);
  EXPECT_NE(find(flat->omissions(), "counting of pixels"), nullptr);
  EXPECT_EQ(find(counting->omissions(), "counting of pixels"), nullptr);
  EXPECT_EQ(find(counting->omissions(), "weights of siblings"), nullptr) << "one kernel for all";
}

}  // namespace
}  // namespace omissions_test
}  // namespace voyager::test
