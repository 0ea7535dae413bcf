// What stands in the streets: trees, lamps and parked cars.
#include "tools/synth/pieces.h"
#include "tools/synth/portable_math.h"
#include "tools/synth/random.h"

namespace voyager::synth {

void add_tree(Surfaces& out, const Tree& t, bool detailed) {
  Random random(t.seed);
  const double crown = t.height - t.radius, half = 0.09 + 0.012 * t.height;
  add_box(out, t.x - half, t.z - half, t.x + half, t.z + half, 0.0, crown, {0.30f, 0.23f, 0.17f},
          Material::bark);
  const float warm = static_cast<float>(random.uniform(0.0, 1.0)),
              light = static_cast<float>(random.uniform(0.8, 1.15));
  const Vec3f green = light * Vec3f{0.22f + 0.14f * warm, 0.37f + 0.04f * warm, 0.14f};
  const int balls = detailed ? 5 : 1;
  const double turn = random.uniform(0.0, 1.5);
  for (int k = 0; k < balls; ++k) {
    const double angle = turn + 1.5707963267948966 * (k - 3),
                 out_by = k == 0 ? 0.0 : 0.42 * t.radius;
    const double r = t.radius * (k == 0 ? (detailed ? 0.72 : 0.92) : random.uniform(0.48, 0.6));
    const double up = k == 0 ? 0.25 * t.radius : random.uniform(-0.35, 0.25) * t.radius;
    const Vec3d centre{t.x + out_by * portable_cos(angle), -(crown + up),
                       t.z + out_by * portable_sin(angle)};
    const float shade = static_cast<float>(random.uniform(0.85, 1.15));
    out.push_back(
        {centre, {r, 0, 0}, {0, r * 0.9, 0}, {0, -1, 0}, 0, 0, shade * green, Material::leaves});
  }
}

void add_lamp(Surfaces& out, const Lamp& l) {
  const Vec3f grey{0.28f, 0.30f, 0.31f};
  add_box(out, l.x - 0.07, l.z - 0.07, l.x + 0.07, l.z + 0.07, 0.0, 6.0, grey, Material::metal);
  const double ax = l.arm.x * 1.4, az = l.arm.z * 1.4;
  const auto low = [](double a) { return a < 0.0 ? a : 0.0; };
  const auto high = [](double a) { return a > 0.0 ? a : 0.0; };
  add_box(out, l.x + low(ax) - 0.05, l.z + low(az) - 0.05, l.x + high(ax) + 0.05,
          l.z + high(az) + 0.05, 5.9, 6.0, grey, Material::metal);
  add_box(out, l.x + ax - 0.2, l.z + az - 0.2, l.x + ax + 0.2, l.z + az + 0.2, 5.78, 5.9,
          {0.95f, 0.93f, 0.80f}, Material::trim);
}

void add_car(Surfaces& out, const Car& c) {
  static constexpr Vec3f kPaints[] = {
      {0.75f, 0.75f, 0.77f}, {0.12f, 0.12f, 0.13f}, {0.60f, 0.08f, 0.08f}, {0.10f, 0.20f, 0.45f},
      {0.88f, 0.88f, 0.86f}, {0.40f, 0.42f, 0.44f}, {0.80f, 0.58f, 0.10f}, {0.14f, 0.32f, 0.22f}};
  Random random(c.seed);
  const Vec3f paint = kPaints[random.below(8)];
  const Vec3f glass{0.10f, 0.12f, 0.14f}, tyre{0.05f, 0.05f, 0.05f};
  const auto box = [&](double l0, double l1, double half, double low, double high,
                       const Vec3f& colour, Material m) {
    if (c.along_x)
      add_box(out, c.x + l0, c.z - half, c.x + l1, c.z + half, low, high, colour, m);
    else
      add_box(out, c.x - half, c.z + l0, c.x + half, c.z + l1, low, high, colour, m);
  };
  box(-2.1, 2.1, 0.88, 0.30, 0.85, paint, Material::car_paint);
  box(-1.3, 1.0, 0.76, 0.85, 1.35, glass, Material::glass);
  box(-1.2, 0.85, 0.74, 1.36, 1.44, paint, Material::car_paint);
  for (double wheel : {-1.3, 1.3})
    box(wheel - 0.32, wheel + 0.32, 0.86, 0.0, 0.5, tyre, Material::bark);
}

}  // namespace voyager::synth
