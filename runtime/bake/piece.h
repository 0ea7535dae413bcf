#pragma once
// A part of a chunk: consecutive subtrees with what the directory says of them. The
// chunks that begin in one segment and end in another are put together from these.
#include "runtime/bake/sealed_file.h"
#include "runtime/format/chunk_codec.h"

namespace voyager {

struct Piece {
  Chunk chunk;           // as encode_chunk() takes it
  SubtreePlace place{};  // before its first subtree
  EntryHull hull{};

  bool empty() const { return chunk.subtrees.empty(); }
  void append(const Piece& next);  // which follows directly
};

// All but the place of the bytes in the file.
ChunkEntry entry_of(const Piece& piece, const EncodedChunk& encoded);

void pack(const Piece& piece, Packer& packer);
Piece unpack_piece(Unpacker& from);

}  // namespace voyager
