#pragma once
// A section of a .voy as it comes. Its length is only what a header claims, so it is read in
// pieces, each as long as all before it: it takes no more time than twice what has been read and
// found right, and no more room than a piece.
#include <algorithm>
#include <span>
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
      const uint64_t some = std::min(count - had, most), bytes = some * sizeof(Item);
      // With the zeros behind it, so that a server is not asked for these alone.
      const uint64_t read = had + some == count ? end_ - next_ : bytes;
      piece.resize((read + sizeof(Item) - 1) / sizeof(Item));
      const auto into = std::as_writable_bytes(std::span(piece)).first(read);
      read_piece(into);
      if (had + some == count) finish(into.subspan(bytes));
      for (uint64_t i = 0; i < some; ++i) accept(piece[i], had++);
    } while (had < count);
  }

 private:
  static constexpr uint64_t kLeastPiece = 1 << 20, kMostPiece = 1 << 24;  // bytes

  void read_piece(std::span<std::byte> bytes);
  void finish(std::span<const std::byte> padding);

  const ByteSource& source_;
  const Section& section_;
  const Check& check_;
  uint64_t next_, end_;  // in the file
  RunningChecksum sum_;
};

}  // namespace voyager
