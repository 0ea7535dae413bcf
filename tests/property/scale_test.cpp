// METHOD §12: from afar nothing is lost under α*, from close by nothing thins out.
#include "runtime/frame/draw_list.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/project_params.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/scene/append.h"
#include "tests/support/render_scene.h"
#include "tools/synth/city.h"

namespace voyager::scale_test {
namespace {

using test::frame_input;
using test::look;

std::shared_ptr<const Scene> city() {
  GaussianCloud all;
  all.sh_degree = 0;
  synth::generate_city(
      {.gaussians = 10000, .seed = 5, .sh_degree = 0},
      [&](const GaussianCloud& part) { append(all, GaussianCloud(part), "city"); });
  return test::baked_scene(all);
}

struct Counts {
  size_t drawn = 0, lost = 0;  // lost: only because what the pixel filter leaves is under α*
};

Counts count(const std::shared_ptr<const Scene>& scene, const Camera& camera, double tau, Lod lod) {
  Workers workers;
  DrawList list(scene, lod, Search::streaming, std::pmr::get_default_resource(), workers);
  list.update(cut_query(frame_input(camera, tau), 0, scene->origin), workers);
  const ProjectParams params = project_params(*scene, camera, {});
  // With the filter's width and all of the opacity: what reaches the image, o ≥ α*.
  ProjectParams whole = params;
  whole.filter.compensated = false;
  Counts counts;
  const GaussianArrays arrays = gaussian_arrays(*scene);
  for (const DrawItem& item : list.items()) {
    DrawnGaussian drawn;
    Splat splat;
    Vec3f relative;
    if (!read_gaussian(params, arrays, item, drawn)) continue;
    if (!project_shape(whole, item, drawn, splat, relative)) continue;
    ++(project_shape(params, item, drawn, splat, relative) ? counts.drawn : counts.lost);
  }
  return counts;
}

TEST(Scale, FromAfarACutLosesNothingUnderTheThresholdThatLeavesLose) {
  const auto scene = city();
  const Camera camera = look({33, -900, -1400}, {33, 0, 33}, 240, 136, 68);
  const Counts leaves = count(scene, camera, 3, Lod::all_leaves);
  EXPECT_GT(leaves.lost, leaves.drawn / 50);
  for (const double tau : {3.0, 0.5}) {
    const Counts cut = count(scene, camera, tau, Lod::cut);
    EXPECT_GT(cut.drawn, 300u);
    EXPECT_LE(cut.lost, cut.drawn / 1000) << tau;
  }
}

// Discs on a plane, one a native pixel and smaller than it, as training leaves them where 3DGS's
// filter closes the gaps.
std::shared_ptr<Scene> wall(double pixel) {
  auto scene = test::empty_scene();
  const auto side = static_cast<float>(0.3 * pixel);
  for (int y = -40; y <= 40; ++y)
    for (int x = -40; x <= 40; ++x)
      test::add_gaussian(*scene,
                         {static_cast<float>(x * pixel), static_cast<float>(y * pixel), 0.0f},
                         {side, side, 1e-6f}, 0.9f);
  scene->native = {NativeSource::given, pixel, kPixelVariance};
  return scene;
}

float least_alpha(const std::shared_ptr<const Scene>& scene, double magnified,
                  Antialias antialias) {
  constexpr uint32_t kSide = 48;
  constexpr double kDistance = 10;
  Camera camera = look({0, 0, -kDistance}, {0, 0, 0}, kSide, kSide);
  camera.fx = camera.fy = magnified * kDistance / scene->native.pixel;
  const auto cpu = create_cpu_backend();
  const test::Frame frame = test::render(
      *cpu, scene, {.lod = Lod::all_leaves, .antialias = antialias}, frame_input(camera));
  float least = 1;
  for (size_t i = 3; i < frame.rgba.size(); i += 4) least = std::min(least, frame.rgba[i]);
  return least;
}

TEST(Scale, CloserThanNativeASurfaceStaysClosed) {
  const auto scene = wall(0.05);
  const float native = least_alpha(scene, 1, Antialias::on);
  EXPECT_GT(native, 0.85f);
  for (const double magnified : {2.0, 4.0, 8.0}) {
    EXPECT_GT(least_alpha(scene, magnified, Antialias::on), native - 0.02f) << magnified;
  }
  // 3DGS's filter leaves holes.
  EXPECT_LT(least_alpha(scene, 8, Antialias::off), 0.3f);
}

}  // namespace
}  // namespace voyager::scale_test
