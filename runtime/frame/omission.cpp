#include "runtime/frame/omission.h"

#include "runtime/frame/scene.h"

namespace voyager {
namespace {

// What the search of either backend keeps of a subtree, at least; and what a streamed scene has
// more of each subtree and node, in either's memory.
constexpr uint64_t kSearchBytes = 20, kResidencyBytes = sizeof(uint32_t);

}  // namespace

std::vector<Omission> omissions_of(const Scene& scene, bool searched, uint64_t splats) {
  std::vector<Omission> all;
  for (const SceneNote& note : scene.notes)
    if (note.kind == SceneNote::Kind::omitted)
      all.push_back({note.what, note.why, note.bytes, splats * note.splat_bytes});
  const uint64_t subtrees = scene.search.subtree_count();
  if (!scene.flat() && !searched)
    all.push_back({"search", "every leaf is drawn", subtrees * kSearchBytes, 0});
  if (!scene.flat() && !scene.streamed())
    all.push_back(
        {"residency",
         "the whole scene is in memory: it needs no table of resident chunks and no reader",
         (subtrees + scene.node_count) * kResidencyBytes, 0});
  return all;
}

std::vector<Omission> omissions_of(const ViewShape& shape) {
  std::vector<Omission> all;
  const uint64_t depth = shape.eyes * shape.pixels * sizeof(float);
  if (depth != 0 && !shape.depth) all.push_back({"depth", "no frame asked for it", depth, depth});
  if (shape.eyes == 1)
    all.push_back(
        {"second eye", "the view has one; bytes are what the first one takes", shape.eye_bytes, 0});
  return all;
}

}  // namespace voyager
