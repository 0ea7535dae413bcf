// The adjoints of runtime/stages against central differences, in binary64: of a loss over a small
// picture by every number of every Gaussian.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "runtime/stages/blend_gradient.h"

namespace voyager::splat_gradient_test {
namespace {

constexpr int kWidth = 14, kHeight = 11, kDegree = 3;
constexpr int kCoefficients = 3 * sh_coefficients(kDegree);
constexpr double kLogScale = 1.4426950408889634;  // a base-2 conic: the general case

// mean, scale, rotation, log opacity, coefficients
constexpr int kNumbers = 3 + 3 + 4 + 1 + kCoefficients;
using Numbers = std::array<double, kNumbers>;

struct Blended {
  std::vector<Numbers> gaussians;                // front to back
  std::vector<std::pair<double, double>> blend;  // t and 1/k of each
};

struct Projected {
  detail::SplatShape<double> shape;
  double log_opacity;
  Vec3d colour;
};

ViewProjection<double> view() {
  return view_projection<double>({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 20, 22, 0.5 * kWidth,
                                 0.5 * kHeight, kWidth, kHeight);
}
const PixelFilter<double> kFilter{kPixelVariance, 0.002, true};

Vec3d mean_of(const Numbers& n) {
  return {n[0], n[1], n[2]};
}
Shape<double> shape_of(const Numbers& n) {
  return {{n[3], n[4], n[5]}, {n[6], n[7], n[8], n[9]}, std::exp(n[10]), n[10]};
}
auto sh_of(const Numbers& n) {
  return [&n](int k, int channel) { return n[static_cast<size_t>(11 + 3 * k + channel)]; };
}

Projected projected(const Numbers& n) {
  const Vec3d mean = mean_of(n);
  const Shape<double> shape = shape_of(n);
  const auto splat = detail::splat_shape(view(), kFilter, 0.5 * kLogScale, mean, shape.scale,
                                         normalise(shape.rotation));
  const double length = std::sqrt(dot(mean, mean));
  return {splat, shape.log_opacity + splat.log_kept,
          sh_colour(kDegree, (1 / length) * mean, sh_of(n))};
}

// α as blended, its slope by ln α, and p and q.
struct Alpha {
  double alpha, slope, p, q;
};
Alpha alpha_at(const Projected& s, double t, double inverse_k, int x, int y) {
  const double dx = x + 0.5 - s.shape.x, dy = y + 0.5 - s.shape.y;
  const auto& c = s.shape.conic;
  const double p = dx * c.p_x, q = (dy - c.skew * dx) * c.q_y;
  const double plain = std::exp(s.log_opacity - (p * p + q * q) / kLogScale);
  const double alpha = std::min(plain, double{kAlphaMax});
  const double slope =
      plain < double{kAlphaMax} ? alpha * sibling_alpha_slope(alpha, t, inverse_k) : 0;
  return {sibling_alpha(alpha, t, inverse_k), slope, p, q};
}

struct Pixel {
  Vec3d colour{0, 0, 0};
  double transmittance = 1;
};
Pixel drawn(const Blended& scene, const std::vector<Projected>& splats, int x, int y) {
  Pixel pixel;
  for (size_t i = 0; i < splats.size(); ++i) {
    const auto [t, inverse_k] = scene.blend[i];
    const double alpha = alpha_at(splats[i], t, inverse_k, x, y).alpha;
    const double after = pixel.transmittance * (1 - alpha);
    if (after < double{kTransmittanceEnd}) break;
    pixel.colour = pixel.colour + (alpha * pixel.transmittance) * splats[i].colour;
    pixel.transmittance = after;
  }
  return pixel;
}

// What the picture is compared with.
Vec3d wanted(int x, int y) {
  return {0.1 + 0.05 * x, 0.7 - 0.03 * y, 0.4 + 0.01 * (x + y)};
}
constexpr double kAlphaWeight = 0.3;

double loss(const Blended& scene) {
  std::vector<Projected> splats;
  for (const Numbers& n : scene.gaussians) splats.push_back(projected(n));
  double sum = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Pixel pixel = drawn(scene, splats, x, y);
      const Vec3d off = pixel.colour - wanted(x, y);
      const double alpha = 1 - pixel.transmittance - 0.8;
      sum += dot(off, off) + kAlphaWeight * alpha * alpha;
    }
  return sum;
}

std::vector<SplatSums<double>> sums_of(const Blended& scene, const std::vector<Projected>& splats) {
  std::vector<SplatSums<double>> sums(splats.size());
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Pixel pixel = drawn(scene, splats, x, y);
      PixelAdjoint<double> adjoint(pixel.colour, pixel.transmittance,
                                   2.0 * (pixel.colour - wanted(x, y)),
                                   2 * kAlphaWeight * (1 - pixel.transmittance - 0.8));
      for (size_t i = 0; i < splats.size(); ++i) {
        const auto [t, inverse_k] = scene.blend[i];
        const Alpha a = alpha_at(splats[i], t, inverse_k, x, y);
        PixelShare<double> share;
        if (!blend_adjoint(a.alpha, a.slope, splats[i].colour, adjoint, share)) break;
        SplatSums<double>& s = sums[i];
        s.g += share.g, s.gp += share.g * a.p, s.gq += share.g * a.q;
        s.gpp += share.g * a.p * a.p, s.gpq += share.g * a.p * a.q;
        s.gqq += share.g * a.q * a.q;
        s.colour = s.colour + share.weight * adjoint.by_colour;
      }
    }
  return sums;
}

std::vector<Numbers> gradient(const Blended& scene) {
  std::vector<Projected> splats;
  for (const Numbers& n : scene.gaussians) splats.push_back(projected(n));
  const auto sums = sums_of(scene, splats);
  std::vector<Numbers> all;
  for (size_t i = 0; i < splats.size(); ++i) {
    const Numbers& n = scene.gaussians[i];
    const auto g = shape_gradient(view(), kFilter, kLogScale, mean_of(n), shape_of(n), sums[i]);
    Numbers by{};
    const Vec3d through_colour =
        colour_gradient(kDegree, mean_of(n), splats[i].colour, sums[i].colour, sh_of(n),
                        [&](int k, int channel, double change) {
                          by[static_cast<size_t>(11 + 3 * k + channel)] = change;
                        });
    const Vec3d mean = g.mean + through_colour;
    const double numbers[] = {mean.x,       mean.y,       mean.z,       g.scale.x,
                              g.scale.y,    g.scale.z,    g.rotation.w, g.rotation.x,
                              g.rotation.y, g.rotation.z, g.log_opacity};
    std::copy(std::begin(numbers), std::end(numbers), by.begin());
    all.push_back(by);
  }
  return all;
}

Blended random_scene(uint32_t seed) {
  std::mt19937 random(seed);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Blended scene;
  for (int i = 0; i < 5; ++i) {
    Numbers n{};
    n[2] = 4 + i;
    n[0] = within(-1, 1), n[1] = within(-1, 1);
    for (size_t k = 3; k < 6; ++k) n[k] = std::exp(within(-4, 0));
    for (size_t k = 6; k < 10; ++k) n[k] = within(-1, 1);
    n[10] = std::log(within(0.2, 0.95));
    for (size_t k = 11; k < n.size(); ++k) n[k] = within(-0.4, 0.4);
    scene.gaussians.push_back(n);
    scene.blend.emplace_back(i == 2 ? 0.6 : 1.0, i == 2 ? 1.0 / 3 : 1.0);
  }
  return scene;
}

class SplatGradient : public testing::TestWithParam<uint32_t> {};

TEST_P(SplatGradient, IsThatOfCentralDifferences) {
  Blended scene = random_scene(GetParam());
  const std::vector<Numbers> found = gradient(scene);
  for (size_t i = 0; i < found.size(); ++i)
    for (size_t k = 0; k < found[i].size(); ++k) {
      double& number = scene.gaussians[i][k];
      const double at = number, step = 1e-5 * std::max(std::fabs(at), 0.05);
      number = at + step;
      const double above = loss(scene);
      number = at - step;
      const double below = loss(scene);
      number = at;
      const double expected = (above - below) / (2 * step);
      EXPECT_NEAR(found[i][k], expected, 1e-6 * std::max(1.0, std::fabs(expected)))
          << "Gaussian " << i << ", number " << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SplatGradient, testing::Range(1u, 6u));

}  // namespace
}  // namespace voyager::splat_gradient_test
