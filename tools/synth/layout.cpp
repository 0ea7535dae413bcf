#include "tools/synth/layout.h"

#include <algorithm>
#include <cmath>

#include "tools/synth/portable_math.h"
#include "tools/synth/random.h"

namespace voyager::synth {
namespace {

constexpr double kDepth = 12.0;                           // of a row of houses
constexpr double kInterior = kPitch - 2.0 * kHalfStreet;  // side of a block

BlockKind block_kind(int i, int j, int middle, uint64_t seed) {
  // Around the origin, where the cameras are, one of each kind is certain.
  if (i >= middle - 1 && i <= middle && j >= middle - 1 && j <= middle) {
    const BlockKind kinds[4] = {BlockKind::perimeter, BlockKind::perimeter, BlockKind::towers,
                                BlockKind::houses};
    return kinds[(i - middle + 1) + 2 * (j - middle + 1)];
  }
  const double u =
      Random(combine(seed, 101, combine(static_cast<uint64_t>(i), static_cast<uint64_t>(j))))
          .uniform();
  if (u < 0.48) return BlockKind::perimeter;
  if (u < 0.70) return BlockKind::houses;
  return u < 0.88 ? BlockKind::towers : BlockKind::park;
}

// A closed row of houses along x or z, every one with its own width and height.
void add_row(Cell& cell, Random& random, bool along_x, double a0, double a1, double b0, double b1,
             int street_side) {
  const int houses = std::max(1, static_cast<int>((a1 - a0) / 13.0 + 0.5));
  double cuts[8];
  for (int k = 0; k <= houses; ++k) {
    const double shift = k == 0 || k == houses ? 0.0 : random.uniform(-1.6, 1.6);
    cuts[k] = a0 + (a1 - a0) * k / houses + shift;
  }
  for (int k = 0; k < houses; ++k) {
    Building b{};
    b.x0 = along_x ? cuts[k] : b0;
    b.x1 = along_x ? cuts[k + 1] : b1;
    b.z0 = along_x ? b0 : cuts[k];
    b.z1 = along_x ? b1 : cuts[k + 1];
    b.floors = 3 + random.below(4);
    b.ridge_along_x = along_x;
    b.roof = random.chance(0.45) ? Roof::flat : Roof::gable;
    b.rise = random.uniform(3.0, 4.8);
    b.front[street_side] = true;
    if (along_x) {  // these rows reach the corners of the block
      b.front[0] = k == 0;
      b.front[1] = k == houses - 1;
    }
    b.seed = random.bits();
    cell.buildings.push_back(b);
  }
}

void add_perimeter(Cell& cell, Random& random, double x, double z) {
  add_row(cell, random, true, x, x + kInterior, z, z + kDepth, 2);
  add_row(cell, random, true, x, x + kInterior, z + kInterior - kDepth, z + kInterior, 3);
  add_row(cell, random, false, z + kDepth, z + kInterior - kDepth, x, x + kDepth, 0);
  add_row(cell, random, false, z + kDepth, z + kInterior - kDepth, x + kInterior - kDepth,
          x + kInterior, 1);
  for (int k = 0; k < 5; ++k) {
    const double height = random.uniform(5.5, 8.0);
    cell.trees.push_back({x + random.uniform(15, kInterior - 15),
                          z + random.uniform(15, kInterior - 15), height, height * 0.33,
                          random.bits()});
  }
}

void add_houses(Cell& cell, Random& random, double x, double z) {
  for (int row = 0; row < 2; ++row)
    for (int k = 0; k < 3; ++k) {
      const double width = random.uniform(9.5, 11.5), depth = random.uniform(9.0, 11.0);
      Building b{};
      b.x0 = x + 7.3 + 14.7 * k - width / 2.0;
      b.x1 = b.x0 + width;
      b.z0 = row == 0 ? z + random.uniform(2.5, 4.0)
                      : z + kInterior - random.uniform(2.5, 4.0) - depth;
      b.z1 = b.z0 + depth;
      b.floors = 2 + random.below(2);
      b.roof = random.chance(0.4) ? Roof::hip : Roof::gable;
      b.ridge_along_x = random.chance(0.6);
      b.rise = random.uniform(3.2, 4.4);
      b.free_standing = true;
      b.front[row == 0 ? 2 : 3] = true;
      b.seed = random.bits();
      cell.buildings.push_back(b);
    }
  for (int k = 0; k < 9; ++k) {
    const double height = random.uniform(4.5, 8.5);
    cell.trees.push_back(
        {x + 4.5 + 4.4 * k, z + random.uniform(19.0, 25.0), height, height * 0.34, random.bits()});
  }
}

void add_towers(Cell& cell, Random& random, double x, double z) {
  for (int k = 0; k < 2; ++k) {
    const double side = random.uniform(15.0, 17.5);
    Building b{};
    b.x0 = x + (k == 0 ? random.uniform(2.0, 4.0) : kInterior - side - random.uniform(2.0, 4.0));
    b.z0 = z + (k == 0 ? random.uniform(2.0, 4.0) : kInterior - side - random.uniform(2.0, 4.0));
    b.x1 = b.x0 + side;
    b.z1 = b.z0 + side;
    b.floors = 8 + random.below(5);
    b.roof = Roof::flat;
    b.free_standing = true;
    b.glazed = k == 0 || random.chance(0.4);
    for (bool& front : b.front) front = true;
    b.seed = random.bits();
    cell.buildings.push_back(b);
  }
  for (int k = 0; k < 10; ++k) {
    const double height = random.uniform(5.0, 7.5), a = 3.5 + 3.5 * (k % 5);
    cell.trees.push_back({x + (k < 5 ? kInterior - 3.5 - a : 2.5 + a),
                          z + (k < 5 ? a : kInterior - a), height, height * 0.32, random.bits()});
  }
}

void add_park(Cell& cell, Random& random, double x, double z) {
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b) {
      if (random.chance(0.25)) continue;
      const double height = random.uniform(6.0, 11.0);
      // Clear of the cross of paths through the middle.
      cell.trees.push_back({x + 4.0 + 6.4 * a + (a > 2 ? 4.0 : 0.0) + random.uniform(-1.0, 1.0),
                            z + 4.0 + 6.4 * b + (b > 2 ? 4.0 : 0.0) + random.uniform(-1.0, 1.0),
                            height, height * 0.32, random.bits()});
    }
}

// Trees, lamps and parked cars along the two sides of a street segment from this crossing.
void furnish_street(Cell& cell, Random& random, bool along_x) {
  const auto at = [&](double along, double across) {
    return along_x ? Vec3d{cell.x + along, 0.0, cell.z + across}
                   : Vec3d{cell.x + across, 0.0, cell.z + along};
  };
  for (int side = -1; side <= 1; side += 2) {
    for (int k = 0; k < 5; ++k) {
      const Vec3d p = at(13.5 + 8.5 * k, side * 6.1);
      const double height = random.uniform(5.6, 7.4);
      if (random.chance(0.85))
        cell.trees.push_back({p.x, p.z, height, height * 0.3, random.bits()});
    }
    for (int k = 0; k < 2; ++k) {
      const Vec3d p = at(17.75 + 25.5 * k, side * 5.5);
      const Vec3d arm = along_x ? Vec3d{0, 0, -1.0 * side} : Vec3d{-1.0 * side, 0, 0};
      cell.lamps.push_back({p.x, p.z, arm});
    }
    for (int k = 0; k < 6; ++k) {
      const Vec3d p = at(15.5 + 5.8 * k + random.uniform(-0.4, 0.4), side * 3.85);
      if (random.chance(0.6)) cell.cars.push_back({p.x, p.z, along_x, random.bits()});
    }
  }
}

// The green belt: a line of trees outside the outermost streets.
void plant_margin(Cell& cell, Random& random, int i, int j, int blocks) {
  const double out = kHalfStreet + 6.0;
  for (int side = -1; side <= 1; side += 2)
    for (int k = 0; k < 7; ++k) {
      const bool edge_x = side < 0 ? i == 0 : i == blocks, edge_z = side < 0 ? j == 0 : j == blocks;
      const double along = 4.0 + 8.7 * k, across = side * (out + random.uniform(-2.5, 2.5));
      const double height = random.uniform(7.0, 11.0);
      if (edge_x && cell.street_z)
        cell.trees.push_back(
            {cell.x + across, cell.z + along, height, height * 0.36, random.bits()});
      if (edge_z && cell.street_x)
        cell.trees.push_back(
            {cell.x + along, cell.z + across, height, height * 0.36, random.bits()});
    }
}

// Whether the ray from p to the sun meets the footprint below the roof.
bool hides_sun(const Building& b, const Vec3d& p) {
  const double ix = 1.0 / kSun.x, iz = 1.0 / kSun.z;
  const double tx = (b.x0 - p.x) * ix, txe = (b.x1 - p.x) * ix;
  const double tz = (b.z1 - p.z) * iz, tze = (b.z0 - p.z) * iz;
  const double enter = std::max({tx, tz, 0.0}), leave = std::min(txe, tze);
  const double roof = b.roof == Roof::flat ? b.eaves() : b.eaves() + b.rise * 0.6;
  return enter < leave && leave > 0.3 && -p.y - kSun.y * std::max(enter, 0.3) < roof - 0.05;
}

}  // namespace

Layout::Layout(int blocks, uint64_t seed) : blocks_(blocks) {
  cells_.reserve(static_cast<size_t>(blocks + 1) * static_cast<size_t>(blocks + 1));
  for (int j = 0; j <= blocks; ++j)
    for (int i = 0; i <= blocks; ++i) {
      Cell cell;
      cell.x = line(i);
      cell.z = line(j);
      cell.street_x = i < blocks;
      cell.street_z = j < blocks;
      Random random(combine(seed, static_cast<uint64_t>(i), static_cast<uint64_t>(j)));
      if (cell.block()) {
        cell.kind = block_kind(i, j, middle(), seed);
        const double x = cell.x + kHalfStreet, z = cell.z + kHalfStreet;
        switch (cell.kind) {
          case BlockKind::perimeter:
            add_perimeter(cell, random, x, z);
            break;
          case BlockKind::houses:
            add_houses(cell, random, x, z);
            break;
          case BlockKind::towers:
            add_towers(cell, random, x, z);
            break;
          case BlockKind::park:
            add_park(cell, random, x, z);
            break;
        }
      }
      if (cell.street_x) furnish_street(cell, random, true);
      if (cell.street_z) furnish_street(cell, random, false);
      plant_margin(cell, random, i, j, blocks);
      for (const Building& b : cell.buildings) cell.tallest = std::max(cell.tallest, b.top());
      cells_.push_back(std::move(cell));
    }
}

const Cell* Layout::cell_at(int i, int j) const {
  if (i < 0 || j < 0 || i > blocks_ || j > blocks_) return nullptr;
  return &cells_[static_cast<size_t>(j) * static_cast<size_t>(blocks_ + 1) +
                 static_cast<size_t>(i)];
}

bool Layout::shaded(const Vec3d& p) const {
  const int i = static_cast<int>(std::floor(p.x / kPitch)) + middle();
  const int j = static_cast<int>(std::floor(p.z / kPitch)) + middle();
  // The sun stands towards +x and -z; no shadow is longer than a block.
  for (int dj = -1; dj <= 0; ++dj)
    for (int di = 0; di <= 1; ++di) {
      const Cell* cell = cell_at(i + di, j + dj);
      if (!cell || cell->tallest <= -p.y) continue;
      for (const Building& b : cell->buildings)
        if (hides_sun(b, p)) return true;
    }
  return false;
}

bool Layout::blocked(const Vec3d& p, double clearance) const {
  const auto in_box = [&](double x0, double z0, double x1, double z1, double top) {
    return p.x > x0 - clearance && p.x < x1 + clearance && p.z > z0 - clearance &&
           p.z < z1 + clearance && -p.y < top + clearance;
  };
  const int i = static_cast<int>(std::floor(p.x / kPitch)) + middle();
  const int j = static_cast<int>(std::floor(p.z / kPitch)) + middle();
  for (int dj = -1; dj <= 1; ++dj)
    for (int di = -1; di <= 1; ++di) {
      const Cell* cell = cell_at(i + di, j + dj);
      if (!cell) continue;
      for (const Building& b : cell->buildings)
        if (in_box(b.x0 - 0.5, b.z0 - 0.5, b.x1 + 0.5, b.z1 + 0.5, b.top())) return true;
      for (const Car& c : cell->cars) {
        const double hx = c.along_x ? 2.2 : 0.9, hz = c.along_x ? 0.9 : 2.2;
        if (in_box(c.x - hx, c.z - hz, c.x + hx, c.z + hz, 1.5)) return true;
      }
      for (const Lamp& l : cell->lamps)
        if (in_box(l.x - 0.1, l.z - 0.1, l.x + 0.1, l.z + 0.1, 6.2)) return true;
      for (const Tree& t : cell->trees) {
        if (in_box(t.x - 0.2, t.z - 0.2, t.x + 0.2, t.z + 0.2, t.height - t.radius)) return true;
        const Vec3d centre{t.x, -(t.height - t.radius), t.z};
        if (length(p - centre) < 1.15 * t.radius + clearance) return true;
      }
    }
  return false;
}

double Layout::extent() const {
  const double across = std::max(middle(), blocks_ - middle()) * kPitch + kHalfStreet + kMargin;
  return std::max(across, kTallestTower);
}

}  // namespace voyager::synth
