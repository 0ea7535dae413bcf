#pragma once
// What was measured of each node so far.
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/lod/baked_scene.h"

namespace voyager {

struct Measured {
  explicit Measured(size_t nodes) : gain(nodes), pictures(nodes) {}

  uint32_t views = 0;              // those before it are in the sums
  std::vector<double> gain;        // of refining, for each Gaussian more: m² × code values²
  std::vector<uint32_t> pictures;  // that it was part of the cut in
};

// A file of its own, whole or absent. `tree` tells scenes apart.
void keep(const Measured& measured, const LodTree& tree, const std::string& path);
// Throws Error(refused_input) where something is there that keep() did not write.
void check_kept(const std::string& path);
// Where there is none, nothing is measured. Throws Error(refused_input) where it is of another
// tree or was altered.
Measured read_kept(const LodTree& tree, const std::string& path);

}  // namespace voyager
