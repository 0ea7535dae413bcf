#pragma once
// Where things stand. The city is a grid of square blocks with a street along
// every grid line; the crossing of the middle lines is the origin, the ground
// is y = 0 and y points down, so a height h lies at y = -h. Metres throughout.
#include <cstdint>
#include <vector>

#include "runtime/math/vec.h"

namespace voyager::synth {

inline constexpr double kPitch = 61.0;       // from street axis to street axis
inline constexpr double kHalfRoad = 5.0;     // two lanes and two rows of parked cars
inline constexpr double kHalfStreet = 8.5;   // with the pavements
inline constexpr double kKerb = 0.12;        // height of a pavement
inline constexpr double kMargin = 14.0;      // the green belt around the outermost streets
inline constexpr double kGroundFloor = 4.0;  // height
inline constexpr double kUpperFloor = 3.2;
inline constexpr double kParapet = 0.8;

enum class BlockKind { perimeter, houses, towers, park };
enum class Roof { flat, gable, hip };

struct Building {
  double x0, z0, x1, z1;  // footprint
  int floors;             // at least 1
  Roof roof;
  double rise;  // of a sloping roof above the eaves
  bool ridge_along_x;
  bool free_standing;  // no neighbour shares a wall
  bool glazed;         // a curtain wall of glass
  // Which sides face a street, and so have doors, shops and full detail: -x, +x, -z, +z.
  bool front[4];
  uint64_t seed;

  double eaves() const { return kGroundFloor + kUpperFloor * (floors - 1) + 0.6; }
  double top() const { return eaves() + (roof == Roof::flat ? 2.6 : rise + 1.2); }
};

struct Tree {
  double x, z, height, radius;  // of the whole tree; of its crown
  uint64_t seed;
};

struct Lamp {
  double x, z;
  Vec3d arm;  // unit, over the road
};

struct Car {
  double x, z;
  bool along_x;
  uint64_t seed;
};

// A crossing, the two street segments that leave it towards +x and +z, and the
// block between them; the last row and column of cells have no block.
struct Cell {
  double x = 0, z = 0;  // of the crossing
  bool street_x = false, street_z = false;
  bool block() const { return street_x && street_z; }
  BlockKind kind = BlockKind::perimeter;
  double tallest = 0;
  std::vector<Building> buildings;
  std::vector<Tree> trees;
  std::vector<Lamp> lamps;
  std::vector<Car> cars;
};

class Layout {
 public:
  // blocks >= 2 along each axis.
  Layout(int blocks, uint64_t seed);

  int blocks() const { return blocks_; }
  int middle() const { return blocks_ / 2; }
  double line(int i) const { return (i - middle()) * kPitch; }
  const std::vector<Cell>& cells() const { return cells_; }  // row by row, (blocks + 1) squared

  // True if a point nearer than `clearance` metres to a building, tree, lamp or car (or inside).
  bool blocked(const Vec3d& point, double clearance) const;
  // True if a building stands between the point and the sun.
  bool shaded(const Vec3d& point) const;
  // No coordinate of anything that stands here exceeds this.
  double extent() const;

 private:
  const Cell* cell_at(int i, int j) const;

  int blocks_;
  std::vector<Cell> cells_;
};

inline constexpr double kTallestTower = 50.0;
// Unit, towards the sun.
inline constexpr Vec3d kSun{0.4489001392432335, -0.8080202506378203, -0.3815651183567485};

}  // namespace voyager::synth
