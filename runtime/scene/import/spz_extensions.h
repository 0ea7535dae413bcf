#pragma once
// The extensions of a .spz: records of a type, a length and so many bytes, of any vendor. In
// version 4 between the header and the table of streams, before that after the last attribute.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/math/affine.h"

namespace voyager::spz {

// Of all records: a gzip stream may go on for a thousand times the bytes of the file, and one
// inside a glTF is read as often as it is placed.
inline constexpr size_t kMostExtensionBytes = 1 << 16;

struct Extensions {
  // From the axes that SPZ has without a word about them (right, up, back), in INRIA's axes, to
  // those that SPZ_ADOBE_coordinate_system says.
  Affine axes;
  bool says_axes = false;           // there is one
  std::vector<std::string> unread;  // what is not read, for people

  bool turns() const { return !(axes == Affine{}); }
};

// Throws Error(refused_input) for axes that are not known: nothing would be where it belongs.
// Anything else that cannot be read is named. `offset` is that of the first byte.
Extensions read_extensions(const std::string& file, uint64_t offset,
                           std::span<const std::byte> bytes);

}  // namespace voyager::spz
