#include "tools/synth/surface.h"

#include <cmath>

#include "tools/synth/portable_math.h"
#include "tools/synth/random.h"

namespace voyager::synth {
namespace {

// Smooth noise in [0, 1] over the plane, one cell a unit.
double value_noise(double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y), a = x - fx, b = y - fy;
  const auto corner = [&](int dx, int dy) {
    const uint64_t h = combine(static_cast<uint64_t>(static_cast<int64_t>(fx) + dx),
                               static_cast<uint64_t>(static_cast<int64_t>(fy) + dy));
    return static_cast<double>(h >> 32) * 0x1p-32;
  };
  const double u = a * a * (3 - 2 * a), v = b * b * (3 - 2 * b);
  const double low = corner(0, 0) + u * (corner(1, 0) - corner(0, 0));
  const double high = corner(0, 1) + u * (corner(1, 1) - corner(0, 1));
  return low + v * (high - low);
}

// The fraction of the way through a period.
double phase(double x, double period) {
  const double k = x / period;
  return k - std::floor(k);
}

double pattern(const Surface& surface, double s, double t) {
  const Vec3d& c = surface.corner;
  switch (surface.material) {
    case Material::plaster:
      return 0.90 + 0.2 * value_noise((c.x + c.z + s) * 0.4, (c.y + t) * 0.25);
    case Material::brick: {
      const double course = std::floor(t / 0.3), stone = std::floor(s / 0.6 + 0.5 * course);
      return 0.90 + 0.20 * value_noise(stone * 7.3 + 0.5, course * 3.7 + 0.5);
    }
    case Material::tiles: {
      const double row = phase(t, 0.6);
      return (0.82 + 0.3 * row) * (0.9 + 0.2 * value_noise(s * 1.3 + c.x, t * 0.8 + c.z));
    }
    case Material::gravel:
      return 0.85 + 0.3 * value_noise((c.x + s) * 0.5, (c.z + t) * 0.5);
    case Material::asphalt:
      return 0.88 + 0.24 * value_noise((c.x + s) * 0.35, (c.z + t) * 0.35);
    case Material::paving: {
      const int slab =
          static_cast<int>(std::floor(s / 1.2)) * 57 + static_cast<int>(std::floor(t / 1.2)) * 131;
      return 0.92 + 0.16 * value_noise(slab + 0.5, 0.5);
    }
    case Material::grass:
      return 0.70 + 0.6 * value_noise((c.x + s) * 0.45, (c.z + t) * 0.45);
    default:
      return 1.0;
  }
}

}  // namespace

const MaterialLook& look(Material material) {
  static constexpr MaterialLook kLooks[] = {
      {2.4f, 0.045f, 0.02f, 2.8f},  // plaster
      {2.4f, 0.06f, 0.02f, 3.0f},   // brick
      {0.5f, 0.04f, 0.02f, 1.6f},   // hidden_wall
      {4.0f, 0.03f, 0.03f, 2.5f},   // trim
      {3.4f, 0.03f, 0.42f, 1.6f},   // glass
      {4.0f, 0.04f, 0.25f, 1.5f},   // metal
      {1.3f, 0.07f, 0.04f, 3.2f},   // tiles
      {0.8f, 0.06f, 0.02f, 1.5f},   // gravel
      {1.1f, 0.04f, 0.03f, 2.4f},   // asphalt
      {4.0f, 0.04f, 0.03f, 2.0f},   // paint
      {1.1f, 0.05f, 0.02f, 2.2f},   // paving
      {1.2f, 0.12f, 0.01f, 2.4f},   // grass
      {8.0f, 0.03f, 0.35f, 1.6f},   // car_paint
      {6.0f, 0.10f, 0.01f, 2.5f},   // bark
      {2.6f, 0.14f, 0.03f, 1.8f},   // leaves
  };
  return kLooks[static_cast<int>(material)];
}

double Surface::area() const {
  if (material == Material::leaves) return 4.0 * 3.141592653589793 * u.x * v.y;
  return length(u) * length(v) * (1.0 - 0.5 * (inset_left + inset_right));
}

double Surface::weight() const {
  return area() * static_cast<double>(look(material).detail);
}

Vec3f albedo(const Surface& surface, double s, double t) {
  return static_cast<float>(pattern(surface, s, t)) * surface.colour;
}

}  // namespace voyager::synth
