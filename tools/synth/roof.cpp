#include "tools/synth/roof.h"

#include <cmath>

#include "tools/synth/portable_math.h"
#include "tools/synth/random.h"

namespace voyager::synth {
namespace {

constexpr Vec3f kTiles[] = {{0.58f, 0.25f, 0.17f},
                            {0.48f, 0.22f, 0.16f},
                            {0.30f, 0.31f, 0.34f},
                            {0.42f, 0.33f, 0.27f},
                            {0.64f, 0.34f, 0.22f}};

// A roof face from an eaves edge (foot, along) up to a ridge; shorter by the
// insets, fractions of the eaves, at the top.
void add_slope(Surfaces& out, const Vec3d& foot, const Vec3d& along, const Vec3d& up, double inset,
               const Vec3f& colour, Material material) {
  Vec3d normal = unit(cross(along, up));
  if (normal.y > 0.0) normal = -1.0 * normal;
  out.push_back({foot, along, up, normal, inset, inset, colour, material});
}

void add_flat(Surfaces& out, const Building& b, const Vec3f& trim, Random& random) {
  const double top = b.eaves(), deck = top - kParapet, t = 0.25;
  const float shade = static_cast<float>(random.uniform(0.36, 0.62));
  add_level(out, b.x0 + t, b.z0 + t, b.x1 - t, b.z1 - t, deck, {shade, shade, 0.97f * shade},
            Material::gravel);
  add_level(out, b.x0, b.z0, b.x1, b.z0 + t, top, trim, Material::trim);
  add_level(out, b.x0, b.z1 - t, b.x1, b.z1, top, trim, Material::trim);
  add_level(out, b.x0, b.z0 + t, b.x0 + t, b.z1 - t, top, trim, Material::trim);
  add_level(out, b.x1 - t, b.z0 + t, b.x1, b.z1 - t, top, trim, Material::trim);
  const double width = b.x1 - b.x0 - 2 * t, depth = b.z1 - b.z0 - 2 * t;
  const Vec3f inner = 0.8f * trim;
  add_wall(out, {{b.x0 + t, 0, b.z0 + t}, {1, 0, 0}, {0, 0, 1}}, 0, width, deck, top, inner,
           Material::plaster);
  add_wall(out, {{b.x0 + t, 0, b.z1 - t}, {1, 0, 0}, {0, 0, -1}}, 0, width, deck, top, inner,
           Material::plaster);
  add_wall(out, {{b.x0 + t, 0, b.z0 + t}, {0, 0, 1}, {1, 0, 0}}, 0, depth, deck, top, inner,
           Material::plaster);
  add_wall(out, {{b.x1 - t, 0, b.z0 + t}, {0, 0, 1}, {-1, 0, 0}}, 0, depth, deck, top, inner,
           Material::plaster);
  for (int k = 1 + random.below(3); k > 0; --k) {
    const double x = b.x0 + random.uniform(1.2, width - 3.0);
    const double z = b.z0 + random.uniform(1.2, depth - 3.0);
    const double x1 = x + random.uniform(1.2, 2.2), z1 = z + random.uniform(1.0, 2.0);
    const double machine = deck + random.uniform(0.9, 2.2);
    add_box(out, x, z, x1, z1, deck, machine, {0.66f, 0.67f, 0.68f}, Material::metal);
  }
}

// Gable and hip: a ridge along the longer axis `a`, slopes across it.
void add_pitched(Surfaces& out, const Building& b, const Vec3f& wall, Random& random) {
  const auto shade = static_cast<float>(random.uniform(0.9, 1.1));
  const Vec3f colour = shade * kTiles[random.below(5)];
  const bool along_x = b.ridge_along_x;
  const double over = b.free_standing ? 0.45 : 0.0;  // the eaves of a row end at its party walls
  const Vec3d a = along_x ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1},
              c = along_x ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const double run = (along_x ? b.x1 - b.x0 : b.z1 - b.z0),
               half = 0.5 * (along_x ? b.z1 - b.z0 : b.x1 - b.x0);
  const Vec3d low{b.x0, -b.eaves(), b.z0};
  const double eave = half + 0.4, drop = b.rise * 0.4 / half;  // 0.4 m beyond the wall
  const Vec3d rise{0, -(b.rise + drop), 0};
  const double hip = b.roof == Roof::hip ? 0.33 : 0.0;
  const Vec3d start = low + (-over) * a, edge = (run + 2 * over) * a, down{0, drop, 0};
  add_slope(out, start + (-0.4) * c + down, edge, eave * c + rise, hip, colour, Material::tiles);
  add_slope(out, start + (2 * half + 0.4) * c + down, edge, -eave * c + rise, hip, colour,
            Material::tiles);
  const Vec3d base = (2 * half) * c, in = (hip * (run + 2 * over)) * a;
  if (b.roof == Roof::hip) {
    const Vec3d wide = (2 * eave) * c;
    add_slope(out, start + (-0.4) * c + down, wide, in + rise, 0.5, colour, Material::tiles);
    add_slope(out, start + edge + (-0.4) * c + down, wide, -1.0 * in + rise, 0.5, colour,
              Material::tiles);
  } else {
    const Vec3d peak{0, -b.rise, 0};
    out.push_back({low, base, peak, -1.0 * a, 0.5, 0.5, wall, Material::plaster});
    out.push_back({low + run * a, base, peak, a, 0.5, 0.5, wall, Material::plaster});
  }
  const double along = run * random.uniform(0.4, 0.6), across = half * random.uniform(0.6, 0.9);
  const Vec3d chimney = low + along * a + across * c;
  add_box(out, chimney.x, chimney.z, chimney.x + 0.7, chimney.z + 0.7, b.eaves() + 0.5 * b.rise,
          b.eaves() + b.rise + 0.8, {0.50f, 0.28f, 0.22f}, Material::brick);
}

}  // namespace

void add_roof(Surfaces& out, const Building& b, const Vec3f& wall, const Vec3f& trim) {
  Random random(combine(b.seed, 1));
  if (b.roof == Roof::flat)
    add_flat(out, b, trim, random);
  else
    add_pitched(out, b, wall, random);
}

}  // namespace voyager::synth
