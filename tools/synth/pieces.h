#pragma once
// Builds the surfaces of each thing in the layout. All append to `out`.
#include <vector>

#include "tools/synth/layout.h"
#include "tools/synth/surface.h"

namespace voyager::synth {

using Surfaces = std::vector<Surface>;

// `detailed`: windows are set into the walls; otherwise, for a city of few
// Gaussians, they lie on whole walls, so that no wall has gaps.
void add_building(Surfaces& out, const Building& building, bool detailed);

// A detailed crown is five balls, a coarse one is one.
void add_tree(Surfaces& out, const Tree& tree, bool detailed);
void add_lamp(Surfaces& out, const Lamp& lamp);
void add_car(Surfaces& out, const Car& car);

// The ground of a cell: its crossing, street segments, block and outer green belt.
void add_ground(Surfaces& out, const Cell& cell, const Layout& layout);

// An upright box from height `low` to `high`, without a floor.
void add_box(Surfaces& out, double x0, double z0, double x1, double z1, double low, double high,
             const Vec3f& colour, Material material);

// A level rectangle at a height, seen from above.
void add_level(Surfaces& out, double x0, double z0, double x1, double z1, double height,
               const Vec3f& colour, Material material);

// A wall piece: `left` is the foot of the wall plane's left end, `right` unit along it, `normal`
// outwards; the piece spans [s0, s1] metres to the right and [h0, h1] metres of height.
struct WallPlane {
  Vec3d left, right, normal;
};
void add_wall(Surfaces& out, const WallPlane& plane, double s0, double s1, double h0, double h1,
              const Vec3f& colour, Material material, double outwards = 0.0);

}  // namespace voyager::synth
