#pragma once
// Numbers of a buffer, as an accessor describes them.
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "runtime/scene/import/gltf/file.h"

namespace voyager::gltf {

enum class Component : uint32_t {
  i8 = 5120,
  u8 = 5121,
  i16 = 5122,
  u16 = 5123,
  u32 = 5125,
  f32 = 5126
};

inline size_t bytes_of(Component component) {
  return component == Component::f32 || component == Component::u32   ? 4
         : component == Component::i16 || component == Component::u16 ? 2
                                                                      : 1;
}

struct Accessor {
  Slice bytes;  // from the first element on; without a source all numbers are 0
  uint64_t count = 0;
  size_t width = 1;   // numbers of an element
  size_t stride = 0;  // bytes from one element to the next
  Component component = Component::f32;
  bool normalised = false;

  size_t element() const { return width * bytes_of(component); }
  // Bytes of so many consecutive elements, at least one.
  size_t span_of(size_t elements) const { return (elements - 1) * stride + element(); }
  // Number i of the element that begins there. A normalised integer is -1 to 1, or 0 to 1.
  double number(std::span<const std::byte> element, size_t i) const;
  // Elements [first, first + count), which are within the accessor: span_of(count) bytes.
  void read(uint64_t first, std::span<std::byte> into) const;
};

// `index`: a JSON number. Throws Error(refused_input) naming place, found and expected for what
// reaches beyond its buffer, and for a sparse accessor.
Accessor read_accessor(File& file, const JsonValue& index);

}  // namespace voyager::gltf
