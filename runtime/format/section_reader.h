#pragma once
// A section of a .voy as it comes. Its length is only what a header claims, so it is read in
// pieces, each as long as all before it: it takes no more time than twice what has been read and
// found right, and no more room than a piece.
#include <algorithm>
#include <vector>

#include "runtime/base/checksum.h"
#include "runtime/format/layout.h"
#include "runtime/format/refusal.h"

namespace voyager {

class SectionReader {
 public:
  // Throws Error(refused_input) where the header says anything else of the section.
  SectionReader(const ByteSource& source, const Section& section, SectionKind kind, uint64_t offset,
                uint64_t length, const Check& check);

  // The whole section: `count` items, and zeros. accept(item, index) of each in turn, which
  // throws where it cannot be right; of the last piece only after the checksum of all was.
  template <class Item, class Accept>
  void each(uint64_t count, const Accept& accept) {
    std::vector<Item> piece;
    uint64_t had = 0;
    do {
      const uint64_t most = std::clamp(had, kLeastPiece / sizeof(Item), kMostPiece / sizeof(Item));
      piece.resize(std::min(count - had, most));
      read_piece(std::as_writable_bytes(std::span(piece)));
      if (had + piece.size() == count) finish();
      for (const Item& item : piece) accept(item, had++);
    } while (had < count);
  }

 private:
  static constexpr uint64_t kLeastPiece = 1 << 20, kMostPiece = 1 << 24;  // bytes

  void read_piece(std::span<std::byte> bytes);
  void finish();

  const ByteSource& source_;
  const Section& section_;
  const Check& check_;
  uint64_t next_, end_;  // in the file
  RunningChecksum sum_;
};

}  // namespace voyager
