#include "runtime/stream/linker.h"

#include <algorithm>
#include <utility>

#include "runtime/lod/nesting.h"

namespace voyager {
namespace {

// Addresses of a family's nodes, from one of its subtrees to the next: a node that is repeated
// is where its owner has it.
class Addresses {
 public:
  explicit Addresses(SlotShape shape) : shape_(shape) {}

  // But for its records.
  SearchSubtree of(const LinkTable& table, const LinkWalk& at, uint32_t entry) {
    const uint32_t base = table.slot * shape_.nodes;
    if (!at.repeats_root()) root_ = base + at.place(0);
    if (at.child_count() != 0 && !at.repeats_child()) first_child_ = base + at.place(1);
    return {root_, first_child_,  base + at.place(2), at.levels(),
            0,     at.interior(), at.families(),      entry};
  }

 private:
  SlotShape shape_;
  uint32_t root_ = 0, first_child_ = 0;
};

// Of what the chunk could not know by itself. parent: what the roots hang from.
LinkPatch::Outside outside_of(const LinkWalk& at, const SearchSubtree& subtree, uint32_t parent) {
  if (at.repeats_child()) return {at.subtree(), subtree.first_child};
  return {at.subtree(), at.repeats_root() ? subtree.root : parent};
}

// Of families in a heap: roots ascend, and what hangs from them comes later.
constexpr auto kIsLater = [](const auto& a, const auto& b) {
  return a.node.first_child > b.node.first_child;
};

}  // namespace

// What the roots of one chunk hang from: goes through the nodes of one chunk after another.
class Linker::Parents {
 public:
  // own: the chunk, where it is not held yet, or null.
  Parents(const Linker& linker, uint32_t below, const StagedChunk* own)
      : linker_(linker), below_(below), own_(own) {}

  // Null: the chunk that should lead to it does not.
  const Parent* of(uint32_t root) {
    if (found_ && root < found_->end()) return &*found_;
    found_.reset();
    if (!walk_ || root >= end_) go_to(linker_.graph_->owner_of_parent(below_, root));
    LinkWalk& at = walk_->at;
    if (!at.at_end() && at.below_end() <= root) {
      while (!at.at_end() && at.below_end() <= root) at.next();
      if (!at.at_end()) nodes_.emplace(at);
    }
    if (at.at_end()) return nullptr;
    while (nodes_->children_end() <= root) nodes_->next();
    if (root < nodes_->children_begin()) return nullptr;
    const NodeBelow node = **nodes_;
    found_ = Parent{walk_->chunk, at.index(), walk_->records(node.record), node};
    return &*found_;
  }

 private:
  void go_to(uint32_t chunk) {
    const bool is_own = chunk == below_;
    walk_.emplace(is_own && own_ != nullptr ? linker_.walk(*own_) : linker_.walk(chunk));
    nodes_.emplace(walk_->at);
    end_ = is_own ? UINT32_MAX : linker_.graph_->next_below(chunk + 1);
  }

  const Linker& linker_;
  const uint32_t below_;
  const StagedChunk* own_;
  std::optional<Walk> walk_;
  std::optional<LinkWalk::NodesBelow> nodes_;
  uint32_t end_ = 0;  // roots before this one hang from that chunk
  std::optional<Parent> found_;
};

// Goes through the subtrees of one chunk after another, so that all families of a chunk together
// cost as much as one walk. What does not ascend costs a walk more.
class Linker::Roots {
 public:
  explicit Roots(const Linker& linker) : linker_(linker) {}

  // At the first subtree of a chunk whose root is in [root, end) or later. Whoever asks goes on
  // with it, but not beyond the first whose root is not before `end`.
  Walk& of(uint32_t chunk, uint32_t root, uint32_t end) {
    if (!walk_ || chunk != walk_->chunk || root < end_) walk_.emplace(linker_.walk(chunk));
    end_ = end;
    LinkWalk& at = walk_->at;
    while (!at.at_end() && at.root() < root) at.next();
    return *walk_;
  }

 private:
  const Linker& linker_;
  uint32_t end_ = 0;
  std::optional<Walk> walk_;
};

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

bool Linker::complete(const Family& family) const {
  const ChunkRange range = family.chunks;
  for (uint32_t chunk = range.last; chunk-- > range.first;)  // the last comes last
    if (!holds(chunk)) return false;
  return true;
}

// Roots ascend in a tier, and those of a later tier are greater.
template <class Visit>
void Linker::each_subtree(const Family& family, Roots& roots, const Visit& visit) const {
  const ChunkRange range = family.chunks;
  for (uint32_t chunk = range.first; chunk < range.last; ++chunk) {
    if (!holds(chunk)) continue;
    Walk& walk = roots.of(chunk, family.node.first_child, family.end());
    for (; !walk.at.at_end() && walk.at.root() < family.end(); walk.at.next()) visit(walk);
  }
}

Linker::Family Linker::family_of(const Parent& parent, ChunkGraph::Families& families) const {
  return {parent, families.of(parent.chunk, parent.node.first_child, parent.node.child_count)};
}

void Linker::add_work(const Family& family) {
  work_.push_back(family);
  std::push_heap(work_.begin(), work_.end(), kIsLater);
}

Linker::Family Linker::take_work() {
  const bool above = next_above_ != above_.size() &&
                     (work_.empty() || !kIsLater(above_[next_above_], work_.front()));
  const auto pop = [&] {
    std::pop_heap(work_.begin(), work_.end(), kIsLater);
    const Family family = work_.back();
    work_.pop_back();
    return family;
  };
  if (!above) return pop();
  const Family family = above_[next_above_++];
  // A chunk that leads to itself has found it from above and from below.
  while (!work_.empty() && work_.front().node.first_child == family.node.first_child) pop();
  return family;
}

// False: no family that hangs from the chunk is there.
bool Linker::may_lead_on(uint32_t chunk) const {
  if (graph_->leads_to_itself(chunk)) return true;
  const ChunkRange children = graph_->children(chunk);
  for (uint32_t child = children.first; child < children.last; ++child)
    if (holds(child)) return true;
  return false;
}

// The families that its subtrees belong to, each once.
void Linker::find_above(uint32_t chunk) {
  Parents parents(*this, chunk, nullptr);
  ChunkGraph::Families families(*graph_, chunk);
  above_.clear();
  next_above_ = 0;
  uint32_t done = 1;  // roots before this; the tree's has no parent
  for (RootWalk at = roots_of(tables_[chunk]); !at.at_end(); at.next()) {
    if (at.root() < done) continue;
    const Parent& parent = *parents.of(at.root());
    done = parent.end();
    above_.push_back(family_of(parent, families));
  }
}

void Linker::check_roots(const StagedChunk& chunk, const ChunkPool& pool, const std::string& file) {
  Parents parents(*this, chunk.chunk, &chunk);
  ChunkGraph::Families families(*graph_, chunk.chunk);
  checked_above_.clear();
  uint32_t done = 0;                              // roots before this
  NodeBounds bounds{};                            // of their parent
  const NodeRecord* record = chunk.roots.data();  // of the subtree's first root
  for (RootWalk at = roots_of(chunk.links); !at.at_end(); record += at.root_count(), at.next()) {
    if (at.root() == 0) continue;
    if (at.root() >= done) {
      const Parent* parent = parents.of(at.root());
      if (parent == nullptr) refuse_roots(chunk.chunk, at.root(), file);
      done = parent->end();
      bounds = decode_bounds(pool.bounds(parent->record));
      checked_above_.push_back(family_of(*parent, families));
    }
    if (at.root_count() > done - at.root()) refuse_roots(chunk.chunk, at.root(), file);
    for (uint32_t i = 0; i < at.root_count(); ++i)
      if (!is_inside(record[i], bounds)) refuse_nesting(chunk.chunk, at.root() + i, file);
  }
}

// What a chunk begins with repeats what the one before ends with. chunk: the one to refuse.
void Linker::check_repeat(uint32_t chunk, Walk before, Walk after, const ChunkPool& pool,
                          const std::string& file) const {
  const auto code = [&](Walk& of, uint32_t slot) {
    const auto k = count_bits(of.at.interior() & slots_before(slot));
    return pool.bounds(of.records(of.at.first_record() + k));
  };
  const auto same = [&](uint32_t slot_before, uint32_t slot_after) {
    return (before.at.interior() >> slot_before & 1) != 0 &&
           (after.at.interior() >> slot_after & 1) != 0 &&
           code(before, slot_before) == code(after, slot_after);
  };
  if (after.at.repeats_root() && !same(0, 0)) refuse_repeat(chunk, after.at.root(), file);
  if (after.at.repeats_child() && !same(before.at.root_count(), 1))
    refuse_repeat(chunk, graph_->repeated_child(after.chunk), file);
}

void Linker::check(const StagedChunk& chunk, const ChunkPool& pool, const std::string& file) {
  checked_ = kNone;
  const RootWalk own = roots_of(chunk.links);
  if (own.root() == 0 && chunk.chunk > 0 && !holds(chunk.chunk - 1)) refuse_gap(chunk.chunk, file);
  check_roots(chunk, pool, file);
  const auto last_of = [](Walk walk) {
    Walk last = walk;
    for (; !walk.at.at_end(); walk.at.next()) last.at = walk.at;
    return last;
  };
  const uint32_t before = chunk.chunk - 1, after = chunk.chunk + 1;
  if (chunk.chunk > 0 && own.repeats_root() && holds(before))
    check_repeat(chunk.chunk, last_of(walk(before)), walk(chunk), pool, file);
  if (after < graph_->size() && holds(after) && roots_of(tables_[after]).repeats_root())
    check_repeat(chunk.chunk, last_of(walk(chunk)), walk(after), pool, file);
  checked_ = chunk.chunk;
}

void Linker::add_large(const StagedChunk& chunk, LinkPatch& patch) {
  if (chunk.large.empty()) return;
  for (const LargeFamily& family : chunk.large)
    large_.push_back({chunk.links.slot * shape_.nodes + family.parent, family.children});
  std::sort(large_.begin(), large_.end(),
            [](const LargeFamily& a, const LargeFamily& b) { return a.parent < b.parent; });
  patch.large = large_;
}

void Linker::remove_large(uint32_t slot, LinkPatch& patch) {
  const auto from = [&](uint32_t address) {
    return std::lower_bound(
        large_.begin(), large_.end(), address,
        [](const LargeFamily& family, uint32_t parent) { return family.parent < parent; });
  };
  const auto first = from(slot * shape_.nodes), last = from((slot + 1) * shape_.nodes);
  if (first == last) return;
  large_.erase(first, last);
  patch.large = large_;
}

void Linker::arrive(StagedChunk&& chunk, LinkPatch& patch) {
  add_large(chunk, patch);
  patch.arrived.push_back({chunk.links.slot, chunk.chunk, chunk.ids});
  tables_.know(chunk.chunk) = std::move(chunk.links);
  if (roots_of(tables_[chunk.chunk]).root() == 0) link_root(chunk.chunk, patch);
  if (checked_ == chunk.chunk) {
    std::swap(above_, checked_above_);
    next_above_ = 0;
  } else {
    find_above(chunk.chunk);
  }
  checked_ = kNone;
  link(patch);
}

// Its subtrees of the tree's root. Runs of that are in chunks that are never evicted and come in
// order, none without the one before (check()), so that the first of them has the node itself.
void Linker::link_root(uint32_t last, LinkPatch& patch) {
  Addresses addresses(shape_);
  for (uint32_t chunk = 0; chunk <= last; ++chunk) {
    Walk walk = this->walk(chunk);
    for (LinkWalk& at = walk.at; !at.at_end() && at.root() == 0; at.next()) {
      LinkTable& table = tables_.know(chunk);
      SearchSubtree linked = addresses.of(table, at, kNoRecord);
      if (chunk != last) continue;
      set_records(walk, linked);
      table.set_leads_to(at.index(), true);
      most_cut_ += at.ends();
      patch.outside.push_back(outside_of(at, linked, kNoNode));
      patch.linked.emplace_back(at.subtree(), linked);
    }
  }
}

// Where it is linked, so many nodes take the place of the one that they hang from.
// roots: goes to the family and stays there, since whoever asks may go through it afterwards.
uint64_t Linker::ends_of(const Family& family, Roots& roots) const {
  const uint32_t first = family.node.first_child;
  if (holds(family.chunks.first)) roots.of(family.chunks.first, first, first);
  Roots ahead = roots;
  uint64_t ends = 0;
  each_subtree(family, ahead, [&](const Walk& walk) { ends += walk.at.ends(); });
  return ends;
}

bool Linker::refuse_if_large(const Family& family, Roots& roots) {
  // A bound nearly always has room: then nothing is counted.
  uint64_t subtrees = 0;
  for (uint32_t chunk = family.chunks.first; chunk < family.chunks.last; ++chunk)
    subtrees += tables_[chunk].subtrees();
  if (has_room_for_cut(subtrees * kSubtreeNodes)) return false;
  const uint64_t ends = ends_of(family, roots);
  if (has_room_for_cut(ends)) return false;
  refused_.insert({ends, family});
  return true;
}

// At a time as many as have room together; what is linked below one may take another's.
void Linker::link_refused(LinkPatch& patch) {
  while (!refused_.empty() && has_room_for_cut(refused_.begin()->ends)) {
    uint64_t more = 0;
    while (!refused_.empty() && has_room_for_cut(more + refused_.begin()->ends)) {
      more += refused_.begin()->ends - 1;
      add_work(refused_.begin()->family);
      refused_.erase(refused_.begin());
    }
    link(patch);
  }
}

void Linker::link(LinkPatch& patch) {
  Roots roots(*this);
  ChunkGraph::Families families(*graph_);
  while (has_work()) {
    const Family family = take_work();
    LinkTable& table = tables_.know(family.chunk);
    if (table.leads_on(family.node.index) || !table.leads_to(family.subtree) || !complete(family) ||
        refuse_if_large(family, roots))
      continue;
    table.set_leads_on(family.node.index, true);
    const uint32_t parent = table.slot * shape_.nodes + family.node.place;
    --most_cut_;
    Addresses addresses(shape_);
    uint32_t first_below = kLowest, asked = kNoNode;
    bool leads_on = false;  // may_lead_on(asked)
    each_subtree(family, roots, [&](Walk& walk) {
      const LinkWalk& at = walk.at;
      LinkTable& of = tables_.know(walk.chunk);
      most_cut_ += at.ends();
      first_below = std::min(first_below, at.subtree());
      SearchSubtree linked = addresses.of(of, at, family.record);
      set_records(walk, linked);
      of.set_leads_to(at.index(), true);
      patch.outside.push_back(outside_of(at, linked, parent));
      patch.linked.emplace_back(at.subtree(), linked);
      if (asked != walk.chunk) {
        asked = walk.chunk;
        leads_on = may_lead_on(walk.chunk);
      }
      if (!leads_on) return;
      at.each_below([&](const NodeBelow& node) {
        add_work(family_of({walk.chunk, at.index(), walk.records(node.record), node}, families));
      });
    });
    patch.tied.records.push_back({family.record, kLowest | first_below});
    patch.tied.changed.push_back(table.first_subtree + family.subtree);
  }
}

void Linker::unlink(LinkPatch& patch) {
  Roots roots(*this);
  ChunkGraph::Families families(*graph_);
  while (has_work()) {
    const Family family = take_work();
    LinkTable& table = tables_.know(family.chunk);
    if (!table.leads_on(family.node.index)) {
      if (!refused_.empty() && complete(family)) refused_.erase({ends_of(family, roots), family});
      continue;
    }
    table.set_leads_on(family.node.index, false);
    patch.cut.records.push_back({family.record, kBlocked});
    patch.cut.changed.push_back(table.first_subtree + family.subtree);
    ++most_cut_;
    each_subtree(family, roots, [&](Walk& walk) {
      tables_.know(walk.chunk).set_leads_to(walk.at.index(), false);
      most_cut_ -= walk.at.ends();
      patch.unlinked.push_back(walk.at.subtree());
      walk.at.each_below([&](const NodeBelow& node) {
        if (!refused_.empty() || tables_[walk.chunk].leads_on(node.index))
          add_work(
              family_of({walk.chunk, walk.at.index(), walk.records(node.record), node}, families));
      });
    });
  }
}

void Linker::evict(uint32_t chunk, LinkPatch& patch) {
  checked_ = kNone;
  const uint32_t slot = tables_[chunk].slot;
  find_above(chunk);
  unlink(patch);
  remove_large(slot, patch);
  patch.left.push_back(slot);
  tables_.forget(chunk);
}

}  // namespace voyager
