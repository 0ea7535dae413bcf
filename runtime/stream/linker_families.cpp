// Families: how they are found, linked and unlinked.
#include <algorithm>

#include "runtime/stream/linker_parents.h"

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

// Families in the order of their first roots: some that ascend, and others that are added.
template <class Family>
class Work {
 public:
  // heap: empty.
  Work(std::span<const Family> above, std::vector<Family>& heap) : above_(above), heap_(heap) {}

  bool done() const { return above_.empty() && heap_.empty(); }
  void add(const Family& family) {
    heap_.push_back(family);
    std::push_heap(heap_.begin(), heap_.end(), kIsLater);
  }
  Family take() {
    if (above_.empty() || (!heap_.empty() && kIsLater(above_.front(), heap_.front()))) return pop();
    const Family family = above_.front();
    above_ = above_.subspan(1);
    // A chunk that leads to itself has found it from above and from below.
    while (!heap_.empty() && heap_.front().node.first_child == family.node.first_child) pop();
    return family;
  }

 private:
  Family pop() {
    std::pop_heap(heap_.begin(), heap_.end(), kIsLater);
    const Family family = heap_.back();
    heap_.pop_back();
    return family;
  }

  std::span<const Family> above_;
  std::vector<Family>& heap_;
};

}  // namespace

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

// False: no family that hangs from the chunk is there.
bool Linker::may_lead_on(uint32_t chunk) const {
  if (graph_->leads_to_itself(chunk)) return true;
  const ChunkRange children = graph_->children(chunk);
  for (uint32_t child = children.first; child < children.last; ++child)
    if (holds(child)) return true;
  return false;
}

// The families that its subtrees belong to, each once.
void Linker::find_above(uint32_t chunk, std::vector<Family>& above) const {
  Parents parents(*this, chunk, nullptr);
  ChunkGraph::Families families(*graph_, chunk);
  above.clear();
  uint32_t done = 1;  // roots before this; the tree's has no parent
  for (RootWalk at = roots_of(tables_[chunk]); !at.at_end(); at.next()) {
    if (at.root() < done) continue;
    const Parent& parent = *parents.of(at.root());
    done = parent.end();
    above.push_back(family_of(parent, families));
  }
}

// Those that hang from it and lie in several chunks.
void Linker::find_divided(uint32_t chunk, std::vector<ChunkRange>& divided) const {
  if (graph_->children(chunk).empty()) return;
  ChunkGraph::Families families(*graph_, chunk);
  for (LinkWalk at = walk(chunk).at; !at.at_end(); at.next())
    at.each_below([&](const NodeBelow& node) {
      const ChunkRange range = families.of(chunk, node.first_child, node.child_count);
      if (range.last - range.first > 1) divided.push_back(range);
    });
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

bool Linker::refuse_if_large(const Family& family, Roots& roots, const Lane& lane) {
  const uint64_t cut = most_cut_ + lane.cut;
  // A bound nearly always has room: then nothing is counted.
  uint64_t slots = 0;
  for (uint32_t chunk = family.chunks.first; chunk < family.chunks.last; ++chunk)
    slots += tables_[chunk].slots();
  if (has_room_for_cut(cut, slots)) return false;
  const uint64_t ends = ends_of(family, roots);
  if (has_room_for_cut(cut, ends)) return false;
  refused_.insert({ends, family});
  return true;
}

// Several threads miss nothing: whoever marks a subtree then tries all families below it, and
// whoever has tried such a family before left it to them. So the marks need no order.
void Linker::link(std::span<const Family> above, bool has_room, Lane& lane) {
  Roots roots(*this);
  ChunkGraph::Families families(*graph_);
  Work work(above, lane.work);
  while (!work.done()) {
    const Family family = work.take();
    LinkTable& table = tables_.known(family.chunk);
    if (table.leads_on(family.node.index) || !table.leads_to(family.subtree) || !complete(family) ||
        (!has_room && refuse_if_large(family, roots, lane)) ||
        !table.begin_to_lead_on(family.node.index))
      continue;
    const uint32_t parent = table.slot * shape_.nodes + family.node.place;
    --lane.cut;
    Addresses addresses(shape_);
    uint32_t first_below = kLowest, asked = kNoNode;
    bool leads_on = false;  // may_lead_on(asked)
    each_subtree(family, roots, [&](Walk& walk) {
      const LinkWalk& at = walk.at;
      LinkTable& of = tables_.known(walk.chunk);
      lane.cut += at.ends();
      lane.slots_linked += at.slot_count();
      first_below = std::min(first_below, at.subtree());
      SearchSubtree linked = addresses.of(of, at, family.record);
      set_records(walk, linked);
      of.set_leads_to(at.index(), true);
      lane.patch.outside.push_back(outside_of(at, linked, parent));
      lane.patch.linked.emplace_back(at.subtree(), linked);
      if (asked != walk.chunk) {
        asked = walk.chunk;
        leads_on = may_lead_on(walk.chunk);
      }
      if (!leads_on) return;
      at.each_below([&](const NodeBelow& node) {
        work.add(family_of({walk.chunk, at.index(), walk.records(node.record), node}, families));
      });
    });
    lane.patch.tied.records.push_back({family.record, kLowest | first_below});
    lane.patch.tied.changed.push_back(table.first_subtree + family.subtree);
  }
}

// Marks only go meanwhile, and whoever clears a family's goes on below it.
void Linker::unlink(std::span<const Family> above, Lane& lane) {
  Roots roots(*this);
  ChunkGraph::Families families(*graph_);
  Work work(above, lane.work);
  while (!work.done()) {
    const Family family = work.take();
    LinkTable& table = tables_.known(family.chunk);
    if (!table.end_to_lead_on(family.node.index)) {
      if (!refused_.empty() && complete(family)) refused_.erase({ends_of(family, roots), family});
      continue;
    }
    lane.patch.cut.records.push_back({family.record, kBlocked});
    lane.patch.cut.changed.push_back(table.first_subtree + family.subtree);
    ++lane.cut;
    each_subtree(family, roots, [&](Walk& walk) {
      tables_.known(walk.chunk).set_leads_to(walk.at.index(), false);
      lane.cut -= walk.at.ends();
      lane.slots_linked -= walk.at.slot_count();
      lane.patch.unlinked.push_back(walk.at.subtree());
      walk.at.each_below([&](const NodeBelow& node) {
        if (!refused_.empty() || tables_[walk.chunk].leads_on(node.index))
          work.add(
              family_of({walk.chunk, walk.at.index(), walk.records(node.record), node}, families));
      });
    });
  }
}

// Its subtrees of the tree's root. Runs of that are in chunks that are never evicted and come in
// order, none without the one before (check()), so that the first of them has the node itself.
void Linker::link_root(uint32_t last, LinkPatch& patch) {
  Addresses addresses(shape_);
  for (uint32_t chunk = 0; chunk <= last; ++chunk) {
    Walk walk = this->walk(chunk);
    for (LinkWalk& at = walk.at; !at.at_end() && at.root() == 0; at.next()) {
      LinkTable& table = tables_.known(chunk);
      SearchSubtree linked = addresses.of(table, at, kNoRecord);
      if (chunk != last) continue;
      set_records(walk, linked);
      table.set_leads_to(at.index(), true);
      most_cut_ += at.ends();
      slots_linked_ += at.slot_count();
      patch.outside.push_back(outside_of(at, linked, kNoNode));
      patch.linked.emplace_back(at.subtree(), linked);
    }
  }
}

}  // namespace voyager
