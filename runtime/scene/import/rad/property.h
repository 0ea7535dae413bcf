#pragma once
// The properties of a .rad's chunk: what each is called, how many numbers a Gaussian has of it, and
// how they are encoded.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "runtime/scene/import/json_value.h"

namespace voyager::rad {

enum class Encoding {
  f32,
  f16,
  f32_lebytes,  // the lowest bytes of all numbers, then the next ones
  f16_lebytes,
  r8,        // 0 to 255 for min to max
  r8_delta,  // the difference from the Gaussian before
  s8,        // -127 to 127 for -max to max
  s8_delta,
  ln_0r8,  // 0 for 0, 1 to 255 for the logarithms min to max
  ln_f16,
  oct88r8,  // an axis in two bytes, an angle in one
  u16,
  u32,
};

enum class Kind {
  center,
  alpha,
  rgb,
  scales,
  orientation,
  sh1,
  sh2,
  sh3,
  child_count,
  child_start,
};
inline constexpr size_t kKinds = 10;

struct Property {
  Kind kind{};
  Encoding encoding{};
  float min = 0, max = 0;          // where the encoding has them
  bool is_deflated = false;        // raw deflate
  uint64_t offset = 0, bytes = 0;  // as stored, in the payload
};

size_t numbers_of(Kind kind);  // a Gaussian's

// A property is a sequence of planes: in each an element of so many bytes for each Gaussian.
struct Planes {
  size_t count, element_bytes;
};
Planes planes_of(const Property& property);
inline size_t plain_bytes_of(const Property& property) {
  const Planes planes = planes_of(property);
  return planes.count * planes.element_bytes;
}

// By kind, each at most once: those of Gaussians of that SH degree, and of a tree's nodes. Throws
// Error(refused_input) by name for any that is missing, unknown, of tables of SH, or encoded in
// another way. `payload` is the size of what they lie in.
using Properties = std::array<std::optional<Property>, kKinds>;
Properties read_properties(const JsonValue& json, int sh_degree, bool is_tree, uint64_t payload);

}  // namespace voyager::rad
