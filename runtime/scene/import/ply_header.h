#pragma once
// The text that begins a .ply: which elements follow, and how each is laid out.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/scene/import/peek_reader.h"
#include "runtime/scene/native_scale.h"

namespace voyager::ply {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
size_t size_of(Type type);

struct Property {
  std::string name;
  Type type;
  size_t offset;  // in the row, bytes
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
  bool has_list = false;  // then rows have no fixed size
  size_t stride = 0;      // bytes a row, lists not counted

  const Property* find(const std::string& property) const;
};

struct Header {
  bool big_endian = false;
  std::vector<Element> elements;
  NativeScale native;  // what a comment says of the training
  size_t vertex = 0;   // index of the element that holds the Gaussians
};

// Leaves `input` at the first byte of the first element. Refuses ASCII, a list
// in or before the vertex element, and a header longer than 256 KiB.
Header read_header(PeekReader& input);

}  // namespace voyager::ply
