#pragma once
// The streaming and the temporal search (docs/lod-selection.md): one state, so that
// each continues what the other found.
#include <array>
#include <atomic>
#include <cstdint>
#include <memory_resource>
#include <mutex>
#include <span>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/select/references.h"
#include "runtime/select/search.h"
#include "runtime/select/visit.h"

namespace voyager {

// One view's cut of one tree, kept from run to run. Not thread-safe; the work is
// spread over `workers`, and no result depends on their number. It keeps fixed_bytes() and
// kPlaceBytes a place of the tree's subtrees, from the resource for state. From that for scratch it
// takes 4 bytes a node of the largest cut, where that is listed, and lists of subtrees, each as
// long as the longest change that it has seen; once they were seen a run allocates nothing, until a
// pool has another number of places. Throws only std::bad_alloc; the next run then starts from
// nothing, and is right.
class PartitionedSearch {
 public:
  // Consecutive subtrees of one tier. Their cut nodes are in cut() in three pieces:
  // roots, children, grandchildren.
  struct Block {
    uint32_t first, last;  // subtrees [first, last)
    uint32_t tier;
    uint32_t open;                 // subtrees
    uint32_t stand_ins;            // nodes
    std::array<uint32_t, 3> size;  // of each piece, nodes
    std::array<uint32_t, 3> at;    // where each piece starts in cut()
  };

  // The tree must outlive the search. state: null for the same. lists_cut: else cut() is empty, for
  // those who list it as they weigh it (weigh_cut.h).
  explicit PartitionedSearch(const SearchTree& tree,
                             std::pmr::memory_resource* memory = std::pmr::get_default_resource(),
                             std::pmr::memory_resource* state = nullptr, bool lists_cut = true);

  // kind: streaming or one of the temporal ones.
  void run(const CutQuery& query, Search kind, Workers& workers);
  // The next run starts from nothing.
  void forget() { known_ = false; }
  // And what goes by place is freed until then.
  void drop() noexcept;
  // Between two runs the tree has changed, and is what it is now: nothing led to the subtrees of
  // `unlinked` for a time, or does now, and those of `changed` have a record that is blocked, or
  // no longer is. Where it has another number of places, forget() comes first.
  void relink(std::span<const uint32_t> unlinked, std::span<const uint32_t> changed);

  // Results of the last run, valid until the next.
  // Node ids, ascending. Where needed_missing() is a node, what is below it and its
  // siblings is left out.
  const std::pmr::vector<uint32_t>& cut() const { return cut_; }
  size_t cut_size() const { return cut_size_; }
  // False: the cut is what the run before left.
  bool relisted() const { return relisted_; }
  const SearchStats& stats() const { return stats_; }
  // The first of the missing subtrees that this cut needs, and its root: the smallest
  // of their roots. kNoNode if the cut is whole.
  uint32_t needed_missing_subtree() const { return needed_missing_; }
  uint32_t needed_missing() const {
    return needed_missing_ == kNoNode ? kNoNode : tree_.subtree(needed_missing_).root;
  }
  // The cut, subtree by subtree.
  std::span<const Block> blocks() const { return blocks_; }
  uint32_t cut_slots(uint32_t subtree) const { return cut_slots_[places_(subtree)]; }

  // What it keeps for each place, where chunks come and go, and beside that.
  static constexpr uint64_t kPlaceBytes =
      sizeof(Watch) + 3 * sizeof(uint32_t) + sizeof(uint8_t) + 1;
  static uint64_t fixed_bytes(const SearchTree& tree);

 private:
  // What a task counts; sums, so that their order does not matter.
  struct Tally {
    uint64_t tested = 0, visited = 0, chunks = 0, bytes = 0, entered = 0, left = 0;
    uint32_t needed_missing = kNoNode;                 // a subtree
    uint32_t first_opened = kNoNode, last_opened = 0;  // subtrees, of a tier that is streamed
  };

  void make_room();
  void begin(const CutQuery& query);
  void finish(Workers& workers);
  void count(const Tally& tally);
  size_t block_of(uint32_t subtree) const;
  void touch(size_t block);
  bool mark_read(uint32_t chunk);
  // Where a task is in the file: subtrees ascend.
  struct AtChunk {
    uint32_t chunk = 0, end = 0;  // the first subtree behind it
  };
  void read_chunk_of(uint32_t subtree, AtChunk& at, Tally& tally);
  uint32_t look(uint32_t subtree, Tally& tally);
  void close(uint32_t subtree);
  uint64_t count_stand_ins() const;

  // streaming.cpp
  void stream(Workers& workers);
  void start_over(Workers& workers);
  void clear(Workers& workers);
  void stream_tier(uint32_t first, uint32_t last, Workers& workers);
  void stream_chunk(uint32_t chunk, uint32_t first, uint32_t last, Tally& tally);
  void open(uint32_t subtree, Tally& tally);

  // temporal.cpp
  void repair(Search kind, Workers& workers);
  uint64_t list_due(Search kind, Workers& workers);
  bool renew(uint32_t place);
  bool streaming_is_cheaper(uint64_t due) const;
  void visit_due(Workers& workers);
  void close_signalled(Workers& workers);
  void visit_opened(Workers& workers);
  void visit_round(size_t begin, size_t end);
  void gather_opened(size_t lists);

  // settle.cpp
  void settle(size_t index, Tally& tally);
  void list_cut(Workers& workers);
  void list_block(const Block& block);

  const SearchTree& tree_;
  References references_;
  Sight sight_{};
  CutQuery query_{};
  bool known_ = false;      // the state below is that of a whole run at query_
  bool continues_ = false;  // and was so before the run in progress
  bool relinked_ = false;   // since then
  bool relisted_ = false;

  SubtreePlaces places_{};
  // By a subtree's place. A closed one: kNever, 0, 0.
  std::pmr::vector<Watch> watch_;
  std::pmr::vector<uint32_t> refined_;    // bits of slots, and kOpen
  std::pmr::vector<uint32_t> cut_slots_;  // bits of slots
  std::pmr::vector<uint32_t> last_cut_slots_;
  std::pmr::vector<uint8_t> stand_ins_;  // nodes; empty where no record is ever blocked
  // Of a run of subtrees: those that are due, and what visits open and close. Lists are scratch.
  struct Changes {
    explicit Changes(std::pmr::memory_resource* memory)
        : due(memory), opened(memory), closed(memory) {}
    std::pmr::vector<uint32_t> due, opened, closed;
  };
  std::pmr::vector<Changes> changes_;  // by block, then by run of opened_
  std::pmr::vector<uint32_t> opened_;  // in the last round; scratch
  std::pmr::vector<Block> blocks_;
  std::pmr::vector<uint32_t> tier_block_;   // first block of each tier
  std::pmr::vector<uint8_t> touched_;       // by block: visited or closed something
  std::pmr::vector<uint32_t> chunk_stamp_;  // the last run that read each chunk
  uint32_t stamp_ = 0;

  std::pmr::vector<uint32_t> cut_;
  const bool lists_cut_;
  size_t cut_size_ = 0;
  std::mutex total_mutex_;
  Tally total_;
  SearchStats stats_;
  uint32_t needed_missing_ = kNoNode;  // a subtree
};

}  // namespace voyager
