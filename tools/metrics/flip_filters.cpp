#include "tools/metrics/flip_filters.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace voyager::tools {
namespace {

constexpr double kPi = std::numbers::pi;

// A contrast sensitivity is a sum of a·exp(−b f²) over frequencies f in cycles a degree; over
// degrees x that is a·√(π/b)·exp(−(πx)²/b).
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kLight = {1, 0.0047}, kRedGreen = {1, 0.0053};
constexpr std::array<Sensitivity, 2> kBlueYellow = {{{34.1, 0.04}, {13.5, 0.025}}};

template <class Function>
Kernel sampled(size_t radius, const Function& function) {
  Kernel kernel(2 * radius + 1);
  for (size_t i = 0; i < kernel.size(); ++i)
    kernel[i] = function(static_cast<double>(i) - static_cast<double>(radius));
  return kernel;
}

double sum(const Kernel& kernel) {
  return std::accumulate(kernel.begin(), kernel.end(), 0.0);
}

// Not yet normalised.
Kernel sensitivity_kernel(const Sensitivity& sensitivity, double pixels_per_degree) {
  // Three standard deviations of the widest serve for all.
  const double widest = std::sqrt(kBlueYellow[0].b / (2 * kPi * kPi)) * pixels_per_degree;
  return sampled(static_cast<size_t>(std::ceil(3 * widest)), [&](double pixels) {
    const double degrees = pixels / pixels_per_degree;
    return std::exp(-kPi * kPi * degrees * degrees / sensitivity.b);
  });
}

Kernel normalised(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += std::fabs(weight);
  for (double& weight : kernel) weight /= weight > 0 ? positive : negative > 0 ? negative : 1;
  return kernel;
}

// What one of Cz's Gaussians adds to the sum of weights of the two, over both axes.
double weight_of(const Sensitivity& sensitivity, const Kernel& kernel) {
  return sensitivity.a * std::sqrt(kPi / sensitivity.b) * sum(kernel) * sum(kernel);
}

}  // namespace

FlipFilters flip_filters(double pixels_per_degree) {
  FlipFilters filters;
  filters.light = normalised(sensitivity_kernel(kLight, pixels_per_degree));
  filters.red_green = normalised(sensitivity_kernel(kRedGreen, pixels_per_degree));
  std::array<double, 2> weights;
  for (size_t i = 0; i < 2; ++i) {
    const Kernel kernel = sensitivity_kernel(kBlueYellow[i], pixels_per_degree);
    weights[i] = weight_of(kBlueYellow[i], kernel);
    filters.blue_yellow[i] = normalised(kernel);
  }
  filters.blue_yellow_share = weights[0] / (weights[0] + weights[1]);

  // Edges that eyes see best are 0.082 degrees from peak to trough, two standard deviations.
  const double sigma = 0.5 * 0.082 * pixels_per_degree;
  const auto radius = static_cast<size_t>(std::ceil(3 * sigma));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  filters.smooth = normalised(sampled(radius, gaussian));
  filters.edge = normalised(sampled(radius, [&](double x) { return -x * gaussian(x); }));
  filters.point = normalised(
      sampled(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gaussian(x); }));
  return filters;
}

}  // namespace voyager::tools
