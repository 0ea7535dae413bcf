#include "runtime/scene/import/ply_elements.h"

#include "runtime/scene/import/refuse.h"

namespace voyager::ply {

uint64_t bytes_of(const PeekReader& input, const Element& element) {
  uint64_t bytes = 0;
  if (__builtin_mul_overflow(element.count, uint64_t{element.stride}, &bytes) || bytes > INT64_MAX)
    refuse(input.name(), input.offset(), "element " + element.name,
           std::to_string(element.count) + " rows of " + std::to_string(element.stride) + " bytes",
           "less than 2^63 bytes in all");
  return bytes;
}

void check_length(const PeekReader& input, const Header& header) {
  uint64_t expected = 0;
  bool open_ended = false;
  for (const Element& element : header.elements) {
    open_ended = open_ended || element.has_list;
    if (open_ended) continue;
    if (__builtin_add_overflow(expected, bytes_of(input, element), &expected))
      refuse(input.name(), input.offset(), "elements", "more than 2^64 bytes", "less");
  }
  const std::optional<uint64_t> found = input.remaining();
  if (!found) return;
  const Element& vertex = header.elements[header.vertex];
  if (*found < expected || (*found > expected && !open_ended))
    refuse(input.name(), input.offset(), "elements", std::to_string(*found) + " bytes",
           std::to_string(expected) + " bytes (vertex: " + std::to_string(vertex.count) +
               " rows of " + std::to_string(vertex.stride) + ")");
}

void skip(PeekReader& input, const Element& element) {
  const uint64_t expected = bytes_of(input, element), found = input.skip(expected);
  if (found != expected)
    refuse(input.name(), input.offset(), "element " + element.name,
           std::to_string(found) + " bytes", std::to_string(expected) + " bytes");
}

void skip_the_rest(PeekReader& input, const Header& header, size_t first) {
  for (size_t i = first; i < header.elements.size(); ++i) {
    if (header.elements[i].has_list) return;
    skip(input, header.elements[i]);
  }
  if (!input.peek(1).empty())
    refuse(input.name(), input.offset(), "elements", "more bytes",
           "the end of the file after the last element");
}

}  // namespace voyager::ply
