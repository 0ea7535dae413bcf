// Real Gaussians: both backends, and one scene in several formats.
#include <cstdio>
#include <tuple>

#include "tests/support/real_scenes.h"
#include "tests/support/render_scene.h"

namespace voyager::real_scenes_test {
namespace {

using test::compare;
using test::Frame;
using test::frame_input;
using test::look;
using test::render;

std::shared_ptr<const Scene> load(const std::string& path) {
  Workers workers;
  return load_scene(open_file_source(path), std::pmr::get_default_resource(), workers);
}

// From above at an angle, most of the scene across most of the image.
Camera overview(const Scene& scene, uint32_t width, uint32_t height) {
  const auto [middle, reach] = test::middle_of(scene);
  return look({middle.x - 0.5 * reach, middle.y - 0.6 * reach, middle.z - 0.7 * reach}, middle,
              width, height);
}

double share_covered(const Frame& frame) {
  size_t covered = 0;
  for (size_t i = 3; i < frame.rgba.size(); i += 4) covered += frame.rgba[i] > 0.5f;
  return static_cast<double>(4 * covered) / static_cast<double>(frame.rgba.size());
}

void expect_parity(const std::string& path, const char* name) {
  const auto flat = load(path);
  const auto baked = test::baked_scene(test::import_file(path));
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  const FrameInput input = frame_input(overview(*flat, 240, 160), 3);
  const Frame all = render(*cpu, flat, {}, input);
  EXPECT_GT(share_covered(all), 0.1);
  test::expect_no_nan(all);
  test::expect_same_bits(all, render(*cpu, flat, {.alpha_filter = false}, input));
  test::expect_same_bits(all, render(*cpu, baked, {.lod = Lod::all_leaves}, input));
  const test::Difference whole = compare(all, render(*reference, flat, {}, input));
  const Frame cut = render(*cpu, baked, {}, input);
  const test::Difference lod = compare(cut, render(*reference, baked, {}, input));
  EXPECT_GE(whole.psnr, 60);
  EXPECT_GE(lod.psnr, 60);
  EXPECT_LE(whole.rough + lod.rough, all.depth.size() / 1000);
  const double cost = compare(cut, all).psnr;
  std::printf(
      "%s: CPU against reference %.1f dB (whole), %.1f dB (tau 3), rough pixels %zu; tau 3 against "
      "whole %.1f dB\n",
      name, whole.psnr, lod.psnr, whole.rough + lod.rough, cost);
}

TEST(RealScenes, BlockIsTheSameOnBothBackends) {
  VOYAGER_NEEDS_SCENES(folder);
  expect_parity(folder + "/formats/block.ply", "block.ply");
}

TEST(RealScenes, PlaybotWithShDegreeTwoIsTheSameOnBothBackends) {
  VOYAGER_NEEDS_SCENES(folder);
  expect_parity(folder + "/formats/playbot_lod3.ply", "playbot_lod3.ply");
}

TEST(RealScenes, SpzIsWithinItsQuantisationOfThePly) {
  VOYAGER_NEEDS_SCENES(folder);
  const auto ply = load(folder + "/formats/block.ply");
  const auto cpu = create_cpu_backend();
  const FrameInput input = frame_input(overview(*ply, 480, 320), 3);
  const Frame expected = render(*cpu, ply, {}, input);
  for (const char* name : {"block.spz", "block_v3.spz"}) {
    const test::Difference d =
        compare(render(*cpu, load(folder + "/formats/" + name), {}, input), expected);
    EXPECT_GE(d.psnr, 30) << name;
    std::printf("%s against block.ply: %.1f dB, largest %.0f/255\n", name, d.psnr, 255 * d.largest);
  }
}

TEST(RealScenes, PackedFormatsAreWithinTheirQuantisationOfThePly) {
  VOYAGER_NEEDS_SCENES(folder);
  const std::string block = folder + "/formats/block";
  const auto scene = [](const std::string& path, int sh_degree) {
    Workers workers;
    const auto loaded =
        load_scene(open_file_source(path), std::pmr::get_default_resource(), workers);
    lower_sh_degree(sh_degree, *loaded);
    return std::shared_ptr<const Scene>(loaded);
  };
  const auto cpu = create_cpu_backend();
  const FrameInput input = frame_input(overview(*load(block + ".ply"), 480, 320), 3);
  for (const auto& [ending, sh_degree, least] :
       {std::tuple(".compressed.ply", 3, 35.0), std::tuple(".splat", 0, 40.0)}) {
    const Frame expected = render(*cpu, scene(block + ".ply", sh_degree), {}, input);
    const test::Difference d =
        compare(render(*cpu, scene(block + ending, sh_degree), {}, input), expected);
    EXPECT_GE(d.psnr, least) << ending;
    std::printf("block%s against block.ply, SH degree %d: %.1f dB, largest %.0f/255\n", ending,
                sh_degree, d.psnr, 255 * d.largest);
  }
}

TEST(RealScenes, CompactStorageIsNearTheLossless) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud cloud = test::import_file(folder + "/formats/block.ply");
  const auto lossless = test::baked_scene(cloud);
  const auto compact = test::baked_scene(cloud, Quality::compact);
  const auto cpu = create_cpu_backend();
  for (const Lod lod : {Lod::all_leaves, Lod::cut}) {
    const FrameInput input =
        frame_input(overview(*load(folder + "/formats/block.ply"), 480, 320), 3);
    const test::Difference d = compare(render(*cpu, compact, {.lod = lod}, input),
                                       render(*cpu, lossless, {.lod = lod}, input));
    EXPECT_GE(d.psnr, 50);
    std::printf("compact against lossless block, %s: %.1f dB, largest %.1f/255\n",
                lod == Lod::cut ? "tau 3" : "all leaves", d.psnr, 255 * d.largest);
  }
}

}  // namespace
}  // namespace voyager::real_scenes_test
