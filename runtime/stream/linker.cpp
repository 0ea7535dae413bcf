// What comes and goes, in the order in which its parts depend on one another.
#include "runtime/stream/linker.h"

#include <algorithm>
#include <utility>

namespace voyager {

Linker::Linker(const ChunkGraph& graph, SlotShape shape, const std::vector<uint32_t>& next_block)
    : graph_(&graph), shape_(shape), next_block_(&next_block), tables_(graph.size()) {}

PoolBytes Linker::bytes(SlotShape shape) {
  const uint64_t entry = ByChunk<LinkTable>::known_bytes() - sizeof(LinkTable);
  return {LinkTable::chunk_bytes(shape.records) + entry, kRecordBlock * LinkTable::kBelowBytes,
          ByChunk<LinkTable>::known_bytes(), kPageSubtrees * LinkTable::kSubtreeBytes,
          sizeof(LargeFamily)};
}

Linker::Walk Linker::walk(uint32_t chunk) const {
  const LinkTable& table = tables_[chunk];
  return {chunk,
          {table, graph_->tiers(), {large_, table.slot * shape_.nodes}},
          {*next_block_, table.first_block}};
}

Linker::Walk Linker::walk(const StagedChunk& chunk) const {
  return {chunk.chunk,
          {chunk.links, graph_->tiers(), {chunk.large, 0}},
          {*next_block_, chunk.links.first_block}};
}

// With its records; their places in its levels.
void Linker::set_records(Walk& walk, SearchSubtree& subtree) const {
  if (walk.at.interior() == 0) return;
  subtree.first_record = walk.records(walk.at.first_record());
  const auto count = count_bits(walk.at.interior());
  uint32_t block = subtree.first_record / kRecordBlock;
  const uint32_t blocks = record_blocks(subtree.first_record % kRecordBlock + count);
  for (uint32_t i = 1; i < blocks; ++i) {
    const uint32_t next = (*next_block_)[block];
    if (next != block + 1) subtree.levels |= kScattered;
    block = next;
  }
}

bool Linker::may_come(uint32_t chunk) const {
  const auto parents = graph_->parents(chunk);
  return std::all_of(parents.begin(), parents.end(), [&](uint32_t p) { return holds(p); });
}

void Linker::arrive(std::span<Arrival> chunks, const ChunkPool& pool, const std::string& file,
                    Team& team, LinkPatch& patch, std::vector<ChunkRange>& divided) {
  lanes_.resize(team.lanes());
  const std::vector<Coming> coming = hold_sound(chunks, pool, file, team, patch);
  const bool has_room = has_room_for_all();
  const auto link_one = [&](unsigned lane, size_t i) {
    const Arrival& arrival = *coming[i].arrival;
    link(coming[i].above, has_room, lanes_[lane]);
    find_divided(arrival.chunk, lanes_[lane].divided);
    *arrival.staged = {};
  };
  if (has_room)
    team.loop(coming.size(), link_one);
  else
    for (size_t i = 0; i < coming.size(); ++i) link_one(0, i);
  collect(patch);
  for (Lane& lane : lanes_) {
    divided.insert(divided.end(), lane.divided.begin(), lane.divided.end());
    lane.divided.clear();
  }
  tell_large(patch);
}

// Most have their parents at once, others when these are held. A chunk is held before the next one,
// which may repeat its nodes.
std::vector<Linker::Coming> Linker::hold_sound(std::span<Arrival> chunks, const ChunkPool& pool,
                                               const std::string& file, Team& team,
                                               LinkPatch& patch) {
  std::vector<Coming> sound;
  std::vector<Arrival*> left;
  for (Arrival& arrival : chunks) left.push_back(&arrival);
  std::sort(left.begin(), left.end(),
            [](const Arrival* a, const Arrival* b) { return a->chunk < b->chunk; });
  while (!left.empty()) {
    const auto next = std::stable_partition(left.begin(), left.end(),
                                            [&](const Arrival* of) { return may_come(of->chunk); });
    std::vector<Coming> wave;
    for (auto of = left.begin(); of != next; ++of) wave.push_back({*of, {}});
    if (wave.empty()) break;
    left.erase(left.begin(), next);
    const auto check_one = [&](unsigned, size_t i) {
      try {
        check(wave[i], pool, file);
      } catch (const Error& error) {
        wave[i].arrival->failure = error;
      }
    };
    team.loop(wave.size(), check_one);
    for (Coming& coming : wave) {
      Arrival& arrival = *coming.arrival;
      const uint32_t chunk = arrival.chunk;
      if (arrival.failure) continue;
      try {
        const bool before = chunk > 0 && holds(chunk - 1);
        if (roots_of(arrival.staged->links).root() == 0 && chunk > 0 && !before)
          refuse_gap(chunk, file);
        if (before && !coming.before_was_held) check_behind(coming, pool, file);
      } catch (const Error& error) {
        arrival.failure = error;
        continue;
      }
      take_in(*arrival.staged, patch);
      arrival.held = true;
      sound.push_back(std::move(coming));
    }
  }
  return sound;
}

void Linker::take_in(StagedChunk& chunk, LinkPatch& patch) {
  add_large(chunk);
  patch.arrived.push_back({chunk.links.slot, chunk.chunk, chunk.ids});
  slots_held_ += chunk.links.slots();
  tables_.know(chunk.chunk) = std::move(chunk.links);
  if (roots_of(tables_[chunk.chunk]).root() == 0) link_root(chunk.chunk, patch);
}

// Others may still look for what hangs from one, or what that hangs from, until all are unlinked.
void Linker::evict(std::span<const uint32_t> chunks, Team& team, LinkPatch& patch) {
  lanes_.resize(team.lanes());
  const auto unlink_one = [&](unsigned lane, size_t i) {
    Lane& of = lanes_[lane];
    find_above(chunks[i], of.above);
    unlink(of.above, of);
  };
  if (refused_.empty())
    team.loop(chunks.size(), unlink_one);
  else
    for (size_t i = 0; i < chunks.size(); ++i) unlink_one(0, i);
  collect(patch);
  for (const uint32_t chunk : chunks) let_go(chunk, patch);
  tell_large(patch);
}

void Linker::let_go(uint32_t chunk, LinkPatch& patch) {
  const uint32_t slot = tables_[chunk].slot;
  remove_large(slot);
  patch.left.push_back(slot);
  slots_held_ -= tables_[chunk].slots();
  tables_.forget(chunk);
}

// At a time as many as have room together; what is linked below one may take another's.
void Linker::link_refused(LinkPatch& patch) {
  while (!refused_.empty() && has_room_for_cut(most_cut_, refused_.begin()->ends)) {
    std::vector<Family>& some = lanes_[0].above;
    some.clear();
    uint64_t more = 0;
    while (!refused_.empty() && has_room_for_cut(most_cut_, more + refused_.begin()->ends)) {
      more += refused_.begin()->ends - 1;
      some.push_back(refused_.begin()->family);
      refused_.erase(refused_.begin());
    }
    std::sort(some.begin(), some.end(), [](const Family& a, const Family& b) {
      return a.node.first_child < b.node.first_child;
    });
    link(some, false, lanes_[0]);
    collect(patch);
  }
}

// What the lanes have found.
void Linker::collect(LinkPatch& patch) {
  const auto move = [](auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
    from.clear();
  };
  for (Lane& lane : lanes_) {
    move(lane.patch.cut.records, patch.cut.records);
    move(lane.patch.cut.changed, patch.cut.changed);
    move(lane.patch.tied.records, patch.tied.records);
    move(lane.patch.tied.changed, patch.tied.changed);
    move(lane.patch.unlinked, patch.unlinked);
    move(lane.patch.linked, patch.linked);
    move(lane.patch.outside, patch.outside);
    most_cut_ += std::exchange(lane.cut, 0);
    slots_linked_ += std::exchange(lane.slots_linked, 0);
  }
}

void Linker::add_large(const StagedChunk& chunk) {
  if (chunk.large.empty()) return;
  for (const LargeFamily& family : chunk.large)
    large_.push_back({chunk.links.slot * shape_.nodes + family.parent, family.children});
  std::sort(large_.begin(), large_.end(),
            [](const LargeFamily& a, const LargeFamily& b) { return a.parent < b.parent; });
  large_changed_ = true;
}

void Linker::remove_large(uint32_t slot) {
  const auto from = [&](uint32_t address) {
    return std::lower_bound(
        large_.begin(), large_.end(), address,
        [](const LargeFamily& family, uint32_t parent) { return family.parent < parent; });
  };
  const auto first = from(slot * shape_.nodes), last = from((slot + 1) * shape_.nodes);
  if (first == last) return;
  large_.erase(first, last);
  large_changed_ = true;
}

void Linker::tell_large(LinkPatch& patch) {
  if (std::exchange(large_changed_, false)) patch.large = large_;
}

}  // namespace voyager
