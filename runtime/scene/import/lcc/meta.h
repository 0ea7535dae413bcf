#pragma once
// What the JSON of an LCC scene (.lcc) says, versions 2 to 5.
#include <array>
#include <cstdint>
#include <optional>

#include "runtime/base/file.h"

namespace voyager::lcc {

// What the first and the last code of a value stand for, by axis or channel.
struct Bounds {
  std::array<float, 3> least{}, most{};
};

struct Meta {
  uint64_t levels = 0;         // of detail; 0 is the finest
  std::optional<bool> has_sh;  // nothing before version 4
  std::optional<Bounds> scale, sh, environment_scale, environment_sh;
  bool is_on_earth = false;  // says where on Earth the scene's zero is
};

// Throws Error(refused_input) naming the field.
Meta read_meta(const ByteSource& lcc);

}  // namespace voyager::lcc
