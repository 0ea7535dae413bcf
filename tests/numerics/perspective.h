#pragma once
// What a camera sees of a Gaussian without METHOD §5's linearisation: along each ray the
// density's integral, relative to the ray through the mean.
#include <cmath>

#include "runtime/math/projection.h"

namespace voyager::test {

// In view space: x right, y down, z forward.
struct Cloudlet {
  Vec3d mean;
  Quatd rotation;
  Vec3d scale;
};

// A, B, C of exponent -½(A·t² - 2B·t + C) at a distance t along `ray`.
struct AlongRay {
  double a, b, c;
};
inline AlongRay along(const Cloudlet& g, const Vec3d& ray) {
  const Mat3d r = rotation(g.rotation);
  AlongRay q{};
  for (int k = 0; k < 3; ++k) {
    const Vec3d axis{r.row[0][k], r.row[1][k], r.row[2][k]};
    const double u = dot(axis, ray) / g.scale[k], m = dot(axis, g.mean) / g.scale[k];
    q.a += u * u, q.b += u * m, q.c += m * m;
  }
  return q;
}

// ∫ exp along the unit vector of `slope` by Simpson's rule, eight standard deviations each way
// but not behind the camera.
inline double density_integral(const Cloudlet& g, const Vec3d& slope) {
  const AlongRay q = along(g, (1 / std::sqrt(dot(slope, slope))) * slope);
  const double middle = q.b / q.a, reach = 8 / std::sqrt(q.a);
  const double low = std::fmax(0, middle - reach), high = std::fmax(low, middle + reach);
  constexpr int kSteps = 128;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = low + (high - low) * i / kSteps;
    const double weight = i == 0 || i == kSteps ? 1 : (i % 2 ? 4 : 2);
    sum += weight * std::exp(-0.5 * ((q.a * t - 2 * q.b) * t + q.c));
  }
  return sum * (high - low) / (3 * kSteps);
}

// The same over a whole line: √(2π/A)·exp(-½(C - B²/A)).
inline double line_integral(const Cloudlet& g, const Vec3d& slope) {
  const AlongRay q = along(g, (1 / std::sqrt(dot(slope, slope))) * slope);
  return std::sqrt(2 * 3.14159265358979323846 / q.a) * std::exp(-0.5 * (q.c - q.b * q.b / q.a));
}

}  // namespace voyager::test
