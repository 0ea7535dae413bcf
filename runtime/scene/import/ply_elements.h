#pragma once
// The rows of a .ply's elements: how many bytes there are, and the words in them.
#include <memory>

#include "runtime/scene/import/load.h"
#include "runtime/scene/import/ply_header.h"

namespace voyager::ply {

// A .ply whose header was read.
struct Input {
  // `reader` must outlive it.
  explicit Input(ByteReader& reader) : bytes(reader), header(read_header(bytes)) {}
  explicit Input(std::unique_ptr<ByteReader> reader) : Input(*reader) { owned = std::move(reader); }

  std::unique_ptr<ByteReader> owned;
  PeekReader bytes;
  Header header;
};

// Bytes of an element; refuses a count whose product with the stride overflows.
uint64_t bytes_of(const PeekReader& input, const Element& element);

// Where the length of the stream is known, the header is held to it before anything is read.
// `input` stands at the first element.
void check_length(const PeekReader& input, const Header& header);

// Steps over the rows of an element, refusing an end before the last.
void skip(PeekReader& input, const Element& element);

// Steps over the elements from `first` on, as far as their rows have a size, and refuses bytes
// after the last.
void skip_the_rest(PeekReader& input, const Header& header, size_t first);

}  // namespace voyager::ply
