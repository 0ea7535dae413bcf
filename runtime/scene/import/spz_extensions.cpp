#include "runtime/scene/import/spz_extensions.h"

#include <cstdio>

#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::spz {
namespace {

constexpr uint32_t kSafeOrbitCamera = 0xadbe0002, kCoordinateSystem = 0xadbe0003;

// Where x, y and z point, by the extension's number.
constexpr const char* kAxes[] = {nullptr, "LDB", "RDB", "LUB", "RUB", "LDF", "RDF", "LUF", "RUF",
                                 "LFD",   "RFD", "LFU", "RFU", "LBD", "RBD", "LBU", "RBU"};
constexpr uint32_t kUsual = 4;  // RUB

// In INRIA's axes: x right, y down, z forward.
Vec3d direction(char letter) {
  switch (letter) {
    case 'L':
      return {-1, 0, 0};
    case 'R':
      return {1, 0, 0};
    case 'U':
      return {0, -1, 0};
    case 'D':
      return {0, 1, 0};
    case 'B':
      return {0, 0, -1};
    default:
      return {0, 0, 1};
  }
}

// What was taken for right, up, back is turned to where it is.
Affine axes_of(uint32_t system) {
  Affine axes;
  for (int column = 0; column < 3; ++column) {
    const Vec3d to = direction(kAxes[system][column]);
    const double sign = column == 0 ? 1 : -1;  // of the usual axes in INRIA's
    for (int row = 0; row < 3; ++row) axes.linear.row[row][column] = sign * to[row];
  }
  for (auto& row : axes.linear.row)
    for (int column = 0; column < 3; ++column) row[column] += 0.0;  // without -0
  return axes;
}

std::string named(uint32_t type, size_t bytes) {
  if (type == kSafeOrbitCamera)
    return "the extension SPZ_ADOBE_safe_orbit_camera (limits of a viewer's camera)";
  char text[64];
  std::snprintf(text, sizeof text, "an unknown extension 0x%08x (%zu bytes)", type, bytes);
  return text;
}

}  // namespace

Extensions read_extensions(const std::string& file, uint64_t offset,
                           std::span<const std::byte> bytes) {
  Extensions found;
  for (size_t at = 0; at < bytes.size();) {
    const auto rest = bytes.subspan(at);
    const size_t length = rest.size() < 8 ? 0 : load<uint32_t>(&rest[4]);
    if (rest.size() < 8 || length > rest.size() - 8) {
      found.unread.push_back(std::to_string(rest.size()) + " bytes of extensions without an order");
      break;
    }
    const uint32_t type = load<uint32_t>(rest.data());
    if (type == kCoordinateSystem && length == 4) {
      const uint32_t system = load<uint32_t>(&rest[8]);
      if (system >= std::size(kAxes))
        refuse(file, offset + at + 8, "coordinate system", std::to_string(system), "0 to 16");
      found.axes = axes_of(system == 0 ? kUsual : system);
      found.says_axes = system != 0;
    } else {
      found.unread.push_back(named(type, length));
    }
    at += 8 + length;
  }
  return found;
}

}  // namespace voyager::spz
