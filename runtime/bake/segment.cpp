#include "runtime/bake/segment.h"

#include "runtime/format/gather.h"

namespace voyager {
namespace {

// As SubtreeCursor::take() moves on over a subtree that repeats nothing.
void pass(const Subtree& subtree, uint32_t levels, const LodTree& tree, SubtreePlace& place) {
  place.next[0] += subtree.root_count;
  place.next[1] += subtree.child_count;
  place.next[2] += subtree.grandchild_count;
  const uint32_t first = subtree.first_slot(levels - 1);
  for (uint32_t slot = first; slot < subtree.node_count(); ++slot)
    place.next[3] += tree.records[subtree.node(slot)].child_count;
}

EntryHull hull_above(const SegmentNodes& nodes, const Subtree& subtree) {
  const LodTree& tree = nodes.baked.tree;
  if (subtree.root != 0) return hull_of(tree.records[tree.parent[subtree.root]]);
  return nodes.above ? hull_of(*nodes.above) : hull_of_root(tree.records[0]);
}

}  // namespace

SegmentRuns divide(const Segment& segment, const SegmentNodes& nodes, uint32_t chunk_bytes) {
  SegmentRuns runs;
  split_tier(nodes.baked.tree, nodes.levels, nodes.first_root, nodes.end_root, runs.subtrees);
  SubtreePlace place = segment.place;
  runs.places.push_back(place);
  runs.begin.push_back(0);
  // Only the first subtree of the file finds no chunk at all.
  bool open = segment.first_subtree != 0;
  uint64_t bytes = segment.open_bytes;
  for (uint32_t i = 0; i < runs.subtrees.size(); ++i) {
    const uint64_t more = runs.subtrees[i].node_count() * sizeof(NodeRecord);
    if (!open || bytes + more > chunk_bytes) {
      runs.places.push_back(place);
      runs.begin.push_back(i);
      open = true;
      bytes = 0;
    }
    bytes += more;
    pass(runs.subtrees[i], nodes.levels, nodes.baked.tree, place);
  }
  runs.begin.push_back(static_cast<uint32_t>(runs.subtrees.size()));
  join_siblings(nodes.baked.tree, runs.begin, runs.subtrees);
  return runs;
}

Piece make_piece(const Segment& segment, const SegmentNodes& nodes, const SegmentRuns& runs,
                 size_t index) {
  const uint32_t begin = runs.begin[index], end = runs.begin[index + 1];
  Piece piece;
  if (begin == end) return piece;
  const auto subtrees = std::span(runs.subtrees).subspan(begin, end - begin);
  piece.chunk = gather_chunk(nodes.baked, subtrees, segment.first_subtree + begin);
  if (nodes.sources)
    for (uint32_t& source : piece.chunk.source_index)
      if (source != kNoNode) source = (*nodes.sources)[source];
  piece.place = runs.places[index];
  piece.hull = hull_above(nodes, subtrees.front());
  for (const Subtree& subtree : subtrees.subspan(1))
    piece.hull = join(piece.hull, hull_above(nodes, subtree));
  return piece;
}

}  // namespace voyager
