// The CPU against the float64 reference, and its instruction sets against each other.
#include <algorithm>
#include <cstring>

#include "runtime/base/error.h"
#include "runtime/cpu/bin.h"
#include "runtime/cpu/rasterize.h"
#include "runtime/frame/depth_order.h"
#include "runtime/frame/draw_list.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/project_params.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/math/alpha_lut.h"
#include "tests/support/render_scene.h"

namespace voyager::backends_test {
namespace {

using test::compare;
using test::Frame;
using test::frame_input;
using test::look;
using test::render;

struct Shot {
  Vec3d eye;
  double tau, fov;
};

constexpr Shot kShots[] = {{{3, -6, -24}, 0, 60},
                           {{3, -6, -24}, 3, 60},
                           {{3, -6, -24}, 12, 60},
                           {{1, 1, 1}, 6, 100},
                           {{-30, 2, 9}, 25, 40}};

// Pixels beyond 2/255 lie where a threshold (1/255, 1e-4, the order by the
// 0.2 m plane) fell to the other side: at most 1 in 2000.
TEST(Backends, CpuAgreesWithTheReference) {
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  double least = INFINITY, largest = 0;
  size_t rough = 0, depths = 0, pixels = 0;
  for (const uint32_t seed : {1u, 2u}) {
    const auto scene = test::baked_scene(test::random_cloud(4000, seed, 3));
    for (const Shot& shot : kShots)
      for (const Lod lod : {Lod::cut, Lod::all_leaves}) {
        const FrameInput input =
            frame_input(look(shot.eye, {0.1, 0.2, 5}, 160, 100, shot.fov), shot.tau);
        const Frame a = render(*cpu, scene, {.lod = lod}, input),
                    b = render(*reference, scene, {.lod = lod}, input);
        const test::Difference d = compare(a, b);
        EXPECT_GE(d.psnr, 60) << shot.tau;
        EXPECT_EQ(a.cut, b.cut);
        least = std::min(least, d.psnr);
        largest = std::max(largest, d.largest_smooth);
        rough += d.rough;
        for (size_t i = 0; i < a.depth.size(); ++i) depths += a.depth[i] != b.depth[i];
        pixels += a.depth.size();
      }
  }
  EXPECT_LE(rough, pixels / 2000);
  EXPECT_LE(depths, pixels / 2000);  // a step: the splat at one half may be the next
  RecordProperty("least_psnr", std::to_string(least));
  RecordProperty("largest_smooth_255ths", std::to_string(255 * largest));
  RecordProperty("rough_pixels", std::to_string(rough) + " of " + std::to_string(pixels));
  RecordProperty("depth_steps", std::to_string(depths));
}

TEST(Backends, ExponentialsHaveTheErrorsStatedForThem) {
  const auto scene = test::baked_scene(test::random_cloud(4000, 3, 1));
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  const FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 160, 100), 3);
  const Frame truth = render(*reference, scene, {}, input);
  EXPECT_GE(compare(render(*cpu, scene, {.exponential = Exponential::ex2}, input), truth).psnr, 60);
  const double lut8 =
      compare(render(*cpu, scene, {.exponential = Exponential::lut, .lut_size = 8}, input), truth)
          .psnr;
  const double lut32 =
      compare(render(*cpu, scene, {.exponential = Exponential::lut}, input), truth).psnr;
  const double lut4096 =
      compare(render(*cpu, scene, {.exponential = Exponential::lut, .lut_size = 4096}, input),
              truth)
          .psnr;
  EXPECT_GE(lut32, 35);
  EXPECT_GT(lut32, lut8 + 6);
  EXPECT_GT(lut4096, lut32 + 20);
  RecordProperty("lut8_psnr", std::to_string(lut8));
  RecordProperty("lut32_psnr", std::to_string(lut32));
  RecordProperty("lut4096_psnr", std::to_string(lut4096));
  EXPECT_THROW(render(*reference, scene, {.exponential = Exponential::lut}, input), Error);
}

// Splats of a frame as the CPU's stages make them.
std::vector<Splat> splats_of(const std::shared_ptr<const Scene>& scene, const FrameInput& input,
                             Exponential exponential) {
  Workers workers(1);
  DrawList draws(scene, Lod::cut, Search::temporal, std::pmr::get_default_resource(), workers);
  draws.update(cut_query(input, 0, scene->origin), workers);
  const ProjectParams params =
      project_params(*scene, input.eyes[0].camera, {.exponential = exponential});
  const GaussianArrays arrays = gaussian_arrays(*scene);
  std::vector<Splat> splats;
  Splat splat;
  for (const DrawItem& cut_item : draws.items()) {
    const DrawItem item = drawn_item(cut_item, arrays.doubles);
    DrawnGaussian drawn;
    if (read_gaussian(params, arrays, item, drawn) && project(params, arrays, item, drawn, splat))
      splats.push_back(splat);
  }
  std::stable_sort(splats.begin(), splats.end(),
                   [](const Splat& a, const Splat& b) { return a.depth < b.depth; });
  return splats;
}

struct Buffers {
  std::vector<cpu::Pixel> pixels;
  std::vector<float> depth;
  bool operator==(const Buffers& other) const {
    return std::memcmp(pixels.data(), other.pixels.data(), pixels.size() * sizeof(cpu::Pixel)) ==
               0 &&
           std::memcmp(depth.data(), other.depth.data(), depth.size() * sizeof(float)) == 0;
  }
};

Buffers rasterize(cpu::RasterizeTile run, const std::vector<Splat>& splats,
                  const cpu::TileBins& bins, uint32_t width, uint32_t height, bool depth,
                  const DepthLimits& limits) {
  std::vector<float> lut(33);
  fill_alpha_lut(32, lut.data());
  Buffers out{std::vector<cpu::Pixel>(size_t{width} * height, {-1, -1, -1, -1}),
              std::vector<float>(size_t{width} * height, -1.0f)};
  const TileGrid grid = tile_grid(width, height);
  const cpu::RasterParams params{splats.data(),
                                 lut.data(),
                                 32 / kLutRange,
                                 width,
                                 height,
                                 out.pixels.data(),
                                 depth ? out.depth.data() : nullptr,
                                 limits};
  for (uint32_t row = 0; row < static_cast<uint32_t>(grid.rows); ++row)
    for (uint32_t column = 0; column < static_cast<uint32_t>(grid.columns); ++column)
      run(params,
          {column, row, bins.tile(size_t{row} * static_cast<size_t>(grid.columns) + column)});
  return out;
}

TEST(Backends, InstructionSetsAgreeToTheBit) {
  const auto scene = test::baked_scene(test::random_cloud(4000, 4, 1));
  Workers workers(1);
  const uint32_t width = 100, height = 55;
  std::vector<float> values(size_t{width} * height);
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 97) * 1e-3f;
  const DepthLimits reversed{values.data(), width * sizeof(float),
                             depth_encoding(DepthForm::reversed, 0.2, INFINITY)};
  for (const double tau : {0.0, 12.0})
    for (const Exponential e : {Exponential::exact, Exponential::ex2, Exponential::lut}) {
      const auto splats =
          splats_of(scene, frame_input(look({3, -6, -24}, {0, 0, 0}, width, height), tau), e);
      ASSERT_GT(splats.size(), 50u);
      std::vector<uint32_t> order(splats.size());
      for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
      for (const bool filter : {false, true}) {
        cpu::TileBins bins(std::pmr::get_default_resource());
        bins.build(splats.data(), order, tile_grid(width, height), filter, workers);
        for (const auto& [depth, limits] :
             {std::pair(false, DepthLimits{}), {true, DepthLimits{}}, {true, reversed}}) {
          const auto draw = [&, depth = depth, limits = limits](const cpu::NamedRasterizer& set) {
            return rasterize(set.pick(e, filter, depth, limits.values != nullptr), splats, bins,
                             width, height, depth, limits);
          };
          const auto sets = cpu::rasterizers();
          const Buffers expected = draw(sets.front());
          for (const cpu::NamedRasterizer& set : sets.subspan(1))
            EXPECT_TRUE(expected == draw(set)) << set.name << " filter " << filter;
        }
      }
    }
  std::string names;
  for (const cpu::NamedRasterizer& set : cpu::rasterizers()) names += std::string(set.name) + " ";
  RecordProperty("instruction_sets", names);
}

}  // namespace
}  // namespace voyager::backends_test
