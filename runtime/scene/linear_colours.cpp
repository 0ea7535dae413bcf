#include "runtime/scene/linear_colours.h"

#include <algorithm>
#include <array>

#include "runtime/math/sphere_samples.h"
#include "runtime/math/srgb.h"

namespace voyager {
namespace {

struct Sample {
  double weight;
  std::array<double, 16> basis;
};

std::array<Sample, kSphereSamples> basis_samples() {
  std::array<Sample, kSphereSamples> samples{};
  for (int i = 0; i < kSphereSamples; ++i) {
    Sample& sample = samples[static_cast<size_t>(i)];
    sample.weight = sphere_sample(i).weight;
    sh_basis(kMaxShDegree, sphere_sample(i).direction, sample.basis.data());
  }
  return samples;
}

void encode_constant(float& coefficient) {
  const double linear = std::max(0.0, 0.5 + kSh0 * static_cast<double>(coefficient));
  coefficient = static_cast<float>((encode_srgb(linear) - 0.5) / kSh0);
}

// One channel: coefficient k is at sh[3 * k].
void encode_channel(const std::array<Sample, kSphereSamples>& samples, int count, float* sh) {
  std::array<double, 16> encoded{};
  for (const Sample& sample : samples) {
    double linear = 0.5;
    for (int k = 0; k < count; ++k)
      linear += sample.basis[static_cast<size_t>(k)] * static_cast<double>(sh[3 * k]);
    const double code = encode_srgb(std::max(0.0, linear)) - 0.5;
    for (size_t k = 0; k < encoded.size(); ++k)
      encoded[k] += sample.weight * sample.basis[k] * code;
  }
  for (int k = 0; k < count; ++k) sh[3 * k] = static_cast<float>(encoded[static_cast<size_t>(k)]);
}

bool is_finite(const float* sh, int count) {
  for (int k = 0; k < count; ++k)
    if (!std::isfinite(sh[3 * k])) return false;
  return true;
}

}  // namespace

void encode_colours(GaussianCloud& cloud) {
  const auto samples = basis_samples();
  const int count = cloud.coefficients();
  for (size_t i = 0; i < cloud.size(); ++i)
    for (size_t channel = 0; channel < 3; ++channel) {
      float* sh = cloud.sh.data() + i * static_cast<size_t>(count) * 3 + channel;
      if (!is_finite(sh, count)) continue;  // sanitise() mends and counts it
      if (count == 1)
        encode_constant(*sh);
      else
        encode_channel(samples, count, sh);
    }
}

}  // namespace voyager
