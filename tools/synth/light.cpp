#include "tools/synth/light.h"

#include <algorithm>

#include "runtime/math/sh.h"
#include "tools/synth/layout.h"
#include "tools/synth/portable_math.h"

namespace voyager::synth {
namespace {

constexpr Vec3d kSunlight{1.02, 0.95, 0.82}, kSkylight{0.56, 0.60, 0.68}, kSky{0.62, 0.74, 0.90};

// Adds colour * sum over l of strength[l] P_l(direction . axis), P_l the Legendre polynomials.
void add_lobe(const Vec3d& axis, const double (&strength)[4], const Vec3d& colour,
              float (&sh)[16][3]) {
  double basis[16];
  sh_basis(3, axis, basis);
  for (int l = 0, k = 0; l <= 3; ++l) {
    const double scale = strength[l] * 4.0 * 3.141592653589793 / (2 * l + 1);
    for (; k < (l + 1) * (l + 1); ++k)
      for (int c = 0; c < 3; ++c) sh[k][c] += static_cast<float>(scale * basis[k] * colour[c]);
  }
}

Vec3d mirrored(const Vec3d& v, const Vec3d& normal) {
  return v - (2.0 * dot(v, normal)) * normal;
}

// What training leaves in the bands above the first: mostly grey.
void add_noise(Random& random, float (&sh)[16][3]) {
  constexpr float kUnit = 1.0f / 18918.6f;  // of a 16-bit number with mean 0: variance 1
  for (int k = 1; k < 16; ++k) {
    const uint64_t bits = random.bits();
    const auto number = [&](int i) {
      return kUnit * (static_cast<float>((bits >> (16 * i)) & 0xffff) - 32767.5f);
    };
    const float band = k < 4 ? 0.8f : 1.0f, grey = 0.045f * band * number(3);
    for (int c = 0; c < 3; ++c) sh[k][c] += grey + 0.012f * band * number(c);
  }
}

}  // namespace

void light_point(const Surface& surface, const Vec3d& point, const Vec3d& normal,
                 const Vec3f& albedo, bool sunlit, Random& random, float (&sh)[16][3]) {
  const double facing = std::max(0.0, dot(normal, kSun));
  const double sun = sunlit ? facing : 0.0;
  double open = 0.70 - 0.30 * normal.y;  // how much sky the point sees
  if (normal.y > -0.5) open *= 0.72 + 0.28 * std::min(1.0, -point.y / 5.0);
  const double mottle = 1.0 + static_cast<double>(look(surface.material).mottle) * random.bell();
  for (int c = 0; c < 3; ++c) {
    const double light = mottle * (open * kSkylight[c] + sun * kSunlight[c]);
    sh[0][c] +=
        static_cast<float>((std::min(1.1, static_cast<double>(albedo[c]) * light) - 0.5) / kSh0);
  }
  const double gloss = static_cast<double>(look(surface.material).gloss) * random.uniform(0.8, 1.2);
  const double sky[4] = {0.40 * gloss, 0.55 * gloss, 0.0, 0.0};
  const double sheen[4] = {0.0, 0.30 * gloss, 0.30 * gloss, 0.20 * gloss};
  add_lobe(mirrored({0.0, -1.0, 0.0}, normal), sky, kSky, sh);
  if (sunlit && facing > 0.0) add_lobe(mirrored(kSun, normal), sheen, kSunlight, sh);
  add_noise(random, sh);
}

}  // namespace voyager::synth
