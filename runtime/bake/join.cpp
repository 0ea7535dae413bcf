#include "runtime/bake/join.h"

#include "runtime/base/checksum.h"
#include "runtime/format/scene_header.h"
#include "runtime/lod/build.h"

namespace voyager {
namespace {

constexpr size_t kCopyBytes = size_t{4} << 20;

class Joiner {
 public:
  Joiner(const SplitInfo& split, const BakePlan& plan, const BakedScene& top, Quality quality,
         const WorkFolder& folder, const std::string& output, Workers& workers)
      : plan_(plan),
        top_(top),
        folder_(folder),
        workers_(workers),
        context_(encoding_context(split, quality)),
        file_(output) {
    totals_.quality = quality;
    totals_.sh_degree = split.spool.sh_degree;
    totals_.left_out_bands = split.spool.row_degree - split.spool.sh_degree;
    totals_.native = split.spool.native;
    totals_.native.levels = footprint_levels(top);
    totals_.leaf_count = split.spool.gaussians;
    totals_.chunk_bytes = plan.chunk_bytes();
    totals_.tiers = plan.tiers();
    totals_.origin = split.origin;
    totals_.source_origin = split.spool.source_origin;
    totals_.bounds_min = top.tree.records[0].box_min;
    totals_.bounds_max = top.tree.records[0].box_max;
    totals_.import = split.spool.import;
    entries_.reserve(plan.chunk_count());
    end_ = bytes_before_chunks(plan.tiers(), plan.chunk_count(), quality);
  }

  void run(const Progress& progress) {
    const Tiers tiers = plan_.tiers();
    for (uint32_t tier = 0; tier < tiers.tier_count(); ++tier) {
      report(progress, "writing", entries_.size(), plan_.chunk_count());
      tier < plan_.first_cell_tier() ? add_top_tier(tier) : add_cell_tier(tier);
    }
    if (!open_.empty()) finish_open();
    write_finished();
    report(progress, "writing", plan_.chunk_count(), plan_.chunk_count());
    file_.write_at(0, encode_head(totals_, entries_, end_));
    file_.commit();
  }

 private:
  // Whole chunks that lie in a cell's file as they will in the scene's.
  struct Copy {
    const CellChunks* from;
    uint64_t at;
    size_t first, end;  // of entries_
  };

  void add_top_tier(uint32_t tier) {
    const uint32_t levels = tier == 0 ? plan_.tiers().first_tier_levels : kTierLevels;
    const Segment& segment = plan_.segments(tier).front();
    const auto level_of = [&](uint32_t node) {
      const auto begins = plan_.tiers().level_begin;
      return std::upper_bound(begins.begin(), begins.end(), node) - begins.begin();
    };
    const uint32_t first = segment.place.next[0];
    const uint32_t end = plan_.tiers().level_begin[static_cast<size_t>(level_of(first))];
    std::vector<std::byte> bytes;
    const EncodedSegment encoded =
        encode_segment(segment, {top_, levels, first, end, nullptr, nullptr}, plan_.chunk_bytes(),
                       context_, workers_, [&](const std::vector<std::byte>& chunk) {
                         bytes.insert(bytes.end(), chunk.begin(), chunk.end());
                       });
    take(encoded);
    if (encoded.entries.empty()) return;
    file_.write_at(entries_[entries_.size() - encoded.entries.size()].offset, bytes);
  }

  void add_cell_tier(uint32_t tier) {
    const uint32_t index = tier - plan_.first_cell_tier();
    std::vector<std::unique_ptr<CellChunks>> cells(plan_.cells());
    std::vector<Copy> copies;
    // A few at a time: what lies between the cells is held until the next tier.
    constexpr uint32_t kAtOnce = 64;
    for (uint32_t begin = 0; begin < plan_.cells(); begin += kAtOnce) {
      const uint32_t end = std::min(plan_.cells(), begin + kAtOnce);
      std::vector<EncodedSegment> segments(end - begin);
      workers_.for_blocks(segments.size(), 1, [&](size_t i, size_t) {
        const auto cell = begin + static_cast<uint32_t>(i);
        cells[cell] = std::make_unique<CellChunks>(plan_, cell, folder_);
        segments[i] = cells[cell]->read_tier(index);
      });
      for (uint32_t cell = begin; cell < end; ++cell) {
        const EncodedSegment& segment = segments[cell - begin];
        take(segment);
        add_copies(*cells[cell], cells[cell]->bytes_of_tier(index), segment.entries.size(), copies);
      }
      workers_.for_blocks(copies.size(), 1, [&](size_t i, size_t) { copy(copies[i]); });
      copies.clear();
      write_finished();
      for (uint32_t cell = begin; cell < end; ++cell) cells[cell].reset();
    }
  }

  // Places the chunks of a segment behind those so far.
  void take(const EncodedSegment& segment) {
    open_.append(segment.head);
    if (segment.tail.empty()) return;
    if (!open_.empty()) finish_open();
    for (ChunkEntry entry : segment.entries) {
      entry.offset = end_;
      end_ += entry.bytes;
      entries_.push_back(entry);
    }
    note(segment);
    open_ = segment.tail;
  }

  void finish_open() {
    EncodedChunk encoded = encode_chunk(open_.chunk, context_);
    ChunkEntry entry = entry_of(open_, encoded);
    entry.offset = end_;
    end_ += entry.bytes;
    entries_.push_back(entry);
    note(encoded);
    finished_.emplace_back(entry.offset, std::move(encoded.bytes));
    open_ = {};
  }

  void write_finished() {
    for (const auto& [offset, bytes] : finished_) file_.write_at(offset, bytes);
    finished_.clear();
  }

  // Of an encoded segment or chunk.
  template <class Encoded>
  void note(const Encoded& encoded) {
    totals_.position_error = std::max(totals_.position_error, encoded.position_error);
    totals_.largest_sh = std::max(totals_.largest_sh, encoded.largest_sh);
    totals_.leaves_have_extent |= encoded.leaves_have_extent;
  }

  // Of the last `count` entries, in parts that one thread copies.
  void add_copies(const CellChunks& from, uint64_t at, size_t count, std::vector<Copy>& copies) {
    const size_t first = entries_.size() - count;
    for (size_t begin = first, end = first; begin < entries_.size(); begin = end) {
      uint64_t bytes = 0;
      do bytes += entries_[end++].bytes;
      while (end < entries_.size() && bytes < kCopyBytes);
      copies.push_back({&from, at, begin, end});
      at += bytes;
    }
  }

  void copy(const Copy& copy) {
    const uint64_t offset = entries_[copy.first].offset;
    std::vector<std::byte> bytes(entries_[copy.end - 1].offset + entries_[copy.end - 1].bytes -
                                 offset);
    copy.from->source().read(copy.at, bytes);
    for (size_t i = copy.first; i < copy.end; ++i) {
      const ChunkEntry& e = entries_[i];
      if (checksum(std::span(bytes).subspan(e.offset - offset, e.bytes)) != e.checksum)
        refuse_folder(copy.from->source().name(), "another checksum of a chunk",
                      std::to_string(e.checksum));
    }
    file_.write_at(offset, bytes);
  }

  const BakePlan& plan_;
  const BakedScene& top_;
  const WorkFolder& folder_;
  Workers& workers_;
  ChunkContext context_;
  AtomicFile file_;
  SceneTotals totals_;
  std::vector<ChunkEntry> entries_;
  uint64_t end_ = 0;                                                   // of the chunks so far
  Piece open_;                                                         // the chunk that may go on
  std::vector<std::pair<uint64_t, std::vector<std::byte>>> finished_;  // encoded here
};

}  // namespace

void join_cells(const SplitInfo& split, const BakePlan& plan, const BakedScene& top,
                Quality quality, const WorkFolder& folder, const std::string& output,
                Workers& workers, const Progress& progress) {
  Joiner(split, plan, top, quality, folder, output, workers).run(progress);
}

}  // namespace voyager
