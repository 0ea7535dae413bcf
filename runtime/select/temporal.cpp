// From the last cut: what may have changed is visited, then what that opens.
#include <algorithm>

#include "runtime/select/partitioned.h"
#include "runtime/select/partitioned_blocks.h"
#include "runtime/select/signal.h"

namespace voyager {
namespace {

// Subtrees [first, last).
void append(std::pmr::vector<uint32_t>& list, uint32_t first, uint32_t last) {
  for (uint32_t s = first; s < last; ++s) list.push_back(s);
}

}  // namespace

void PartitionedSearch::repair(Search kind, Workers& workers) {
  const uint64_t due = list_due(kind, workers);
  if (kind == Search::temporal && streaming_is_cheaper(due)) return stream(workers);
  visit_due(workers);
  close_signalled(workers);
  visit_opened(workers);
}

uint64_t PartitionedSearch::list_due(Search kind, Workers& workers) {
  const Travel* travel = references_.travel().data();
  const bool all = kind == Search::temporal_visit;
  workers.for_blocks(blocks_.size(), kBlocksTask, [&](size_t begin, size_t end) {
    Tally tally;
    for (size_t b = begin; b < end; ++b) {
      const Block& block = blocks_[b];
      std::pmr::vector<uint32_t>& found = changes_[b].due;
      found.clear();
      if (block.open == 0) continue;
      tally.bytes += (block.last - block.first) * sizeof(Watch);
      each_place(places_, block.first, block.last, [&](uint32_t s, uint32_t place) {
        if (all ? refined_[place] != 0 : due(watch_[place], travel) && !renew(place))
          found.push_back(s);
      });
    }
    count(tally);
  });
  uint64_t listed = 0;
  for (size_t b = 0; b < blocks_.size(); ++b) listed += changes_[b].due.size();
  return listed;
}

// A subtree whose reference is forgotten in this frame keeps what slack is left.
bool PartitionedSearch::renew(uint32_t place) {
  Watch& watch = watch_[place];
  if (watch_reference(watch) != references_.current()) return false;
  const float slack = slack_left(watch, references_.retired());
  if (!(slack > 0.0f)) return false;
  watch.slack = slack;
  return true;
}

bool PartitionedSearch::streaming_is_cheaper(uint64_t due) const {
  uint64_t open = 0;
  for (const Block& block : blocks_) open += block.open;
  return static_cast<double>(due) > kStreamingShare * static_cast<double>(open);
}

void PartitionedSearch::visit_due(Workers& workers) {
  workers.for_blocks(blocks_.size(), kBlocksTask, [&](size_t begin, size_t end) {
    Tally tally;
    AtChunk at;
    for (size_t b = begin; b < end; ++b) {
      Changes& changes = changes_[b];
      changes.opened.clear(), changes.closed.clear();
      if (changes.due.empty()) continue;
      touch(b);
      for (const uint32_t s : changes.due) {
        read_chunk_of(s, at, tally);
        const uint32_t flipped = look(s, tally);
        signal_below(
            tree_, s, flipped, refined_[places_(s)],
            [&](uint32_t from, uint32_t to) { append(changes.opened, from, to); },
            [&](uint32_t from, uint32_t to) { append(changes.closed, from, to); });
      }
    }
    count(tally);
  });
}

// A subtree whose parent's verdict fell. Those below it need no word: their parents'
// verdicts fell as well, so they were due themselves and told their own.
void PartitionedSearch::close_signalled(Workers& workers) {
  workers.for_blocks(blocks_.size(), kBlocksTask, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b)
      for (const uint32_t s : changes_[b].closed) {
        close(s);
        touch(block_of(s));
      }
  });
}

void PartitionedSearch::visit_opened(Workers& workers) {
  for (gather_opened(blocks_.size()); !opened_.empty();) {
    const size_t count = opened_.size();
    workers.for_blocks(count, kRoundSubtrees,
                       [&](size_t begin, size_t end) { visit_round(begin, end); });
    gather_opened((count + kRoundSubtrees - 1) / kRoundSubtrees);
  }
}

// Subtrees opened_[begin, end), which were closed.
void PartitionedSearch::visit_round(size_t begin, size_t end) {
  Tally tally;
  AtChunk at;
  std::pmr::vector<uint32_t>& opened = changes_[begin / kRoundSubtrees].opened;
  opened.clear();
  for (size_t i = begin; i < end; ++i) {
    const uint32_t s = opened_[i];
    if (tree_.subtree(s).missing()) {
      tally.needed_missing = std::min(tally.needed_missing, s);
      continue;
    }
    touch(block_of(s));
    read_chunk_of(s, at, tally);
    const uint32_t flipped = look(s, tally);
    signal_below(
        tree_, s, flipped, refined_[places_(s)],
        [&](uint32_t from, uint32_t to) { append(opened, from, to); }, [](uint32_t, uint32_t) {});
  }
  count(tally);
}

// From the first so many lists; ascending.
void PartitionedSearch::gather_opened(size_t lists) {
  opened_.clear();
  for (size_t i = 0; i < lists; ++i) {
    const auto& opened = changes_[i].opened;
    opened_.insert(opened_.end(), opened.begin(), opened.end());
  }
}

}  // namespace voyager
