#pragma once
// Gaussians of a given size and axis ratio in the image, seen by a camera in any direction.
#include <cmath>
#include <random>

#include "runtime/math/projection.h"

namespace voyager::test {

inline constexpr double kLargestImage = 8192;

enum class Build { needle, disc, edge };  // edge: a disc that is seen from its edge

// All in binary32, so that both precisions start from the same numbers.
struct Footprint {
  ViewProjection<float> view;
  Vec3f mean;  // view space
  Quatf rotation;
  Vec3f scale;

  template <class T>
  ImageJacobian<T> jacobian() const {
    ViewProjection<T> v{};
    for (int i = 0; i < 3; ++i) v.world_to_view.row[i] = cast<T>(view.world_to_view.row[i]);
    v.fx = view.fx, v.fy = view.fy;
    v.x_low = view.x_low, v.x_high = view.x_high, v.y_low = view.y_low, v.y_high = view.y_high;
    return image_jacobian(v, cast<T>(mean));
  }
  template <class T>
  Quat<T> turned() const {
    return {rotation.w, rotation.x, rotation.y, rotation.z};
  }
  template <class T>
  static Vec3<T> cast(const Vec3f& v) {
    return {v.x, v.y, v.z};
  }
  template <class T>
  ImageCovariance<T> covariance() const {
    return image_covariance(jacobian<T>(), turned<T>(), cast<T>(scale), static_cast<T>(kLowPass));
  }
};

inline Quatf random_turn(std::mt19937& random) {
  std::normal_distribution<float> normal;
  const float w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return normalise(Quatf{w, x, y, z});
}

// Turns the third axis to `normal` (unit), the others about it at random.
inline Quatf turned_to(std::mt19937& random, const Vec3d& normal) {
  std::uniform_real_distribution<double> angle(0, 3.14159265358979);
  const double spin = angle(random);
  const Quatd q = normalise(Quatd{1 + normal.z, -normal.y, normal.x, 0}) *
                  Quatd{std::cos(spin), 0, 0, std::sin(spin)};
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
          static_cast<float>(q.z)};
}

// A unit vector across `ray`, any of them.
inline Vec3d across(std::mt19937& random, const Vec3d& ray) {
  std::normal_distribution<double> normal;
  const Vec3d any{normal(random), normal(random), normal(random)};
  const Vec3d n = any - (dot(any, ray) / dot(ray, ray)) * ray;
  return (1 / std::sqrt(dot(n, n))) * n;
}

// pixels: σ along the longest axis, seen from its side in the middle of the image.
inline Footprint random_footprint(std::mt19937& random, Build build, double pixels, double ratio) {
  constexpr double kFocal = 1000, kWidth = 1920, kHeight = 1080;
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Quatf turn = random_turn(random);
  const Mat3d axes = rotation(normalise(Quatd{turn.w, turn.x, turn.y, turn.z}));
  Footprint f;
  f.view = view_projection<float>(axes, kFocal, kFocal, kWidth / 2, kHeight / 2, kWidth, kHeight);
  const double z = std::pow(10, uniform(random));
  f.mean = {static_cast<float>(z * uniform(random)), static_cast<float>(0.5 * z * uniform(random)),
            static_cast<float>(z)};
  const Vec3d ray = double{f.mean.x} * axes.row[0] + double{f.mean.y} * axes.row[1] +
                    double{f.mean.z} * axes.row[2];
  f.rotation = build == Build::edge ? turned_to(random, across(random, ray)) : random_turn(random);
  const double longest = pixels * z / kFocal;
  f.scale.x = static_cast<float>(longest);
  f.scale.y = build != Build::needle ? f.scale.x : static_cast<float>(longest / ratio);
  f.scale.z = static_cast<float>(longest / ratio);
  return f;
}

// ρ at a pixel by the kernels' arithmetic.
inline float kernel_rho(const Conic<float>& c, float dx, float dy) {
  const float p = dx * c.p_x, q = std::fma(-c.skew, dx, dy) * c.q_y;
  return -std::fma(q, q, p * p);
}
inline double exact_rho(const Conic<double>& c, double dx, double dy) {
  const double p = dx * c.p_x, q = (dy - c.skew * dx) * c.q_y;
  return -(p * p + q * q);
}

// A place relative to the centre, in an image of any size, where ρ is at least `least`.
inline bool random_place(std::mt19937& random, const Conic<double>& c, double least, float& dx,
                         float& dy) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double radius = std::sqrt(-least);
  const double p = uniform(random) * std::min(radius, kLargestImage * c.p_x);
  const double q = uniform(random) * std::sqrt(radius * radius - p * p);
  dx = static_cast<float>(p / c.p_x);
  dy = static_cast<float>(q / c.q_y + c.skew * static_cast<double>(dx));
  return std::fabs(dy) <= kLargestImage && exact_rho(c, double{dx}, double{dy}) >= least;
}

}  // namespace voyager::test
