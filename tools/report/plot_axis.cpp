#include "tools/report/plot_axis.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace voyager::tools {
namespace {

// 1, 2 or 5 times a power of ten, so that there are about five of them.
double round_step(double range) {
  const double power = std::pow(10, std::floor(std::log10(range / 5)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (range / (factor * power) <= 6) return factor * power;
  return 10 * power;
}

// That tell one step from the next; not fewer than four.
int digits(double low, double high, double step) {
  const double steps = std::max(std::fabs(low), std::fabs(high)) / step;
  return std::max(4, static_cast<int>(std::ceil(std::log10(steps))) + 1);
}

}  // namespace

PlotAxis::PlotAxis(const std::vector<double>& values, bool logarithmic)
    : logarithmic_(logarithmic) {
  bool first = true;
  for (const double value : values) {
    const double x = scaled(value);
    least_ = first ? x : std::min(least_, x);
    most_ = first ? x : std::max(most_, x);
    first = false;
  }
  // Of values that are nearly the same a range in which steps can be told from one another.
  const double narrowest = 1e-9 * std::max(std::fabs(least_), std::fabs(most_));
  const double margin = std::max(most_ > least_ ? 0.06 * (most_ - least_) : 0.5, narrowest);
  least_ -= margin;
  most_ += margin;
}

double PlotAxis::scaled(double value) const {
  return logarithmic_ ? std::log10(value) : value;
}

double PlotAxis::at(double value) const {
  return (scaled(value) - least_) / (most_ - least_);
}

std::vector<PlotAxis::Tick> PlotAxis::ticks() const {
  std::vector<Tick> found;
  const double range = most_ - least_;
  if (!logarithmic_ || range < 0.6) {
    const double low = logarithmic_ ? std::pow(10, least_) : least_;
    const double high = logarithmic_ ? std::pow(10, most_) : most_;
    const double step = round_step(high - low);
    const double first = std::ceil(low / step);
    const auto count = static_cast<int>(std::floor(high / step) - first) + 1;
    for (int k = 0; k < count; ++k) {
      const double value = (first + k) * step;
      if (!logarithmic_ || value > 0)
        found.push_back({at(value), fmt::format("{:.{}g}", value + 0.0, digits(low, high, step))});
    }
    return found;
  }
  for (double power = std::floor(least_); power <= most_; ++power)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10, power), x = std::log10(value);
      if (x >= least_ && x <= most_ && (factor == 1.0 || range < 3))
        found.push_back({at(value), fmt::format("{:.4g}", value)});
    }
  return found;
}

}  // namespace voyager::tools
