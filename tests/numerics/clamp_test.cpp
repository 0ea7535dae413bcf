// METHOD §5's Jacobian, with its clamp and without, against the image of a Gaussian that is
// integrated along every ray: what the fan of splats from beyond the frustum is off by.
#include <algorithm>
#include <limits>
#include <random>

#include "tests/numerics/measured.h"
#include "tests/numerics/perspective.h"

namespace voyager::clamp_test {
namespace {

using test::Cloudlet;

constexpr double kFocal = 640, kImage = 1280;  // 90°; σ is tens of pixels: no low-pass to speak of
constexpr int kStep = 40, kAround = 8;
constexpr double kDegree = 3.14159265358979323846 / 180;

ViewProjection<double> camera(bool clamped) {
  auto v = view_projection<double>({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, kFocal, kFocal, kImage / 2,
                                   kImage / 2, kImage, kImage);
  const double infinity = std::numeric_limits<double>::infinity();
  if (!clamped) v.x_low = v.y_low = -infinity, v.x_high = v.y_high = infinity;
  return v;
}

ImageCovariance<double> covariance(const Cloudlet& g, bool clamped) {
  return image_covariance(image_jacobian(camera(clamped), g.mean), g.rotation, g.scale, kLowPass);
}

// A metre away, so that its size is the angle it is seen under.
Cloudlet cloudlet(std::mt19937& random, double size, double ratio, double degrees, int turn) {
  std::normal_distribution<double> normal;
  const double away = degrees * kDegree, around = 2 * 180 * kDegree * turn / kAround;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return {{std::sin(away) * std::cos(around), std::sin(away) * std::sin(around), std::cos(away)},
          normalise(Quatd{w, x, y, z}),
          {size, size / ratio, size / ratio}};
}

struct Fan {
  double clamped = 0, unclamped = 0;  // |α - α of the integral|, the mean over the image
  double clamped_worst = 0, unclamped_worst = 0;
  double turned = 0;  // degrees between the two's long axes, the mean
};

double alpha(const ImageCovariance<double>& c, double dx, double dy) {
  const Conic<double> k = conic(c, 0.5);
  const double p = dx * k.p_x, q = (dy - k.skew * dx) * k.q_y;
  return std::exp(-(p * p + q * q));
}

double angle_between(const ImageCovariance<double>& a, const ImageCovariance<double>& b) {
  const auto axis = [](const auto& c) { return 0.5 * std::atan2(2 * c.xy, c.xx - c.yy); };
  const double turn = std::fabs(axis(a) - axis(b)) / kDegree;
  return std::min(turn, 180 - turn);
}

void compare(const Cloudlet& g, Fan& fan) {
  const ImageCovariance<double> with = covariance(g, true), without = covariance(g, false);
  const double slope_x = g.mean.x / g.mean.z, slope_y = g.mean.y / g.mean.z;
  const double peak = test::density_integral(g, {slope_x, slope_y, 1});
  double clamped = 0, unclamped = 0, pixels = 0;
  for (double y = 0.5 * kStep; y < kImage; y += kStep)
    for (double x = 0.5 * kStep; x < kImage; x += kStep) {
      const double ray_x = (x - kImage / 2) / kFocal, ray_y = (y - kImage / 2) / kFocal;
      const double truth = test::density_integral(g, {ray_x, ray_y, 1}) / peak;
      const double dx = kFocal * (ray_x - slope_x), dy = kFocal * (ray_y - slope_y);
      const double a = std::fabs(alpha(with, dx, dy) - truth),
                   b = std::fabs(alpha(without, dx, dy) - truth);
      clamped += a, unclamped += b, ++pixels;
      fan.clamped_worst = std::max(fan.clamped_worst, a);
      fan.unclamped_worst = std::max(fan.unclamped_worst, b);
    }
  fan.clamped += clamped / pixels / kAround, fan.unclamped += unclamped / pixels / kAround;
  fan.turned += angle_between(with, without) / kAround;
}

Fan measure(double size, double ratio, double degrees) {
  std::mt19937 random(3);
  Fan fan;
  for (int turn = 0; turn < kAround; ++turn)
    compare(cloudlet(random, size, ratio, degrees, turn), fan);
  return fan;
}

void record(const std::string& name, const Fan& fan) {
  test::record(name + "_clamped", fan.clamped);
  test::record(name + "_unclamped", fan.unclamped);
  test::record(name + "_clamped_worst", fan.clamped_worst);
  test::record(name + "_unclamped_worst", fan.unclamped_worst);
  test::record(name + "_turned", fan.turned);
}

TEST(Clamp, TheIntegralIsThatOfAGaussianAlongALine) {
  std::mt19937 random(1);
  for (const double degrees : {0.0, 40.0, 80.0})
    for (int turn = 0; turn < kAround; ++turn) {
      const Cloudlet g = cloudlet(random, 0.1, 10, degrees, turn);
      for (const double off : {0.0, 0.02, -0.05}) {
        const Vec3d ray{g.mean.x / g.mean.z + off, g.mean.y / g.mean.z - off, 1};
        const double whole = test::line_integral(g, ray);
        EXPECT_NEAR(test::density_integral(g, ray), whole, 1e-9 * whole);
      }
    }
}

// Within the frustum grown by 30 % (52° here, along a side) the two are the same. Beyond it the
// Jacobian alone covers the whole image with what is not there; with the clamp a Gaussian of up
// to a tenth of its distance fades, and a larger one stays within the bound of its size.
TEST(Clamp, KeepsTheFanSmallerThanTheJacobianAloneWould) {
  struct {
    double size, ratio, bound;
  } const cases[] = {{0.05, 1, 1.2e-3},  {0.1, 1, 9e-3},  {0.2, 1, 0.085},   {0.4, 1, 0.53},
                     {0.05, 10, 6.2e-5}, {0.1, 10, 5e-4}, {0.2, 10, 4.7e-3}, {0.4, 10, 0.04}};
  for (const auto& c : cases)
    for (const double degrees : {0, 20, 40, 50, 55, 60, 65, 70, 75, 80, 85, 88}) {
      const Fan fan = measure(c.size, c.ratio, degrees);
      const std::string name = "size_" + std::to_string(c.size).substr(0, 4) + "_ratio_" +
                               std::to_string(static_cast<int>(c.ratio)) + "_at_" +
                               std::to_string(static_cast<int>(degrees));
      EXPECT_LE(fan.clamped, c.bound) << name;
      EXPECT_LE(fan.clamped, fan.unclamped) << name;
      if (degrees <= 50) {
        EXPECT_EQ(fan.clamped, fan.unclamped) << name;
        EXPECT_EQ(fan.turned, 0) << name;
      }
      if (degrees >= 80 && c.size <= 0.1) {
        EXPECT_LE(fan.clamped_worst, 3e-3) << name;
      }
      if (degrees == 88) {
        EXPECT_GE(fan.unclamped, 0.07) << name;
      }
      record(name, fan);
    }
}

}  // namespace
}  // namespace voyager::clamp_test
