#pragma once
// What a frame asks of the cut search, and what the search adds to its counters.
#include "runtime/frame/backend.h"
#include "runtime/select/cut.h"

namespace voyager {

// camera: in the scene's coordinates; origin: the scene's.
inline CutQuery cut_query(const Camera& camera, double tau, const Vec3d& origin) {
  return {cut_centre(camera.eye, origin), target_size(tau, camera.fx)};
}

// Of one instance, in their order. counts_changes: entered and left are the search's own.
inline void add_search(const SearchStats& found, bool counts_changes, FrameStats& stats) {
  if (!stats.searched) stats.search = found.ran;
  stats.searched = true;
  stats.nodes_tested += found.nodes_tested;
  stats.subtrees_visited += found.subtrees_visited;
  stats.chunks_read += found.chunks_read;
  stats.bytes_read += found.bytes_read;
  stats.changes_counted = stats.changes_counted && counts_changes;
  stats.entered += found.entered;
  stats.left += found.left;
}

}  // namespace voyager
