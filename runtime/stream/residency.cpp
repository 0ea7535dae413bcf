// What comes and goes, by the last plan.
#include "runtime/stream/residency.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace voyager {
namespace {

// How many requests evictions make room for ahead of their reading.
constexpr size_t kRoomAhead = 256;
// A read of fewer bytes takes about as long as one of so many.
constexpr uint64_t kShortRead = 64 << 10;

}  // namespace

Residency::Residency(const ChunkGraph& graph, const ChunkDirectory& chunks,
                     const RecordRoom& records, PoolRoom room, uint32_t pinned)
    : graph_(&graph),
      chunks_(&chunks),
      records_(&records),
      room_(room),
      pinned_(pinned),
      known_(chunks.size()),
      few_blocks_(chunks.size()),
      missed_(chunks.size()),
      shares_family_(chunks.size()),
      next_block_(room.blocks, kNoBlock) {
  assert(pinned <= room.slots);
  free_slots_.reserve(room.slots);  // so that to free one throws nothing
  for (uint32_t slot = room.slots; slot-- > 0;) free_slots_.push_back(slot);
  free_blocks_.reserve(room.blocks);
  for (uint32_t block = 0; block < room.blocks; ++block) free_blocks_.push_back(block);
  ChunkLooks nobody(chunks);
  plan(nobody, false);
}

ChunkRange Residency::take_requests(uint32_t most, uint64_t bytes) {
  while (!requests_.empty() && known(requests_.back()).state != State::absent) requests_.pop_back();
  if (requests_.empty()) return {0, 0};
  const auto to_read = [&](uint32_t chunk) {
    return chunk < graph_->size() && known(chunk).state == State::absent && is_wanted(chunk);
  };
  ChunkRange range{requests_.back(), requests_.back() + 1};
  uint64_t taken = chunks_->bytes(range.first);
  // Neighbours whose turn is no later than that.
  const auto extend = [&](Turn last, uint64_t enough) {
    const auto fits = [&](uint32_t chunk) {
      return range.last - range.first < most && to_read(chunk) && turn(chunk) >= last &&
             taken + chunks_->bytes(chunk) <= enough;
    };
    for (; fits(range.last); ++range.last) taken += chunks_->bytes(range.last);
    for (; range.first > 0 && fits(range.first - 1); --range.first)
      taken += chunks_->bytes(range.first - 1);
  };
  extend(turn(requests_.back()), bytes);
  extend(Turn::around, std::min(bytes, kShortRead));
  for (uint32_t chunk = range.first; chunk < range.last; ++chunk) {
    know(chunk).state = State::on_its_way;
    coming_blocks_ += most_blocks(chunk);
  }
  counters_.requested += range.last - range.first;
  coming_ += range.last - range.first;
  return range;
}

std::vector<uint32_t> Residency::needed() const {
  std::vector<uint32_t> all;
  all.reserve(needed_.size());
  for (const Needed& needed : needed_) all.push_back(needed.chunk);
  return all;
}

void Residency::learn_blocks(uint32_t chunk, uint32_t blocks) {
  coming_blocks_ += uint64_t{blocks} - most_blocks(chunk);
  if (is_wanted(chunk)) target_blocks_ += uint64_t{blocks} - known_blocks(chunk);
  set_blocks(chunk, blocks);
}

void Residency::set_blocks(uint32_t chunk, uint32_t blocks) {
  know(chunk).blocks = blocks;
  know(chunk).was_read = true;
  few_blocks_.set(chunk, static_cast<uint8_t>(blocks < kMany ? blocks + 1 : 0));
}

bool Residency::read(uint32_t chunk, uint32_t blocks) {
  assert(known(chunk).state == State::on_its_way);
  learn_blocks(chunk, blocks);
  know(chunk).state = State::read;
  return keep(chunk);
}

bool Residency::keep(uint32_t chunk) {
  assert(known(chunk).state == State::read);
  if (is_wanted(chunk)) return true;
  drop(chunk);
  return false;
}

// Its slot, or its claim to one.
void Residency::give_up(uint32_t chunk, State now) {
  if (known(chunk).slot == kNoSlot) {
    --coming_;
    coming_blocks_ -= most_blocks(chunk);
  } else {
    filling_ -= known(chunk).state == State::read;
    free({chunk, known(chunk).slot, known(chunk).first_block});
  }
  know(chunk).slot = kNoSlot;
  know(chunk).first_block = kNoBlock;
  know(chunk).state = now;
}

void Residency::drop(uint32_t chunk) {
  give_up(chunk, State::absent);
  ++counters_.flushed;
}

uint32_t Residency::take_slot(uint32_t chunk) {
  assert(known(chunk).state == State::read && known(chunk).slot == kNoSlot);
  if (free_slots_.empty() || free_blocks_.size() < known(chunk).blocks) return kNoSlot;
  know(chunk).slot = free_slots_.back();
  free_slots_.pop_back();
  --coming_;
  coming_blocks_ -= known(chunk).blocks;
  ++filling_;
  take_blocks(chunk);
  return known(chunk).slot;
}

// The first that are free, so that most lie one behind another.
void Residency::take_blocks(uint32_t chunk) {
  uint32_t* last = &know(chunk).first_block;
  for (uint32_t i = 0; i < known(chunk).blocks; ++i) {
    std::pop_heap(free_blocks_.begin(), free_blocks_.end(), std::greater<>());
    *last = free_blocks_.back();
    free_blocks_.pop_back();
    last = &next_block_[*last];
  }
  *last = kNoBlock;
}

void Residency::free_blocks(uint32_t first) {
  for (uint32_t block = first; block != kNoBlock; block = next_block_[block]) {
    free_blocks_.push_back(block);
    std::push_heap(free_blocks_.begin(), free_blocks_.end(), std::greater<>());
  }
}

void Residency::free(const Evicted& evicted) {
  free_slots_.push_back(evicted.slot);
  free_blocks(evicted.first_block);
}

std::vector<uint32_t> Residency::blocks(uint32_t chunk) const {
  std::vector<uint32_t> all;
  for (uint32_t block = known(chunk).first_block; block != kNoBlock; block = next_block_[block])
    all.push_back(block);
  return all;
}

uint64_t Residency::pinned_blocks() const {
  uint64_t blocks = 0;
  for (uint32_t chunk = 0; chunk < pinned_; ++chunk) blocks += known_blocks(chunk);
  return blocks;
}

void Residency::place(uint32_t chunk) {
  assert(known(chunk).state == State::absent);
  know(chunk).state = State::read;
  know(chunk).target_plan = plan_;
  know(chunk).blocks = 0;  // until place_records()
  know(chunk).was_read = true;
  ++coming_;
  take_slot(chunk);
}

bool Residency::place_records(uint32_t chunk, uint32_t blocks) {
  assert(known(chunk).state == State::read && known(chunk).slot != kNoSlot);
  if (blocks > free_blocks_.size()) return false;
  set_blocks(chunk, blocks);
  target_blocks_ += blocks;
  take_blocks(chunk);
  return true;
}

void Residency::filled(uint32_t chunk) {
  --filling_;
  know(chunk).state = State::filled;
  filled_.push_back(chunk);
}

void Residency::failed(uint32_t chunk) {
  assert(known(chunk).state == State::on_its_way || known(chunk).state == State::read);
  give_up(chunk, State::failed);
}

void Residency::retry(uint32_t chunk) {
  if (known(chunk).state == State::failed) know(chunk).state = State::absent;
}

bool Residency::parents_arrive(uint32_t chunk) const {
  for (const uint32_t p : graph_->parents(chunk))
    if (known(p).state != State::resident && known(p).state != State::arriving) return false;
  return true;
}

// Those that came before their parents, and are not wanted any more.
void Residency::drop_waiting() {
  std::erase_if(waiting_, [&](uint32_t chunk) {
    if (known(chunk).state != State::filled) return true;
    if (is_wanted(chunk)) return false;
    drop(chunk);
    return true;
  });
}

// To sort all of many each time would take longer than to link a few. In a part that is sorted
// parents come before children. A chunk whose parents are not in it goes to waiting_, and comes
// back when the last of them arrives.
Residency::Arrivals Residency::begin_arrivals(size_t most) {
  Arrivals out;
  while (out.arriving.size() < most && !filled_.empty()) {
    const size_t some = filled_.size() / 2 < most ? filled_.size() : 2 * most;
    const auto end = filled_.begin() + static_cast<std::ptrdiff_t>(some);
    std::vector<uint32_t> next(filled_.begin(), end);
    filled_.erase(filled_.begin(), end);
    std::sort(next.begin(), next.end());
    size_t i = 0;
    for (; i < next.size() && out.arriving.size() < most; ++i) {
      const uint32_t chunk = next[i];
      if (known(chunk).state != State::filled) continue;  // came after its parent as well
      if (!is_wanted(chunk)) {
        drop(chunk);
        out.given_up.push_back(chunk);
        continue;
      }
      if (!parents_arrive(chunk)) {
        waiting_.push_back(chunk);
        continue;
      }
      know(chunk).state = State::arriving;
      const ChunkRange children = graph_->children(chunk);
      for (uint32_t c = children.first; c < children.last; ++c)
        if (known(c).state == State::filled) next.push_back(c);
      out.arriving.push_back(chunk);
    }
    filled_.insert(filled_.begin(), next.begin() + static_cast<std::ptrdiff_t>(i), next.end());
  }
  return out;
}

void Residency::end_arrival(uint32_t chunk, Arrival how) {
  assert(known(chunk).state == State::arriving);
  if (how == Arrival::failed) return give_up(chunk, State::failed);
  if (how == Arrival::waiting) {
    know(chunk).state = State::filled;
    waiting_.push_back(chunk);
    return;
  }
  know(chunk).state = State::resident;
  count_missing(chunk, false);
  ++resident_;
  ++counters_.arrived;
  counters_.late += missed_[chunk];
  missed_[chunk] = false;
  for (const uint32_t p : graph_->parents(chunk)) ++know(p).children_there;
}

// By what is coming, and by the most urgent requests.
Residency::Wanted Residency::wanted(size_t requests) const {
  Wanted wanted{coming_ + requests, coming_blocks_};
  for (size_t i = requests_.size() - requests; i < requests_.size(); ++i)
    wanted.blocks += most_blocks(requests_[i]);
  return wanted;
}

bool Residency::is_short(const Wanted& wanted) const {
  return free_slots_.size() < wanted.slots || free_blocks_.size() < wanted.blocks;
}

size_t Residency::changes() const {
  const size_t others = filled_.size() + (has_leftovers() ? leftovers_.size() : 0);
  if (victims_.empty()) return others;
  const Wanted ahead = wanted(std::min(requests_.size(), kRoomAhead));
  if (!is_short(ahead)) return others;
  const auto missing = [](uint64_t of, uint64_t found) { return of - std::min(of, found); };
  const uint64_t for_blocks = missing(ahead.blocks, free_blocks_.size()) * ahead.slots /
                              std::max<uint64_t>(ahead.blocks, 1);
  const uint64_t goes = std::max(missing(ahead.slots, free_slots_.size()), for_blocks);
  return others + std::clamp<size_t>(goes, 1, victims_.size());
}

std::vector<Residency::Evicted> Residency::evict(size_t most) {
  std::vector<Evicted> evicted;
  Wanted still = wanted(std::min(requests_.size(), kRoomAhead));
  const auto may_go = [&](uint32_t chunk) {
    return known(chunk).state == State::resident && !is_wanted(chunk) &&
           known(chunk).children_there == 0;
  };
  while (evicted.size() < most && !victims_.empty() && is_short(still)) {
    const uint32_t chunk = victims_.back();
    victims_.pop_back();
    if (!may_go(chunk)) continue;
    still.slots -= std::min<size_t>(still.slots, 1);
    still.blocks -= std::min<uint64_t>(still.blocks, known(chunk).blocks);
    remove(chunk, evicted);
  }
  while (evicted.size() < most && has_leftovers()) {
    const uint32_t chunk = leftovers_.back();
    leftovers_.pop_back();
    if (may_go(chunk)) remove(chunk, evicted);
  }
  return evicted;
}

bool Residency::has_leftovers() const {
  return !leftovers_.empty() && is_quiet();
}

bool Residency::is_quiet() const {
  const auto is = [&](State state) {
    return [this, state](uint32_t chunk) { return known(chunk).state == state; };
  };
  return coming_ == 0 && filling_ == 0 && filled_.empty() &&
         std::none_of(waiting_.begin(), waiting_.end(), is(State::filled)) &&
         std::none_of(requests_.begin(), requests_.end(), is(State::absent));
}

void Residency::remove(uint32_t chunk, std::vector<Evicted>& evicted) {
  for (const uint32_t p : graph_->parents(chunk)) --know(p).children_there;
  evicted.push_back({chunk, known(chunk).slot, known(chunk).first_block});
  if (known(chunk).slot < shown_.size()) shown_[known(chunk).slot] = Shown::unknown;
  know(chunk).slot = kNoSlot;
  know(chunk).first_block = kNoBlock;
  know(chunk).state = State::absent;
  count_missing(chunk, true);
  --resident_;
  ++counters_.evicted;
}

bool Residency::set_family(ChunkRange family) {
  bool news = false, has_room = false, has_none = false;
  for (uint32_t chunk = family.first; chunk < family.last; ++chunk) {
    if (chunk != family.first) {
      const uint8_t shares = chunk + 1 < family.last ? 2 : 1;
      news = news || shares_family_[chunk] != shares;
      shares_family_.set(chunk, shares);
    }
    (is_wanted(chunk) ? has_room : has_none) |=
        known(chunk).needed_plan == plan_ || chunk < pinned_;
  }
  // Where all of them have room, or none has, others' places in the order stay.
  return news && crowded_ && has_room && has_none;
}

// A chunk that comes or goes after the plan.
void Residency::count_missing(uint32_t chunk, bool missing) {
  if (known(chunk).needed_plan != plan_ || known(chunk).counted == 0) return;
  const uint64_t one = missing ? 1 : -uint64_t{1};
  need_.missing += one;
  if (known(chunk).counted == kSeen) need_.seen_missing += one;
  need_.missing_bytes += missing ? chunks_->bytes(chunk) : -uint64_t{chunks_->bytes(chunk)};
}

bool Residency::settled(const std::function<bool(uint32_t)>& hopeless) const {
  const auto to_come = [&](uint32_t chunk) {
    return is_wanted(chunk) && known(chunk).state != State::resident &&
           known(chunk).state != State::failed && !hopeless(chunk);
  };
  if (left_out_ || has_leftovers()) return false;
  for (uint32_t chunk = 0; chunk < pinned_; ++chunk)
    if (to_come(chunk)) return false;
  return std::none_of(needed_.begin(), needed_.end(),
                      [&](const Needed& needed) { return to_come(needed.chunk); });
}

}  // namespace voyager
