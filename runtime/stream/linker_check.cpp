// What a chunk that comes is checked for against those that are held.
#include "runtime/lod/nesting.h"
#include "runtime/stream/linker_parents.h"

namespace voyager {

// Its parents are held, and none of those that come with it.
void Linker::check(Coming& coming, const ChunkPool& pool, const std::string& file) const {
  const StagedChunk& chunk = *coming.arrival->staged;
  check_roots(chunk, pool, file, coming.above);
  const uint32_t before = chunk.chunk - 1, after = chunk.chunk + 1;
  coming.before_was_held = chunk.chunk > 0 && holds(before);
  if (coming.before_was_held) check_behind(coming, pool, file);
  if (after < graph_->size() && holds(after) && roots_of(tables_[after]).repeats_root())
    check_repeat(chunk.chunk, last_of(walk(chunk)), walk(after), pool, file);
}

// The one before is held.
void Linker::check_behind(const Coming& coming, const ChunkPool& pool,
                          const std::string& file) const {
  const StagedChunk& chunk = *coming.arrival->staged;
  if (roots_of(chunk.links).repeats_root())
    check_repeat(chunk.chunk, last_of(walk(chunk.chunk - 1)), walk(chunk), pool, file);
}

Linker::Walk Linker::last_of(Walk walk) {
  Walk last = walk;
  for (; !walk.at.at_end(); walk.at.next()) last.at = walk.at;
  return last;
}

void Linker::check_roots(const StagedChunk& chunk, const ChunkPool& pool, const std::string& file,
                         std::vector<Family>& above) const {
  Parents parents(*this, chunk.chunk, &chunk);
  ChunkGraph::Families families(*graph_, chunk.chunk);
  uint32_t done = 0;                              // roots before this
  NodeBounds bounds{};                            // of their parent
  const NodeRecord* record = chunk.roots.data();  // of the subtree's first root
  for (RootWalk at = roots_of(chunk.links); !at.at_end(); record += at.root_count(), at.next()) {
    if (at.root() == 0) continue;
    if (at.root() >= done) {
      const Parent* parent = parents.of(at.root());
      if (parent == nullptr) refuse_roots(chunk.chunk, at.root(), file);
      done = parent->end();
      const uint32_t slot =
          parent->chunk == chunk.chunk ? chunk.links.slot : tables_[parent->chunk].slot;
      bounds = decode_bounds(pool.bounds({parent->record, slot, parent->node.index}));
      above.push_back(family_of(*parent, families));
    }
    if (at.root_count() > done - at.root()) refuse_roots(chunk.chunk, at.root(), file);
    for (uint32_t i = 0; i < at.root_count(); ++i)
      if (!is_inside(record[i], bounds)) refuse_nesting(chunk.chunk, at.root() + i, file);
  }
}

// What a chunk begins with repeats what the one before ends with. chunk: the one to refuse.
void Linker::check_repeat(uint32_t chunk, Walk before, Walk after, const ChunkPool& pool,
                          const std::string& file) const {
  constexpr uint32_t kLastEnds = 2;  // in StagedChunk::checked, before those of the first subtree
  const auto code = [&](Walk& of, uint32_t slot, uint32_t end) {
    const auto k = count_bits(of.at.interior() & slots_before(slot));
    return pool.bounds({of.records(of.at.first_record() + k), of.at.table().slot,
                        of.at.table().nodes_below() + end});
  };
  const auto same = [&](uint32_t slot_before, uint32_t slot_after, uint32_t of_child) {
    return (before.at.interior() >> slot_before & 1) != 0 &&
           (after.at.interior() >> slot_after & 1) != 0 &&
           code(before, slot_before, of_child) == code(after, slot_after, kLastEnds + of_child);
  };
  if (after.at.repeats_root() && !same(0, 0, 0)) refuse_repeat(chunk, after.at.root(), file);
  if (after.at.repeats_child() && !same(before.at.root_count(), 1, 1))
    refuse_repeat(chunk, graph_->repeated_child(after.chunk), file);
}

}  // namespace voyager
