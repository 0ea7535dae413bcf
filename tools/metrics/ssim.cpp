#include "tools/metrics/ssim.h"

#include <fmt/core.h>

#include "runtime/base/error.h"

namespace voyager::tools {
namespace {

Kernel window() {
  constexpr double sigma = 1.5;
  Kernel weights(kSsimWindow);
  double sum = 0;
  for (size_t i = 0; i < kSsimWindow; ++i) {
    const double x = static_cast<double>(i) - (kSsimWindow - 1) / 2.0;
    sum += weights[i] = std::exp(-x * x / (2 * sigma * sigma));
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

Plane mean_of_product(const Plane& a, const Plane& b, const Kernel& weights) {
  Plane product = a;
  for (size_t i = 0; i < product.values.size(); ++i) product.values[i] *= b.values[i];
  return filter(product, weights);
}

// Sum over the windows inside.
double similarity(const Plane& x, const Plane& y) {
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;  // (K·L)², L = 1
  const Kernel weights = window();
  const Plane mean_x = filter(x, weights), mean_y = filter(y, weights);
  const Plane mean_xx = mean_of_product(x, x, weights), mean_yy = mean_of_product(y, y, weights),
              mean_xy = mean_of_product(x, y, weights);
  double sum = 0;
  constexpr size_t radius = kSsimWindow / 2;
  for (size_t row = radius; row + radius < x.height(); ++row)
    for (size_t i = row * x.width + radius; i + radius < (row + 1) * x.width; ++i) {
      const double mx = mean_x.values[i], my = mean_y.values[i];
      const double var_x = mean_xx.values[i] - mx * mx, var_y = mean_yy.values[i] - my * my;
      const double covariance = mean_xy.values[i] - mx * my;
      sum += (2 * mx * my + c1) * (2 * covariance + c2) /
             ((mx * mx + my * my + c1) * (var_x + var_y + c2));
    }
  return sum;
}

}  // namespace

double ssim(const RgbaImage& image, const RgbaImage& expected, size_t width) {
  const size_t height = image.size() / 4 / width;
  if (width < kSsimWindow || height < kSsimWindow)
    throw Error(ErrorCode::unsupported,
                fmt::format("SSIM: found an image of {} x {} pixels, expected {} x {} or more",
                            width, height, kSsimWindow, kSsimWindow));
  const ScreenPair pair = screen_pair(image, expected, width);
  double sum = 0;
  for (size_t channel = 0; channel < 3; ++channel)
    sum += similarity(pair.image[channel], pair.expected[channel]);
  const size_t windows = (width - kSsimWindow + 1) * (height - kSsimWindow + 1);
  return sum / static_cast<double>(3 * windows);
}

}  // namespace voyager::tools
