#pragma once
// The host's memory for one plane of an image.
#include <cstdint>
#include <string>

#include "plugin/field_name.h"
#include "plugin/result.h"

namespace voyager {

struct Plane {
  FieldName name;  // that of its pitch is the same and RowPitch
  const void* memory;
  uint64_t pitch;
  uint64_t pixel_bytes;
};

// The pitch in bytes, 0 replaced; throws where the plane could not lie in memory.
inline size_t checked_pitch(const Plane& plane, uint32_t width, uint32_t height) {
  const uintptr_t address = reinterpret_cast<uintptr_t>(plane.memory);
  if (address % 4 != 0)
    refuse(plane.name.str() +
           ": found an address that is not aligned to 4 bytes, expected alignment");
  const uint64_t packed = width * plane.pixel_bytes;
  const uint64_t pitch = plane.pitch == 0 ? packed : plane.pitch;
  if (pitch < packed || pitch % 4 != 0)
    refuse(plane.name.str() + "RowPitch: found " + std::to_string(pitch) +
           ", expected 0 or a multiple of 4 "
           "that is " +
           std::to_string(packed) + " or more");
  if (pitch > (UINTPTR_MAX - address) / height)
    refuse(plane.name.str() + "RowPitch: found " + std::to_string(pitch) + " for " +
           std::to_string(height) + " rows, expected rows that end within the address space");
  return pitch;
}

}  // namespace voyager
