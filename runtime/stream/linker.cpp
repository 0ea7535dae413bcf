#include "runtime/stream/linker.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "runtime/select/search_records.h"

namespace voyager {
namespace {

// Addresses of a family's nodes, from one of its subtrees to the next: a node that is repeated
// is where its owner has it.
class Addresses {
 public:
  explicit Addresses(SlotShape shape) : shape_(shape) {}

  SearchSubtree of(const LinkTable& table, uint32_t index, uint32_t entry) {
    const StagedSubtree& s = table.subtrees[index];
    const uint32_t base = table.slot * shape_.nodes;
    if (!s.ids.repeats_root()) root_ = base + s.first_place[0];
    if (s.ids.child_count != 0 && !s.ids.repeats_child()) first_child_ = base + s.first_place[1];
    return {root_,
            first_child_,
            base + s.first_place[2],
            slot_levels(s.ids) | (is_scattered(table, s) ? kScattered : 0),
            s.interior == 0 ? 0 : table.record(s.first_record),
            s.interior,
            s.families,
            entry};
  }

 private:
  static bool is_scattered(const LinkTable& table, const StagedSubtree& s) {
    const auto records = static_cast<uint32_t>(std::popcount(s.interior));
    bool scattered = false;
    for (uint32_t k = 1; k < records; ++k)
      scattered |= table.record(s.first_record + k) != table.record(s.first_record) + k;
    return scattered;
  }

  SlotShape shape_;
  uint32_t root_ = 0, first_child_ = 0;
};

// Of what the chunk could not know by itself. number: the subtree's. parent: what the roots hang
// from.
LinkPatch::Outside outside_of(const StagedSubtree& from, const SearchSubtree& subtree,
                              uint32_t number, uint32_t parent) {
  switch (from.ids.repeated) {
    case Repeats::nothing:
      break;
    case Repeats::root:
      return {number, subtree.first_child, from.ids.child_count, subtree.root};
    case Repeats::root_and_child:
      return {number, subtree.first_grandchild, from.ids.grandchild_count, subtree.first_child};
  }
  return {number, subtree.root, from.ids.root_count, parent};
}

// The node that a root hangs from.
uint32_t find_below(const std::vector<NodeBelow>& below, uint32_t root) {
  const auto after =
      std::upper_bound(below.begin(), below.end(), root,
                       [](uint32_t r, const NodeBelow& node) { return r < node.first_child; });
  return static_cast<uint32_t>(after - below.begin() - 1);
}

}  // namespace

Linker::Linker(const ChunkGraph& graph, SlotShape shape)
    : graph_(&graph), shape_(shape), tables_(graph.size()) {}

Linker::Family Linker::family_of(uint32_t root) const {
  const uint32_t chunk = graph_->owner_of_parent(root);
  return {chunk, find_below(tables_[chunk]->below, root)};
}

ChunkRange Linker::chunks_of(const Family& family) const {
  const NodeBelow& node = below_of(family);
  return graph_->with_family(family.chunk, node.first_child, node.child_count);
}

bool Linker::complete(const Family& family) const {
  const ChunkRange range = chunks_of(family);
  for (uint32_t chunk = range.first; chunk < range.last; ++chunk)
    if (!holds(chunk)) return false;
  return true;
}

template <class Visit>
void Linker::each_subtree(const Family& family, const Visit& visit) const {
  const ChunkRange range = chunks_of(family);
  const NodeBelow& node = below_of(family);
  for (uint32_t chunk = range.first; chunk < range.last; ++chunk) {
    if (!holds(chunk)) continue;
    LinkTable& table = *tables_[chunk];
    const auto& all = table.subtrees;
    // Roots ascend in a tier, and those of a later tier are greater.
    auto s = std::lower_bound(
        all.begin(), all.end(), node.first_child,
        [](const StagedSubtree& subtree, uint32_t root) { return subtree.ids.root < root; });
    for (; s != all.end() && s->ids.root - node.first_child < node.child_count; ++s)
      visit(table, static_cast<uint32_t>(s - all.begin()));
  }
}

// Those that the chunk's subtrees belong to, each once.
template <class Work>
void Linker::each_family_of(const LinkTable& table, const Work& work) const {
  uint32_t done = 0;  // roots before this
  for (const StagedSubtree& s : table.subtrees) {
    if (s.ids.root == 0 || s.ids.root < done) continue;
    const Family family = family_of(s.ids.root);
    done = below_of(family).first_child + below_of(family).child_count;
    work(family);
  }
}

void Linker::add_below(const LinkTable& table, uint32_t subtree, std::vector<Family>& out) const {
  const uint32_t end = subtree + 1 < table.subtrees.size()
                           ? table.subtrees[subtree + 1].first_below
                           : static_cast<uint32_t>(table.below.size());
  for (uint32_t below = table.subtrees[subtree].first_below; below < end; ++below)
    out.push_back({table.chunk, below});
}

// records: of the roots.
void Linker::check_roots(const LinkTable& own, const Subtree& subtree, const NodeRecord* records,
                         const std::string& file) const {
  const uint32_t owner = graph_->owner_of_parent(subtree.root);
  const auto& below = owner == own.chunk ? own.below : tables_[owner]->below;
  const NodeBelow& parent = below[find_below(below, subtree.root)];
  if (subtree.root_count > parent.child_count - (subtree.root - parent.first_child))
    refuse_roots(own.chunk, subtree.root, file);
  for (uint32_t i = 0; i < subtree.root_count; ++i)
    if (!is_inside(records[i], parent.box)) refuse_nesting(own.chunk, subtree.root + i, file);
}

void Linker::check(const StagedChunk& chunk, const std::string& file) const {
  const LinkTable& own = chunk.links;
  const auto& subtrees = own.subtrees;
  if (subtrees[0].ids.root == 0 && own.chunk > 0 && !holds(own.chunk - 1))
    refuse_gap(own.chunk, file);
  const NodeRecord* record = chunk.roots.data();  // of the subtree's first root
  for (const StagedSubtree& s : subtrees) {
    if (s.ids.root != 0) check_roots(own, s.ids, record, file);
    record += s.ids.root_count;
  }
  const auto check_repeat = [&](const Subtree& repeats, const LinkTable& before,
                                const LinkTable& after) {
    if (repeats.repeats_root() && !is_same(before.last_root, after.first_root))
      refuse_repeat(own.chunk, repeats.root, file);
    if (repeats.repeats_child() && !is_same(before.last_child, after.first_child))
      refuse_repeat(own.chunk, repeats.first_child, file);
  };
  if (own.chunk > 0 && holds(own.chunk - 1))
    check_repeat(subtrees[0].ids, *tables_[own.chunk - 1], own);
  if (own.chunk + 1 < graph_->size() && holds(own.chunk + 1))
    check_repeat(tables_[own.chunk + 1]->subtrees[0].ids, own, *tables_[own.chunk + 1]);
}

void Linker::add_large(const LinkTable& table, LinkPatch& patch) {
  if (table.large.empty()) return;
  for (const LargeFamily& family : table.large)
    large_.push_back({table.slot * shape_.nodes + family.parent, family.children});
  std::sort(large_.begin(), large_.end(),
            [](const LargeFamily& a, const LargeFamily& b) { return a.parent < b.parent; });
  patch.large = large_;
}

void Linker::remove_large(const LinkTable& table, LinkPatch& patch) {
  if (table.large.empty()) return;
  std::erase_if(large_, [&](const LargeFamily& family) {
    return family.parent / shape_.nodes == table.slot;
  });
  patch.large = large_;
}

void Linker::arrive(LinkTable&& table, LinkPatch& patch) {
  const uint32_t chunk = table.chunk;
  tables_.know(chunk) = std::make_unique<LinkTable>(std::move(table));
  LinkTable& own = *tables_[chunk];
  add_large(own, patch);
  for (uint32_t i = 0; i < own.subtrees.size() && own.subtrees[i].ids.root == 0; ++i)
    link_root(own, i, patch);
  each_family_of(own, [&](const Family& family) { link(family, patch); });
}

// A subtree of the tree's root. Runs of it are in chunks that are never evicted and come in
// order, none without the one before (check()), so that the first of them has the node itself.
void Linker::link_root(LinkTable& table, uint32_t subtree, LinkPatch& patch) {
  Addresses addresses(shape_);
  SearchSubtree linked{};
  for (uint32_t chunk = 0; chunk <= table.chunk; ++chunk) {
    const uint32_t end =
        chunk == table.chunk ? subtree + 1 : static_cast<uint32_t>(tables_[chunk]->subtrees.size());
    for (uint32_t i = 0; i < end; ++i) linked = addresses.of(*tables_[chunk], i, kNoRecord);
  }
  table.subtrees[subtree].linked = true;
  const uint32_t number = table.first_subtree + subtree;
  patch.outside.push_back(outside_of(table.subtrees[subtree], linked, number, kNoNode));
  patch.linked.emplace_back(number, linked);
}

void Linker::link(Family first, LinkPatch& patch) {
  work_.assign(1, first);
  while (!work_.empty()) {
    const Family family = work_.back();
    work_.pop_back();
    LinkTable& table = *tables_[family.chunk];
    NodeBelow& node = table.below[family.below];
    if (node.linked || !table.subtrees[node.subtree].linked || !complete(family)) continue;
    node.linked = true;
    const uint32_t record = table.record(node.record);
    const uint32_t parent = table.slot * shape_.nodes + node.node;
    Addresses addresses(shape_);
    uint32_t first_below = kLowest;
    each_subtree(family, [&](LinkTable& of, uint32_t i) {
      const uint32_t subtree = of.first_subtree + i;
      first_below = std::min(first_below, subtree);
      const SearchSubtree linked = addresses.of(of, i, record);
      of.subtrees[i].linked = true;
      patch.outside.push_back(outside_of(of.subtrees[i], linked, subtree, parent));
      patch.linked.emplace_back(subtree, linked);
      add_below(of, i, work_);
    });
    patch.tied.records.push_back({record, kLowest | first_below});
    patch.tied.changed.push_back(table.first_subtree + node.subtree);
  }
}

void Linker::unlink(Family first, LinkPatch& patch) {
  work_.assign(1, first);
  while (!work_.empty()) {
    const Family family = work_.back();
    work_.pop_back();
    LinkTable& table = *tables_[family.chunk];
    NodeBelow& node = table.below[family.below];
    if (!std::exchange(node.linked, false)) continue;
    patch.cut.records.push_back({table.record(node.record), kBlocked});
    patch.cut.changed.push_back(table.first_subtree + node.subtree);
    each_subtree(family, [&](LinkTable& of, uint32_t i) {
      of.subtrees[i].linked = false;
      patch.unlinked.push_back(of.first_subtree + i);
      add_below(of, i, work_);
    });
  }
}

void Linker::evict(uint32_t chunk, LinkPatch& patch) {
  each_family_of(*tables_[chunk], [&](const Family& family) { unlink(family, patch); });
  remove_large(*tables_[chunk], patch);
  tables_.forget(chunk);
}

}  // namespace voyager
