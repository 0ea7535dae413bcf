// Streets with lanes, markings and crossings; pavements; blocks; the green belt.
#include "tools/synth/pieces.h"

namespace voyager::synth {
namespace {

constexpr Vec3f kAsphalt{0.29f, 0.29f, 0.30f};
constexpr Vec3f kPaint{0.86f, 0.86f, 0.83f};
constexpr Vec3f kPaving{0.58f, 0.56f, 0.52f};
constexpr Vec3f kKerbstone{0.70f, 0.69f, 0.66f};
constexpr Vec3f kGrass{0.27f, 0.42f, 0.15f};
constexpr Vec3f kSand{0.68f, 0.58f, 0.42f};

// Rectangles in the coordinates of a street: metres along it and across, from the crossing.
struct Street {
  Surfaces& out;
  const Cell& cell;
  bool along_x;

  void level(double a0, double a1, double c0, double c1, double height, const Vec3f& colour,
             Material m) const {
    if (along_x)
      add_level(out, cell.x + a0, cell.z + c0, cell.x + a1, cell.z + c1, height, colour, m);
    else
      add_level(out, cell.x + c0, cell.z + a0, cell.x + c1, cell.z + a1, height, colour, m);
  }
};

// Bars of paint across the whole road, between a0 and a1.
void add_zebra(const Street& street, double a0, double a1) {
  const int bars = 20;
  for (int k = 0; k < bars; ++k) {
    const double c = -kHalfRoad + 2.0 * kHalfRoad * k / bars, width = 2.0 * kHalfRoad / bars;
    street.level(a0, a1, c, c + width, 0.0, k % 2 ? kPaint : kAsphalt,
                 k % 2 ? Material::paint : Material::asphalt);
  }
}

void add_segment(Surfaces& out, const Cell& cell, bool along_x) {
  const Street street{out, cell, along_x};
  const double start = kHalfStreet, end = kPitch - kHalfStreet, zebra = 3.0, line = 0.08;
  add_zebra(street, start, start + zebra);
  add_zebra(street, end - zebra, end);
  const double a0 = start + zebra, a1 = end - zebra;
  street.level(a0, a1, -kHalfRoad, -line, 0.0, kAsphalt, Material::asphalt);
  street.level(a0, a1, line, kHalfRoad, 0.0, kAsphalt, Material::asphalt);
  const int dashes = 13;
  for (int k = 0; k < dashes; ++k)
    street.level(a0 + (a1 - a0) * k / dashes, a0 + (a1 - a0) * (k + 1) / dashes, -line, line, 0.0,
                 k % 2 ? kAsphalt : kPaint, k % 2 ? Material::asphalt : Material::paint);
  for (int side = -1; side <= 1; side += 2) {
    const double road = side * kHalfRoad, kerb = side * (kHalfRoad + 0.25),
                 wall = side * kHalfStreet;
    street.level(start, end, side < 0 ? kerb : road, side < 0 ? road : kerb, kKerb, kKerbstone,
                 Material::trim);
    street.level(start, end, side < 0 ? wall : kerb, side < 0 ? kerb : wall, kKerb, kPaving,
                 Material::paving);
  }
}

void add_crossing(Surfaces& out, const Cell& cell) {
  const double r = kHalfRoad, s = kHalfStreet;
  const auto level = [&](double x0, double z0, double x1, double z1, double h, const Vec3f& colour,
                         Material m) {
    add_level(out, cell.x + x0, cell.z + z0, cell.x + x1, cell.z + z1, h, colour, m);
  };
  level(-s, -r, s, r, 0.0, kAsphalt, Material::asphalt);
  level(-r, -s, r, -r, 0.0, kAsphalt, Material::asphalt);
  level(-r, r, r, s, 0.0, kAsphalt, Material::asphalt);
  for (double x : {-s, r})
    for (double z : {-s, r})
      level(x, z, x + (s - r), z + (s - r), kKerb, kPaving, Material::paving);
}

void add_park_ground(Surfaces& out, double x, double z, double side) {
  const double a = 0.5 * side - 1.6, b = 0.5 * side + 1.6;
  add_level(out, x, z, x + a, z + a, kKerb, kGrass, Material::grass);
  add_level(out, x + b, z, x + side, z + a, kKerb, kGrass, Material::grass);
  add_level(out, x, z + b, x + a, z + side, kKerb, kGrass, Material::grass);
  add_level(out, x + b, z + b, x + side, z + side, kKerb, kGrass, Material::grass);
  add_level(out, x, z + a, x + side, z + b, kKerb, kSand, Material::paving);
  add_level(out, x + a, z, x + b, z + a, kKerb, kSand, Material::paving);
  add_level(out, x + a, z + b, x + b, z + side, kKerb, kSand, Material::paving);
}

void add_block_ground(Surfaces& out, const Cell& cell) {
  const double x = cell.x + kHalfStreet, z = cell.z + kHalfStreet,
               side = kPitch - 2.0 * kHalfStreet, yard = 12.0;
  switch (cell.kind) {
    case BlockKind::perimeter:  // the houses cover the rest
      add_level(out, x + yard, z + yard, x + side - yard, z + side - yard, kKerb, kGrass,
                Material::grass);
      break;
    case BlockKind::houses:
      add_level(out, x, z, x + side, z + side, kKerb, kGrass, Material::grass);
      break;
    case BlockKind::towers:
      add_level(out, x, z, x + side, z + side, kKerb, kPaving, Material::paving);
      break;
    case BlockKind::park:
      add_park_ground(out, x, z, side);
      break;
  }
}

void add_green_belt(Surfaces& out, const Layout& layout) {
  const double low = layout.line(0) - kHalfStreet,
               high = layout.line(layout.blocks()) + kHalfStreet;
  const double out_low = low - kMargin, out_high = high + kMargin;
  add_level(out, out_low, out_low, out_high, low, kKerb, kGrass, Material::grass);
  add_level(out, out_low, high, out_high, out_high, kKerb, kGrass, Material::grass);
  add_level(out, out_low, low, low, high, kKerb, kGrass, Material::grass);
  add_level(out, high, low, out_high, high, kKerb, kGrass, Material::grass);
}

}  // namespace

void add_ground(Surfaces& out, const Cell& cell, const Layout& layout) {
  add_crossing(out, cell);
  if (cell.street_x) add_segment(out, cell, true);
  if (cell.street_z) add_segment(out, cell, false);
  if (cell.block()) add_block_ground(out, cell);
  if (&cell == &layout.cells().front()) add_green_belt(out, layout);
}

}  // namespace voyager::synth
