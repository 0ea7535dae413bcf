#pragma once
// What a frame asks of the cut search, and what the search adds to its counters.
#include <algorithm>

#include "runtime/frame/backend.h"
#include "runtime/frame/instance.h"
#include "runtime/select/cut.h"

namespace voyager {

// camera: in the scene's coordinates; origin: the scene's.
inline CutQuery cut_query(const Camera& camera, double tau, const Vec3d& origin) {
  return {cut_centre(camera.eye, origin), target_size(tau, camera.fx)};
}

// Of the view's instance with that index. One cut serves all eyes (METHOD §3): seen from the point
// amid them, as fine as the finest of them wants it.
inline CutQuery cut_query(const FrameInput& frame, size_t instance, const Vec3d& origin) {
  const Camera first = instance_camera(frame, frame.eyes[0], instance);
  CutQuery query = cut_query(first, frame.tau, origin);
  if (frame.eyes.size() == 1) return query;
  const Camera second = instance_camera(frame, frame.eyes[1], instance);
  query.centre = cut_centre(0.5 * (first.eye + second.eye), origin);
  query.target_size = std::min(query.target_size, cut_query(second, frame.tau, origin).target_size);
  return query;
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
  stats.missing += found.stand_ins;
}

}  // namespace voyager
