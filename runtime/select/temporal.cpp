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

// Each block's, in work_ from a place on that leaves room for all of its open subtrees.
uint64_t PartitionedSearch::list_due(Search kind, Workers& workers) {
  const Travel* travel = references_.travel().data();
  uint32_t room = 0;
  for (size_t b = 0; b < blocks_.size(); ++b) {
    signals_[b].first = room;
    room += blocks_[b].open;
  }
  const bool all = kind == Search::temporal_visit;
  workers.for_blocks(blocks_.size(), kBlocksTask, [&](size_t begin, size_t end) {
    Tally tally;
    for (size_t b = begin; b < end; ++b) {
      const Block& block = blocks_[b];
      uint32_t out = signals_[b].first;
      if (block.open != 0) {
        tally.bytes += (block.last - block.first) * sizeof(Watch);
        each_place(places_, block.first, block.last, [&](uint32_t s, uint32_t place) {
          if (all ? refined_[place] != 0 : due(watch_[place], travel) && !renew(place))
            work_[out++] = s;
        });
      }
      signals_[b].visits = out - signals_[b].first;
    }
    count(tally);
  });
  uint64_t listed = 0;
  for (size_t b = 0; b < blocks_.size(); ++b) listed += signals_[b].visits;
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
    uint32_t chunk = kNoChunk;
    for (size_t b = begin; b < end; ++b) {
      Signals& signals = signals_[b];
      signals.opened.clear(), signals.closed.clear();
      if (signals.visits == 0) continue;
      touch(b);
      for (uint32_t i = 0; i < signals.visits; ++i) {
        const uint32_t s = work_[signals.first + i];
        read_chunk_of(s, chunk, tally);
        const uint32_t flipped = look(s, tally);
        signal_below(
            tree_, s, flipped, refined_[places_(s)],
            [&](uint32_t from, uint32_t to) { append(signals.opened, from, to); },
            [&](uint32_t from, uint32_t to) { append(signals.closed, from, to); });
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
      for (const uint32_t s : signals_[b].closed) {
        close(s);
        touch(block_of(s));
      }
  });
}

void PartitionedSearch::visit_opened(Workers& workers) {
  for (uint32_t count = gather_opened(blocks_.size()); count != 0;) {
    workers.for_blocks(count, kRoundSubtrees,
                       [&](size_t begin, size_t end) { visit_round(begin, end); });
    count = gather_opened((count + kRoundSubtrees - 1) / kRoundSubtrees);
  }
}

// Subtrees work_[begin, end), which were closed.
void PartitionedSearch::visit_round(size_t begin, size_t end) {
  Tally tally;
  uint32_t chunk = kNoChunk;
  std::pmr::vector<uint32_t>& opened = signals_[begin / kRoundSubtrees].opened;
  opened.clear();
  for (size_t i = begin; i < end; ++i) {
    const uint32_t s = work_[i];
    if (tree_.subtree(s).missing()) {
      tally.needed_missing = std::min(tally.needed_missing, s);
      continue;
    }
    touch(block_of(s));
    read_chunk_of(s, chunk, tally);
    const uint32_t flipped = look(s, tally);
    signal_below(
        tree_, s, flipped, refined_[places_(s)],
        [&](uint32_t from, uint32_t to) { append(opened, from, to); }, [](uint32_t, uint32_t) {});
  }
  count(tally);
}

// To the front of work_, ascending.
uint32_t PartitionedSearch::gather_opened(size_t lists) {
  uint32_t gathered = 0;
  for (size_t i = 0; i < lists; ++i) {
    const auto& opened = signals_[i].opened;
    std::copy(opened.begin(), opened.end(), work_.begin() + gathered);
    gathered += static_cast<uint32_t>(opened.size());
  }
  return gathered;
}

}  // namespace voyager
