// FLIP against its formulas written down as the paper has them: two-dimensional filters, one sum
// a pixel, no sharing.
#include <gtest/gtest.h>

#include <functional>

#include "tests/support/metric_images.h"
#include "tools/metrics/flip.h"

namespace voyager::tools {
namespace flip_formulas_test {
namespace {

using Vector = std::array<double, 3>;
using Field = std::function<double(int x, int y)>;

struct Size {
  int width, height;
};

constexpr double kPi = std::numbers::pi;
constexpr Vector kWhite = {0.950428545, 1, 1.088900371};  // XYZ of D65

Vector xyz_of_linear(const Vector& c) {
  return {(10135552 * c[0] + 8788810 * c[1] + 4435075 * c[2]) / 24577794,
          (2613072 * c[0] + 8788810 * c[1] + 887015 * c[2]) / 12288897,
          (1425312 * c[0] + 8788810 * c[1] + 70074185 * c[2]) / 73733382};
}

Vector ycxcz(const RgbaImage& image, size_t pixel) {
  Vector c;
  for (size_t k = 0; k < 3; ++k) {
    const double value = image[4 * pixel + k];
    c[k] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  const Vector xyz = xyz_of_linear(c);
  const double y = xyz[1] / kWhite[1];
  return {116 * y - 16, 500 * (xyz[0] / kWhite[0] - y), 200 * (y - xyz[2] / kWhite[2])};
}

Vector hunt(const Vector& linear) {
  const Vector xyz = xyz_of_linear(linear);
  Vector f;
  for (size_t k = 0; k < 3; ++k) {
    const double t = xyz[k] / kWhite[k];
    f[k] = t > 216. / 24389 ? std::cbrt(t) : 841. / 108 * t + 4. / 29;
  }
  const double l = 116 * f[1] - 16;
  return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

Vector hunt_of_ycxcz(const Vector& c) {
  const double y = (c[0] + 16) / 116;
  const double x = kWhite[0] * (y + c[1] / 500), z = kWhite[2] * (y - c[2] / 200);
  // Printed to nine digits with the authors' programs.
  const Vector linear = {3.241003275 * x - 1.537398934 * y - 0.498615861 * z,
                         -0.969224334 * x + 1.875930071 * y + 0.041554224 * z,
                         0.055639423 * x - 0.204011202 * y + 1.057148933 * z};
  return hunt({std::clamp(linear[0], 0.0, 1.0), std::clamp(linear[1], 0.0, 1.0),
               std::clamp(linear[2], 0.0, 1.0)});
}

double hyab_distance(const Vector& a, const Vector& b) {
  return std::abs(a[0] - b[0]) +
         std::sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

// Positive weights are divided by their sum, negative ones by theirs.
double filtered(const Field& field, const Field& weight, int radius, int x, int y) {
  double sums[2] = {0, 0}, weights[2] = {0, 0};
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i) {
      const double w = weight(i, j);
      sums[w < 0] += w * field(x + i, y + j);
      weights[w < 0] += std::abs(w);
    }
  return sums[0] / weights[0] + (weights[1] > 0 ? sums[1] / weights[1] : 0);
}

class Naive {
 public:
  Naive(const RgbaImage& image, Size size, double ppd) : image_(image), size_(size), ppd_(ppd) {}

  Vector colour(int x, int y) const {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd_));
    const double a[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}};
    const double b[3][2] = {{0.0047, 1}, {0.0053, 1}, {0.04, 0.025}};
    Vector mean;
    for (size_t k = 0; k < 3; ++k) {
      const auto weight = [&](int i, int j) {
        double sum = 0;
        for (size_t n = 0; n < 2; ++n)
          sum += a[k][n] * std::sqrt(kPi / b[k][n]) *
                 std::exp(-kPi * kPi * (i * i + j * j) / (ppd_ * ppd_) / b[k][n]);
        return sum;
      };
      mean[k] = filtered([&](int i, int j) { return at(i, j)[k]; }, weight, radius, x, y);
    }
    return hunt_of_ycxcz(mean);
  }

  double feature(bool point, int x, int y) const {
    const double sigma = 0.5 * 0.082 * ppd_;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto derivative = [&](int i, int j) {
      const double gaussian = std::exp(-(i * i + j * j) / (2 * sigma * sigma));
      return gaussian * (point ? i * i / (sigma * sigma) - 1 : -i);
    };
    const auto light = [&](int i, int j) { return (at(i, j)[0] + 16) / 116; };
    const double dx = filtered(light, derivative, radius, x, y);
    const double dy = filtered(
        light, [&](int i, int j) { return derivative(j, i); }, radius, x, y);
    return std::sqrt(dx * dx + dy * dy);
  }

 private:
  Vector at(int x, int y) const {
    const int row = std::clamp(y, 0, size_.height - 1), column = std::clamp(x, 0, size_.width - 1);
    return ycxcz(image_, static_cast<size_t>(row * size_.width + column));
  }

  const RgbaImage& image_;
  Size size_;
  double ppd_;
};

double naive_error(const Naive& a, const Naive& b, int x, int y) {
  const double largest = std::pow(hyab_distance(hunt({0, 1, 0}), hunt({0, 0, 1})), 0.7);
  const double distance = std::pow(hyab_distance(a.colour(x, y), b.colour(x, y)), 0.7);
  const double knee = 0.4 * largest;
  const double colours = distance < knee ? 0.95 / knee * distance
                                         : 0.95 + (distance - knee) / (largest - knee) * (1 - 0.95);
  const double features =
      std::pow(std::max(std::abs(a.feature(false, x, y) - b.feature(false, x, y)),
                        std::abs(a.feature(true, x, y) - b.feature(true, x, y))) /
                   std::sqrt(2.0),
               0.5);
  return std::pow(colours, 1 - features);
}

void expect_as_written_down(const RgbaImage& a, const RgbaImage& b, Size size, double ppd) {
  const Flip fast = flip(a, b, static_cast<size_t>(size.width), ppd);
  const Naive naive_a(a, size, ppd), naive_b(b, size, ppd);
  double sum = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const double expected = naive_error(naive_a, naive_b, x, y);
      EXPECT_NEAR(fast.map[static_cast<size_t>(y * size.width + x)], expected, 1e-6)
          << x << ' ' << y << " at " << ppd;
      sum += expected;
    }
  EXPECT_NEAR(fast.mean, sum / (size.width * size.height), 1e-6);
}

TEST(FlipFormulas, AreWhatIsComputed) {
  for (const Size size : {Size{1, 1}, Size{3, 19}, Size{17, 12}}) {
    const auto pixels = static_cast<size_t>(size.width * size.height);
    const RgbaImage a = test::random_image(pixels, 1), b = test::random_image(pixels, 2);
    expect_as_written_down(a, test::mixed(a, b, 0.1f), size, kFlipPixelsPerDegree);
    expect_as_written_down(a, b, size, 23.5);
  }
}

// Colours whose blur leaves what sRGB can show, and errors beyond the knee.
TEST(FlipFormulas, HoldForSaturatedColours) {
  constexpr Size size = {14, 9};
  RgbaImage a = test::constant_image(size.width * size.height, {0, 1, 0}), b = a;
  for (size_t pixel = 0; 4 * pixel < b.size(); pixel += 3) b[4 * pixel + 2] = 1;
  for (size_t pixel = 0; 4 * pixel < b.size(); pixel += 2) b[4 * pixel + 1] = 0;
  expect_as_written_down(a, b, size, 40);
}

}  // namespace
}  // namespace flip_formulas_test
}  // namespace voyager::tools
