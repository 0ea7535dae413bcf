// Façades and the choice of colours; roofs are in roof.cpp.
#include <algorithm>

#include "tools/synth/pieces.h"
#include "tools/synth/random.h"
#include "tools/synth/roof.h"

namespace voyager::synth {
namespace {

struct Style {
  Vec3f wall, trim, glass, door, shop;
  Material material;
  double window_width;  // of a bay
  double sill, lintel;  // heights above a floor
  bool shops;
};

constexpr Vec3f kWalls[] = {{0.62f, 0.27f, 0.20f}, {0.86f, 0.78f, 0.62f}, {0.80f, 0.60f, 0.36f},
                            {0.88f, 0.87f, 0.84f}, {0.58f, 0.58f, 0.57f}, {0.74f, 0.66f, 0.54f},
                            {0.60f, 0.68f, 0.74f}, {0.76f, 0.46f, 0.33f}, {0.68f, 0.72f, 0.58f},
                            {0.50f, 0.33f, 0.27f}};
constexpr Vec3f kShops[] = {{0.55f, 0.10f, 0.10f},
                            {0.10f, 0.28f, 0.42f},
                            {0.12f, 0.34f, 0.20f},
                            {0.72f, 0.52f, 0.12f},
                            {0.18f, 0.18f, 0.20f}};

Style style_of(const Building& b) {
  Random random(b.seed);
  Style s;
  const int wall = random.below(10);
  const float shade = static_cast<float>(random.uniform(0.88, 1.08));
  s.wall = shade * kWalls[wall];
  s.material = wall == 0 || wall == 7 || wall == 9 ? Material::brick : Material::plaster;
  s.trim = random.chance(0.75) ? Vec3f{0.88f, 0.87f, 0.83f} : 0.6f * s.wall;
  const float tint = static_cast<float>(random.uniform(0.7, 1.2));
  s.glass = tint * Vec3f{0.13f, 0.17f, 0.21f};
  s.door = random.chance(0.5) ? Vec3f{0.32f, 0.18f, 0.10f} : 0.7f * kShops[random.below(5)];
  s.shop = kShops[random.below(5)];
  s.window_width = random.uniform(0.38, 0.56);
  s.sill = random.uniform(0.75, 1.0);
  s.lintel = random.uniform(2.4, 2.65);
  s.shops = !b.free_standing && random.chance(0.65);
  if (b.glazed) {
    s.wall = shade * Vec3f{0.52f, 0.57f, 0.62f};
    s.material = Material::metal;
    s.glass = tint * Vec3f{0.20f, 0.30f, 0.38f};
    s.window_width = 0.90;
    s.sill = 0.35;
    s.lintel = 2.95;
    s.shops = true;
  }
  return s;
}

// The wall around an opening: nothing to do where the opening lies on a whole wall.
struct Facade {
  Surfaces& out;
  const WallPlane& plane;
  const Style& style;
  bool detailed;

  void wall(double s0, double s1, double h0, double h1) const {
    if (detailed) add_wall(out, plane, s0, s1, h0, h1, style.wall, style.material);
  }
  void opening(double s0, double s1, double h0, double h1, const Vec3f& colour,
               Material material) const {
    add_wall(out, plane, s0, s1, h0, h1, colour, material, detailed ? -0.10 : 0.12);
  }
  void trim(double s0, double s1, double h0, double h1, const Vec3f& colour) const {
    add_wall(out, plane, s0, s1, h0, h1, colour, Material::trim, detailed ? 0.05 : 0.15);
  }
};

void add_ground_floor(const Facade& f, double s0, double s1, bool door) {
  const double middle = 0.5 * (s0 + s1), bay = s1 - s0;
  const double half = door ? 0.6 : (f.style.shops ? 0.42 * bay : 0.5 * f.style.window_width * bay);
  const double foot = door ? 0.0 : (f.style.shops ? 0.5 : 1.1);
  const double top = door ? 2.5 : 2.95;
  f.wall(s0, middle - half, 0.0, 3.2);
  f.wall(middle + half, s1, 0.0, 3.2);
  f.wall(middle - half, middle + half, 0.0, foot);
  f.wall(middle - half, middle + half, top, 3.2);
  if (door)
    f.opening(middle - half, middle + half, foot, top, f.style.door, Material::trim);
  else
    f.opening(middle - half, middle + half, foot, top, f.style.glass, Material::glass);
}

// One bay from the ground floor's ceiling to the eaves.
void add_column(const Facade& f, double s0, double s1, int floors, double height) {
  const double middle = 0.5 * (s0 + s1), half = 0.5 * f.style.window_width * (s1 - s0);
  const double left = middle - half, right = middle + half;
  f.wall(s0, left, kGroundFloor, height);
  f.wall(right, s1, kGroundFloor, height);
  double cursor = kGroundFloor;
  for (int floor = 1; floor < floors; ++floor) {
    const double base = kGroundFloor + kUpperFloor * (floor - 1);
    f.wall(left, right, cursor, base + f.style.sill - 0.12);
    f.trim(left - 0.08, right + 0.08, base + f.style.sill - 0.12, base + f.style.sill,
           f.style.trim);
    const double low = base + f.style.sill, high = base + f.style.lintel;
    cursor = high;
    if (!f.detailed) {
      f.opening(left, right, low, high, f.style.glass, Material::glass);
      continue;
    }
    // Two panes and the frame between them.
    f.opening(left, middle - 0.05, low, high, f.style.glass, Material::glass);
    f.opening(middle - 0.05, middle + 0.05, low, high, f.style.trim, Material::trim);
    f.opening(middle + 0.05, right, low, high, f.style.glass, Material::glass);
  }
  f.wall(left, right, cursor, height);
}

void add_facade(Surfaces& out, const WallPlane& plane, double width, const Building& b,
                const Style& style, bool front, bool detailed) {
  const double height = b.eaves();
  const Facade f{out, plane, style, detailed};
  if (!detailed) add_wall(out, plane, 0.0, width, 0.0, height, style.wall, style.material);
  const int bays = std::max(1, static_cast<int>(width / (detailed ? 3.1 : 4.2) + 0.5));
  const double bay = width / bays;
  const int door = static_cast<int>(b.seed % static_cast<uint64_t>(bays));
  for (int k = 0; k < bays; ++k) {
    const double s0 = k * bay, s1 = s0 + bay;
    add_ground_floor(f, s0, s1, front && k == door);
    add_column(f, s0, s1, b.floors, height);
  }
  // The band above the ground floor: a shop's sign, or a cornice.
  f.wall(0.0, width, 3.2, 3.3);
  f.wall(0.0, width, 3.85, kGroundFloor);
  if (front && style.shops)
    f.opening(0.0, width, 3.3, 3.85, style.shop, Material::trim);
  else
    f.wall(0.0, width, 3.3, 3.85);
  f.trim(0.0, width, height - 0.35, height, style.trim);
}

}  // namespace

void add_building(Surfaces& out, const Building& b, bool detailed) {
  const Style style = style_of(b);
  const double width = b.x1 - b.x0, depth = b.z1 - b.z0;
  const WallPlane sides[4] = {{{b.x0, 0, b.z0}, {0, 0, 1}, {-1, 0, 0}},
                              {{b.x1, 0, b.z0}, {0, 0, 1}, {1, 0, 0}},
                              {{b.x0, 0, b.z0}, {1, 0, 0}, {0, 0, -1}},
                              {{b.x0, 0, b.z1}, {1, 0, 0}, {0, 0, 1}}};
  for (int side = 0; side < 4; ++side) {
    const double across = side < 2 ? depth : width;
    // In a row the two party walls have no windows.
    const bool party = !b.free_standing && !b.front[side] && (side < 2) == b.ridge_along_x;
    if (party)
      add_wall(out, sides[side], 0.0, across, 0.0, b.eaves(), style.wall, Material::hidden_wall);
    else
      add_facade(out, sides[side], across, b, style, b.front[side], detailed);
  }
  add_roof(out, b, style.wall, style.trim);
}

}  // namespace voyager::synth
