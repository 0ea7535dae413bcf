#pragma once
// Which chunks are to be in a scene's slots: a function of who looks at it and of what is
// there. No I/O, no threads, no clock; every decision is the same on every machine.
// What is there once all of the target is, among what is needed, is a function of who looks and
// of the room alone, whatever was there before (docs/streaming.md).
//
// A chunk is needed where its entry hull, rounded, is at least τ* large (docs/lod-selection.md):
// only then may the cut hold a node of it. Where there are more than there are slots, the most
// urgent are the target: what is seen, then what is on the viewer's way, what a turn of the head
// shows, and what is around; of each what would be missed most, by the size of what stands in. A
// chunk is as urgent as the most urgent that hangs from it. Once all of the target is there nothing
// moves, but that what is needed and has no room goes: it was there by chance.
//
// Beside its slot a chunk takes blocks of search records, as many as it is found to need when it
// is read. The target takes no more of them than there are: what is not known yet counts as
// nothing, and where it proves to be too much the least urgent are left out (overfull()).
//
//     absent -> on its way -> read -> filled -> arriving -> resident -> absent
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "runtime/stream/by_chunk.h"
#include "runtime/stream/chunk_graph.h"
#include "runtime/stream/chunk_looks.h"
#include "runtime/stream/record_room.h"
#include "runtime/stream/shown_chunks.h"
#include "runtime/stream/sparse_array.h"

namespace voyager {

// Chunks.
struct ResidencyCounters {
  uint64_t requested = 0, arrived = 0, evicted = 0;
  uint64_t late = 0;     // of those that arrived: a viewer had seen that they were not there
  uint64_t flushed = 0;  // requests that were taken back, or had come for nothing
};

// Of the last plan, for the viewers that are not ahead: chunks, and their stored bytes. Of those
// that have failed, what hangs from them is not known to be needed. What a plan left out is counted
// as in the last whole plan.
struct ResidencyNeed {
  uint64_t chunks = 0, missing = 0, missing_bytes = 0;
  uint64_t seen = 0, seen_missing = 0;  // beside those that are pinned
  // Blocks that those take which have not failed: of what was read; and at most, of the others.
  uint64_t seen_blocks = 0, seen_unread_blocks = 0;
  std::vector<uint32_t> seen_failed;  // counted in all of these
};

class Residency {
 public:
  static constexpr uint32_t kNoSlot = 0xffffffffu;

  // All outlive it. pinned: so many of the first chunks stay; all without parents at least,
  // and no more than there is room for.
  Residency(const ChunkGraph& graph, const ChunkDirectory& chunks, const RecordRoom& records,
            PoolRoom room, uint32_t pinned);

  // Who looks now. What is no longer wanted is no longer requested. cuts_are_full: what is there
  // has no room in a view's cut, so that what nobody wants goes once the target is there.
  // in_haste: where far more is needed than there is room for, what was far from having room in the
  // last whole plan is left out, so that others wait less long. What is seen is never left out.
  // Once all that the plan asks for is there, a whole plan has to follow.
  void plan(ChunkLooks& looks, bool cuts_are_full, bool in_haste = false);
  // Whether the last plan did so.
  bool left_out() const { return left_out_; }
  // Nothing is to be read, or on its way to be resident. Not between begin_arrivals() and
  // end_arrival().
  bool is_quiet() const;
  // Those that the last plan needed: the next looks at them, and at what they lead to.
  std::vector<uint32_t> needed() const;

  // What is shown of what is resident, all viewers together. Only the order of requests goes by it:
  // what is seen, but hangs from nothing that was shown, comes behind what will be seen soon.
  void set_shown(ShownChunks shown);
  // Whether that is worth knowing: fewer are read within a frame or two in any order.
  bool wants_shown() const { return need_.seen_missing > 64 && !requests_.empty(); }

  // The most urgent chunks that are to be read: consecutive, at most `most`, and of at most
  // `bytes` in the file unless one alone has more. They are on their way then.
  ChunkRange take_requests(uint32_t most, uint64_t bytes);
  // A chunk that was on its way, and takes so many blocks. False: nobody wants it any more, and it
  // is absent.
  bool read(uint32_t chunk, uint32_t blocks);
  // As read(), of one that was read before.
  bool keep(uint32_t chunk);
  // A slot and blocks for a chunk that was read, to be filled; kNoSlot where they are not free.
  uint32_t take_slot(uint32_t chunk);
  // Those that it has, in their order.
  std::vector<uint32_t> blocks(uint32_t chunk) const;
  // By block that a chunk has, its next. The same array as long as this lives.
  const std::vector<uint32_t>& next_blocks() const { return next_block_; }
  void filled(uint32_t chunk);
  // An absent chunk takes a slot at once, as if it had been read; one must be free. Then its
  // blocks; false where they are not free.
  void place(uint32_t chunk);
  bool place_records(uint32_t chunk, uint32_t blocks);
  // A chunk that was on its way, or read, is not to be had, until retry().
  void failed(uint32_t chunk);
  void retry(uint32_t chunk);

  // Filled chunks that may become resident, parents before children, at most `most`; and those that
  // nobody wants any more. Costs by `most`, and by those that have to wait for what they hang from.
  struct Arrivals {
    std::vector<uint32_t> arriving, given_up;
  };
  Arrivals begin_arrivals(size_t most);
  // What has become of each of them, in their order. Before that nothing is planned.
  enum class Arrival : uint8_t { resident, failed, waiting };  // waiting: a parent has failed
  void end_arrival(uint32_t chunk, Arrival how);
  struct Evicted {
    uint32_t chunk, slot, first_block;
  };
  // Residents that make room for what is to come, children before parents, at most `most`. That is
  // taken again only after free(): when no frame reads it any more.
  std::vector<Evicted> evict(size_t most);
  // Whether evict() has something to do once the target is there: what is needed and has no room.
  bool has_leftovers() const;
  void free(const Evicted& evicted);
  // How many chunks wait for begin_arrivals().
  size_t to_arrive() const { return filled_.size(); }
  // How many chunks begin_arrivals() and evict() have to do with, or a few more.
  size_t changes() const;
  // The target takes more blocks than there are, which the next plan does something about.
  bool overfull() const { return target_blocks_ > room_.blocks; }

  // One node leads to all of these. True where the last plan has not known, and might have chosen
  // otherwise.
  bool set_family(ChunkRange family);

  uint32_t slot(uint32_t chunk) const { return known(chunk).slot; }
  bool is_resident(uint32_t chunk) const { return known(chunk).state == State::resident; }
  bool is_coming(uint32_t chunk) const {
    return known(chunk).state == State::read || known(chunk).state == State::filled;
  }
  // Of the last plan: a viewer of now sees what it holds.
  bool is_seen(uint32_t chunk) const {
    return known(chunk).needed_plan == plan_ && known(chunk).counted == kSeen;
  }
  bool is_wanted(uint32_t chunk) const {
    return known(chunk).target_plan == plan_ || chunk < pinned_;
  }
  uint32_t slots() const { return room_.slots; }
  PoolRoom room() const { return room_; }
  // Of what is pinned and was read.
  uint64_t pinned_blocks() const;
  uint32_t pinned() const { return pinned_; }
  uint32_t resident() const { return resident_; }
  const ResidencyNeed& need() const { return need_; }
  // All of the target is there, but for what failed, or is hopeless(chunk); and no plan has to
  // follow the last one.
  bool settled(const std::function<bool(uint32_t)>& hopeless) const;
  const ResidencyCounters& counters() const { return counters_; }

 private:
  static constexpr uint32_t kUnknown = 0xffffffffu, kNoBlock = 0xffffffffu;
  static constexpr uint8_t kSeen = 2;
  static constexpr uint32_t kMany = 0xff;

  enum class State : uint8_t { absent, on_its_way, read, filled, arriving, resident, failed };
  // Of a chunk that is not absent, or that the last plan needed or might have needed.
  struct Known {
    State state = State::absent;
    uint8_t counted = 0;      // in need_, if the last plan needed it; kSeen: as seen, too
    bool leaves : 1 = false;  // scratch
    bool was_read : 1 = false;
    bool hidden : 1 = false;  // where it is not resident: as order_requests() found it last
    float score = 0;          // scratch
    uint32_t slot = kNoSlot;
    uint32_t first_block = kNoBlock;
    uint32_t blocks = kUnknown;  // how many it takes; before it was read, at most
    uint32_t urgency = 0;        // when it was last needed
    uint32_t own_urgency = 0;    // in the last plan that needed it; 0: for what hangs from it
    uint32_t needed_plan = 0;    // the last plan that needed it
    uint32_t target_plan = 0;    // the last plan that had it in its target
    uint32_t children_there = 0;
  };
  struct Needed {
    uint32_t chunk, urgency;
    bool now;
  };
  struct Climb {
    Needed of;
    uint32_t from;  // its parents before this one are done
  };

  void consider(ChunkLooks& looks);
  size_t count_urgent() const;
  void choose_least(std::span<Needed> rest);
  bool leaves_out(uint32_t chunk, uint32_t urgency, ChunkLooks& looks) const;
  uint32_t most_above(uint32_t chunk) const;
  void find_needed(ChunkLooks& looks);
  bool add_needed(const Needed& needed);
  void mark_needed(uint32_t chunk);
  void share_in_families();
  void share_with_parents();
  void count_need();
  void choose_target();
  void queue_requests();
  void order_requests();
  // In which a chunk is asked for, the last first: by its class, but for what is hidden.
  enum class Turn : uint8_t { around, turned, hidden, soon, seen, pinned };
  Turn turn(uint32_t chunk) const;
  void find_hidden();
  bool is_hidden(uint32_t chunk) const;
  std::vector<uint32_t> unwanted();
  void list_victims();
  struct Wanted {
    size_t slots;
    uint64_t blocks;
  };
  Wanted wanted(size_t requests) const;
  bool is_short(const Wanted& wanted) const;
  const Known& known(uint32_t chunk) const { return known_[chunk]; }
  Known& know(uint32_t chunk) { return known_.know(chunk); }
  void forget_absent();
  // How many it takes; kUnknown before it was read.
  uint32_t blocks_of(uint32_t chunk) const {
    if (known(chunk).was_read) return known(chunk).blocks;
    const uint32_t few = few_blocks_[chunk];
    return few == 0 ? kUnknown : few - 1;
  }
  uint32_t known_blocks(uint32_t chunk) const {
    const uint32_t blocks = blocks_of(chunk);
    return blocks == kUnknown ? 0 : blocks;
  }
  uint32_t most_blocks(uint32_t chunk) const {
    if (const uint32_t blocks = blocks_of(chunk); blocks != kUnknown) return blocks;
    const uint32_t most = known(chunk).blocks;
    return most == kUnknown ? records_->most_blocks(chunk) : most;
  }
  void set_blocks(uint32_t chunk, uint32_t blocks);
  void learn_blocks(uint32_t chunk, uint32_t blocks);
  void take_blocks(uint32_t chunk);
  void free_blocks(uint32_t first);
  void drop_waiting();
  void list_leftovers(bool cuts_are_full);
  void remove(uint32_t chunk, std::vector<Evicted>& evicted);
  bool parents_arrive(uint32_t chunk) const;
  void count_missing(uint32_t chunk, bool missing);
  void give_up(uint32_t chunk, State now);
  void drop(uint32_t chunk);

  const ChunkGraph* graph_;
  const ChunkDirectory* chunks_;
  const RecordRoom* records_;
  PoolRoom room_;
  uint32_t pinned_, resident_ = 0;
  uint32_t plan_ = 0;
  ByChunk<Known> known_;
  // By chunk.
  // One more than it took when it was last read; 0: not known, or kMany, which is forgotten with
  // it.
  SparseArray<uint8_t> few_blocks_;
  std::vector<bool> missed_;  // a viewer has seen that it was not there
  // 1: a node that leads to it leads to the chunk before, too; 2: and to the one behind.
  SparseArray<uint8_t> shares_family_;

  std::vector<Needed> needed_;                // of the last plan, ascending
  std::vector<Needed> failed_;                // and what it would have needed
  std::vector<Needed> extra_;                 // scratch
  std::vector<Climb> climb_;                  // scratch
  std::vector<uint32_t> asked_;               // by the last plan, the most urgent last
  std::vector<uint32_t> requests_, victims_;  // the first to go last
  std::vector<uint32_t> leftovers_;           // as victims_, but they go where room is not short
  ShownChunks shown_;                         // of all viewers
  std::deque<uint32_t> filled_;               // and not looked at by begin_arrivals()
  std::vector<uint32_t> waiting_;  // all that are filled before their parents are there, and others
  std::vector<uint32_t> free_slots_;
  std::vector<uint32_t> free_blocks_;  // a heap, the least first
  std::vector<uint32_t> next_block_;   // by block, of those that a chunk has
  uint32_t coming_ = 0;                // on their way or read: each will want a slot
  uint32_t filling_ = 0;               // have one, and are not filled yet
  uint64_t coming_blocks_ = 0;         // that those will want at most
  uint64_t target_blocks_ = 0;         // of what is wanted, as far as is known
  bool crowded_ = false;               // not all that the last plan needed has room
  // Plans in haste leave out what is less urgent than least_, which the last whole plan chose. What
  // that plan found to be less urgent is counted in beyond_. hasty_plans_: how many came since.
  uint32_t least_ = 0, hasty_plans_ = 0;
  ResidencyNeed beyond_;
  bool left_out_ = false;  // by the last plan, something was
  ResidencyNeed need_;
  ResidencyCounters counters_;
};

}  // namespace voyager
