// METHOD §7 at its edge: how far ρ - ρ_min in binary32 is from float64, and how many
// contribution tests fall to the other side for it.
#include "runtime/frame/draw_list.h"
#include "runtime/frame/project_params.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/reference/project.h"
#include "tests/numerics/footprints.h"
#include "tests/numerics/measured.h"
#include "tests/support/render_scene.h"

namespace voyager::threshold_test {
namespace {

using test::kEpsilon;

constexpr int kReach = 32;  // pixels from a splat's centre that are looked at

// Gaussians whose longest axis is about `pixels` wide, with ratios as a city has them.
std::shared_ptr<Scene> scene_of(int count, double pixels, const Camera& camera) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  auto scene = test::empty_scene();
  for (int i = 0; i < count; ++i) {
    const double z = std::pow(10, 1 + uniform(random)), size = pixels * z / camera.fx;
    const auto thinner = [&] {
      return static_cast<float>(size * std::pow(10, 3 * uniform(random) - 3));
    };
    const double x = z * 0.5 * camera.width / camera.fx * uniform(random);
    const double y = z * 0.5 * camera.height / camera.fy * uniform(random);
    const Vec3f scale{static_cast<float>(size), thinner(), thinner()};
    const auto opacity = static_cast<float>(std::pow(10, 1.2 * uniform(random) - 1));
    test::add_gaussian(*scene,
                       {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}, scale,
                       opacity, {1, 1, 1}, test::random_turn(random));
  }
  return scene;
}

struct Edge {
  double passed = 0, flipped = 0;
  double worst = 0, sum = 0, near = 0;  // of errors where ρ is within kNear of ρ_min
  static constexpr double kNear = 0.25;

  void note(double exact, double found) {  // both ρ - ρ_min
    passed += exact >= 0;
    flipped += (exact >= 0) != (found >= 0);
    if (std::fabs(exact) > kNear) return;
    const double error = std::fabs(found - exact);
    worst = std::max(worst, error), sum += error, ++near;
  }
};

// The kernels compare ρ with ρ_min; their difference is taken for the error's size.
void compare(const Splat& found, const reference::Splat& exact, Edge& edge) {
  const double left = std::floor(exact.x), top = std::floor(exact.y);
  for (double y = top - kReach; y < top + kReach; ++y)
    for (double x = left - kReach; x < left + kReach; ++x) {
      const double rho = test::exact_rho(exact.conic, x + 0.5 - exact.x, y + 0.5 - exact.y);
      if (rho < exact.rho_min - Edge::kNear) continue;
      const float dx = (static_cast<float>(x) + 0.5f) - found.x,
                  dy = (static_cast<float>(y) + 0.5f) - found.y;
      edge.note(rho - exact.rho_min,
                double{test::kernel_rho(found.conic, dx, dy)} - double{found.rho_min});
    }
}

Edge measure(uint32_t image, double pixels) {
  const Camera camera = test::look({0, 0, 0}, {0, 0, 1}, image, image, 90);
  const auto scene = scene_of(1000, pixels, camera);
  const PipelineDesc desc{.exponential = Exponential::exact, .antialias = Antialias::off};
  const ProjectParams params = project_params(*scene, camera, desc);
  const GaussianArrays arrays = gaussian_arrays(*scene);
  Edge edge;
  for (uint32_t i = 0; i < scene->gaussians.size(); ++i) {
    const DrawItem item{i, kNoNode, 1.0f, 1.0f};
    const auto exact = reference::project(*scene, camera, desc, {}, item);
    DrawnGaussian drawn;
    Splat splat;
    if (exact && read_gaussian(params, arrays, item, drawn) &&
        project(params, arrays, item, drawn, splat))
      compare(splat, *exact, edge);
  }
  return edge;
}

void record(const std::string& name, const Edge& edge) {
  test::record(name + "_worst", edge.worst);
  test::record(name + "_mean", edge.sum / edge.near);
  test::record(name + "_flipped_per_million", 1e6 * edge.flipped / edge.passed);
}

// The centre is rounded to ε of the image's width, three or four times over, and the low-pass
// is 0.55 pixels. ρ is even over an ellipse's area: an error e of either sign puts the pixels
// of a strip of e to the other side, wherever the threshold lies.
TEST(Threshold, AsManyTestsFlipAsTheErrorOfRhoTells) {
  double flipped = 0, expected = 0;
  for (const uint32_t image : {96u, 1920u, 8192u})
    for (const double pixels : {1.0, 10.0, 100.0, 1000.0, 1e4}) {
      const Edge edge = measure(image, pixels);
      const std::string name =
          std::to_string(image) + "_sigma_" + std::to_string(static_cast<int>(pixels));
      EXPECT_LE(edge.worst, 4.5 * kEpsilon * (image + kReach) / std::sqrt(kLowPass)) << name;
      flipped += edge.flipped, expected += edge.sum / (2 * Edge::kNear);
      record("image_" + name, edge);
    }
  EXPECT_GT(flipped, 10);  // or there is nothing to tell
  EXPECT_LE(flipped, 2 * expected);
  test::record("flipped", flipped);
  test::record("expected", expected);
}

}  // namespace
}  // namespace voyager::threshold_test
