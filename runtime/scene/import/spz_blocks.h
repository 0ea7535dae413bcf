#pragma once
// A .spz block by block, for what has one inside.
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/spz_header.h"

namespace voyager::spz {

// Its numbers in the axes that `to_inria` is from, whatever axes its extensions name.
std::unique_ptr<BlockReader> open_in_axes(std::shared_ptr<const ByteSource> source,
                                          const HalfTurn& to_inria);

// Of positions, as the numbers stand in the file. Empty, least above most, for no Gaussians.
struct Bounds {
  std::array<double, 3> least, most;
};
Bounds bounds_of_positions(const ByteSource& source);

// What of it is not read, for people.
std::vector<std::string> left_out_of(const Announcement& found);

}  // namespace voyager::spz
