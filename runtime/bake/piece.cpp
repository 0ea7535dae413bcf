#include "runtime/bake/piece.h"

namespace voyager {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void Piece::append(const Piece& next) {
  if (next.empty()) return;
  if (empty()) {
    *this = next;
    return;
  }
  hull = join(hull, next.hull);
  const auto records = static_cast<uint32_t>(chunk.records.size());
  for (const uint32_t record : next.chunk.record) chunk.record.push_back(records + record);
  voyager::append(chunk.subtrees, next.chunk.subtrees);
  voyager::append(chunk.records, next.chunk.records);
  voyager::append(chunk.words, next.chunk.words);
  voyager::append(chunk.sh, next.chunk.sh);
  voyager::append(chunk.node_code, next.chunk.node_code);
  voyager::append(chunk.source_index, next.chunk.source_index);
  voyager::append(chunk.position_words, next.chunk.position_words);
}

ChunkEntry entry_of(const Piece& piece, const EncodedChunk& encoded) {
  ChunkEntry entry{};
  entry.checksum = encoded.checksum;
  entry.bytes = static_cast<uint32_t>(encoded.bytes.size());
  entry.first_subtree = piece.chunk.first_subtree;
  entry.subtree_count = static_cast<uint32_t>(piece.chunk.subtrees.size());
  entry.node_count = static_cast<uint32_t>(piece.chunk.words.size());
  entry.record_count = static_cast<uint32_t>(piece.chunk.records.size());
  entry.place = piece.place;
  entry.hull = piece.hull;
  return entry;
}

void pack(const Piece& piece, Packer& packer) {
  const Chunk& chunk = piece.chunk;
  packer.put(chunk.first_subtree).put(piece.place).put(piece.hull);
  packer.put_all(chunk.subtrees).put_all(chunk.records).put_all(chunk.record);
  packer.put_all(chunk.words).put_all(chunk.sh).put_all(chunk.node_code);
  packer.put_all(chunk.source_index).put_all(chunk.position_words);
}

Piece unpack_piece(Unpacker& from) {
  Piece piece;
  Chunk& chunk = piece.chunk;
  chunk.first_subtree = from.take<uint32_t>();
  piece.place = from.take<SubtreePlace>();
  piece.hull = from.take<EntryHull>();
  from.take_all(chunk.subtrees);
  from.take_all(chunk.records);
  from.take_all(chunk.record);
  from.take_all(chunk.words);
  from.take_all(chunk.sh);
  from.take_all(chunk.node_code);
  from.take_all(chunk.source_index);
  from.take_all(chunk.position_words);
  return piece;
}

}  // namespace voyager
