// Scenes with damaged chunks: drawn where the CPU draws them, refused where it refuses, and
// then the image is as it was.
#include "tests/gpu/agreement.h"
#include "tests/gpu/guarded_image.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/scene_files.h"

namespace voyager::test {
namespace splat_damage_test {
namespace {

std::vector<FrameInput> frames() {
  std::vector<FrameInput> all;
  for (const double tau : {0.0, 10.0, 200.0, 1000.0, 1e5})
    for (const Vec3d& eye : {Vec3d{3, -6, -24}, Vec3d{-200, 10, 5}})
      all.push_back(frame_input(look(eye, {0.5, 0, 0}, 200, 120), tau));
  return all;
}

class SplatDamage : public SplatTest {
 protected:
  // With a byte of a chunk changed.
  std::shared_ptr<const Scene> damaged(const ChunkEntry& chunk) {
    const auto source =
        std::make_shared<FlippedSource>(bytes, chunk.offset + chunk.bytes / 3, std::byte{4});
    return load_scene(source, std::pmr::get_default_resource(), workers);
  }

  // Draws as the CPU does, or not, as it does not.
  void expect_as_cpu(View& own, View& host, const FrameInput& input) {
    Frame expected;
    try {
      expected = render(host, input);
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::damaged_chunk);
      GuardedImage image(ColorFormat::rgba8, input.eyes[0].camera.width,
                         input.eyes[0].camera.height);
      EXPECT_EQ(error_code([&] { own.render(input, image.image()); }), ErrorCode::damaged_chunk);
      EXPECT_TRUE(image.untouched());
      ++refused;
      return;
    }
    agreement.add(render(own, input), expected);
    ++drawn;
  }

  const Bytes bytes =
      scene_bytes(bake(random_cloud(share_of(6000), 4, 1)), Quality::lossless, 0, 32768);
  Agreement agreement{"damaged scenes, CUDA against the CPU"};
  size_t drawn = 0, refused = 0;
};

TEST_F(SplatDamage, AFrameIsDrawnOrRefusedAsTheCpuDoes) {
  const SceneFile file(source_of(bytes));
  ASSERT_GT(file.chunks().size(), 3u);
  for (const ChunkEntry& chunk : file.chunks()) {
    const auto scene = damaged(chunk);
    ASSERT_EQ(scene->damaged_chunks.size(), 1u);
    for (const PipelineDesc& desc : {PipelineDesc{}, PipelineDesc{.lod = Lod::all_leaves}}) {
      const auto own = view(scene, desc), host = view(*cpu, scene, desc);
      for (const FrameInput& input : frames()) expect_as_cpu(*own, *host, input);
    }
  }
  agreement.expect();
  EXPECT_GT(refused, 20u);
  EXPECT_GT(drawn, 20u);
}

}  // namespace
}  // namespace splat_damage_test
}  // namespace voyager::test
