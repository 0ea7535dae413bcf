// SH bands that are zero in every Gaussian are neither stored, nor read, nor kept, and the image
// is the same to the bit as with them.
#include <cstring>

#include "runtime/format/export_flat.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/sh_bands.h"
#include "tests/support/counting_memory.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"
#include "tests/support/stereo.h"

namespace voyager::test {
namespace sh_omission_test {
namespace {

// Of degree 3, with the bands above `used` zero; every other zero is -0.
GaussianCloud padded_cloud(size_t count, uint32_t seed, int used) {
  GaussianCloud cloud = random_cloud(count, seed, used);
  const size_t first = 3 * static_cast<size_t>(sh_coefficients(used));
  change_sh_degree(cloud.sh, used, 3);
  cloud.sh_degree = 3;
  for (size_t i = 0; i < cloud.sh.size(); ++i)
    if (i % 48 >= first && i % 2 == 1) cloud.sh[i] = -0.0f;
  return cloud;
}

GaussianCloud import(const Bytes& ply) {
  return import_gaussians(*read_source(*source_of(ply)));
}

std::shared_ptr<Scene> load(const Bytes& bytes, std::pmr::memory_resource* memory) {
  Workers workers;
  return load_scene(source_of(bytes), memory, workers);
}
std::shared_ptr<Scene> load(const Bytes& bytes) {
  return load(bytes, std::pmr::get_default_resource());
}

// Every way in which a host evaluates SH: each exponential, interpolated and not, two eyes.
void expect_same_images(const std::shared_ptr<const Scene>& a,
                        const std::shared_ptr<const Scene>& b) {
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  for (const double tau : {0.0, 6.0, 40.0}) {
    const FrameInput input = frame_input(look({3, -6, -24}, {0.1, 0.2, 5}, 96, 60), tau);
    for (const Exponential exponential : {Exponential::exact, Exponential::ex2, Exponential::lut})
      expect_same_bits(render(*cpu, a, {.exponential = exponential}, input),
                       render(*cpu, b, {.exponential = exponential}, input));
    expect_same_bits(render(*reference, a, {}, input), render(*reference, b, {}, input));
    FrameInput pair = input;
    pair.eyes.push_back(pair.eyes[0]);
    pair.eyes[1].camera.eye.x += 0.06;
    const EyeFrames left = render_stereo(*cpu, a, {}, pair),
                    right = render_stereo(*cpu, b, {}, pair);
    for (size_t eye = 0; eye < 2; ++eye) expect_same_bits(left[eye], right[eye]);
  }
}

TEST(ShOmission, AFlatSceneWithZeroBandsIsTheSameImageInTheMemoryOfOneWithoutThem) {
  for (const int used : {0, 1, 2}) {
    const GaussianCloud padded = padded_cloud(3000, 60, used);
    CountingMemory memory, without;
    const auto scene = load(ply_bytes(padded), &memory);
    const auto bare = load(ply_bytes(random_cloud(3000, 60, used)), &without);
    EXPECT_EQ(scene->sh_degree, used);
    EXPECT_EQ(scene->profile.input_sh_degree, 3);
    EXPECT_EQ(memory.used(), without.used());
    const auto expected = flat_scene(padded);
    scene->native = expected->native;  // of a file it is estimated
    expect_same_images(scene, expected);
  }
}

TEST(ShOmission, ABandIsKeptForOneCoefficientOfOneGaussian) {
  for (int band = 1; band <= 3; ++band) {
    GaussianCloud cloud = padded_cloud(500, 61, 0);
    cloud.sh[499 * 48 + 3 * static_cast<size_t>(sh_coefficients(band)) - 1] = 1e-30f;
    leave_out_zero_bands(cloud);
    EXPECT_EQ(cloud.sh_degree, band);
    EXPECT_EQ(cloud.input_sh_degree(), 3);
    EXPECT_EQ(cloud.sh.back(), 1e-30f);
    EXPECT_EQ(cloud.sh.size(), 500u * 3 * static_cast<size_t>(sh_coefficients(band)));
  }
}

// But for what the header says of the input.
TEST(ShOmission, ABakeStoresWhatACloudWithoutTheBandsHas) {
  GaussianCloud bare = random_cloud(4000, 62, 1), padded = padded_cloud(4000, 62, 1);
  bare.native = padded.native = {};  // as of a file
  const BakedScene left_out = bake(import(ply_bytes(padded))),
                   had_none = bake(import(ply_bytes(bare))), kept = bake(padded);
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const Bytes with = scene_bytes(left_out, quality), without = scene_bytes(had_none, quality);
    ASSERT_EQ(with.size(), without.size());
    EXPECT_EQ(std::memcmp(with.data() + sizeof(FileHeader), without.data() + sizeof(FileHeader),
                          with.size() - sizeof(FileHeader)),
              0);
    const size_t whole = scene_bytes(kept, quality).size();
    EXPECT_LE(with.size() + (quality == Quality::lossless ? 1 : 0), whole);
    EXPECT_EQ(SceneFile(source_of(with)).info().left_out_bands, 2);
    EXPECT_EQ(SceneFile(source_of(without)).info().left_out_bands, 0);
    expect_same_images(load(with), load(without));
  }
}

// Of a scene whose bands above degree 0 were left out.
void put_bands_back(Scene& scene) {
  std::vector<float> sh(3 * static_cast<size_t>(sh_coefficients(3)));
  std::pmr::vector<uint8_t> rows(scene.sh_rows.size() / sh_row_bytes(0) * sh_row_bytes(3));
  for (size_t i = 0; i < scene.mean_codes.size(); ++i) {
    copy_sh(scene, i, sh.data());
    uint8_t* const row = rows.data() + i * sh_row_bytes(3);
    pack_sh(sh.data(), 3, scene.sh_scales.front(), row);
    put_last_word(last_word(scene.sh_rows.data() + i * sh_row_bytes(0), 0), 3, row);
  }
  scene.sh_rows.swap(rows);
  change_sh_degree(scene.sh, 0, 3);
  scene.sh_degree = 3;
}

// A file may hold bands that are zero: one that was written so.
TEST(ShOmission, ABakedSceneWithZeroBandsIsTheSameImageWithoutThem) {
  const GaussianCloud padded = padded_cloud(4000, 63, 0);
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const Bytes bytes = scene_bytes(bake(padded), quality);
    EXPECT_EQ(SceneFile(source_of(bytes)).info().sh_degree, 3);
    const auto scene = load(bytes), full = load(bytes);
    EXPECT_EQ(scene->sh_degree, 0);
    if (quality == Quality::compact)
      EXPECT_EQ(scene->sh_rows.capacity(), sh_row_bytes(0) * scene->node_count);
    else
      EXPECT_EQ(scene->sh.capacity(), 3 * scene->node_count);
    put_bands_back(*full);
    expect_same_images(scene, full);
  }
}

TEST(ShOmission, AnExportPutsTheBandsBack) {
  const TempFolder folder;
  const GaussianCloud cloud = import(ply_bytes(padded_cloud(700, 64, 1)));
  const Bytes baked = scene_bytes(bake(cloud), Quality::lossless);
  export_leaves(SceneFile(source_of(baked)), folder.file("out.ply"));
  GaussianCloud expected = cloud;
  put_back_zero_bands(expected);
  EXPECT_EQ(expected.sh_degree, 3);
  EXPECT_TRUE(file_bytes(folder.file("out.ply")) == ply_bytes(expected));
}

TEST(ShOmission, ChunksAreCountedByTheDegreeThatTheyUse) {
  GaussianCloud cloud = random_cloud(4000, 65, 0);
  change_sh_degree(cloud.sh, 0, 2);
  cloud.sh_degree = 2;
  cloud.sh[27 * 1234 + 26] = 0.25f;
  const Bytes bytes = scene_bytes(bake(cloud), Quality::lossless);
  const auto scene = load(bytes);
  const auto& chunks = scene->profile.chunks_of_degree;
  EXPECT_EQ(scene->sh_degree, 2);
  EXPECT_GE(chunks[2], 1u);  // the leaf's, and those of the nodes above it
  EXPECT_GT(chunks[0], chunks[2]);
  EXPECT_EQ(chunks[1] + chunks[3], 0u);
  EXPECT_EQ(chunks[0] + chunks[2], scene->chunk_count);
  // Chunks of degree 0 are as they are without the bands.
  const SceneFile file(source_of(bytes));
  const Bytes without = scene_bytes(bake(random_cloud(4000, 65, 0)), Quality::lossless);
  const SceneFile bare(source_of(without));
  uint64_t same = 0;
  for (size_t i = 0; i < file.chunks().size(); ++i)
    same += file.chunks()[i].bytes == bare.chunks()[i].bytes;
  EXPECT_GE(same, chunks[0]);
}

}  // namespace
}  // namespace sh_omission_test
}  // namespace voyager::test
