#pragma once
// The cut search of a scene by itself, for measurements and tests; a frame's pipeline
// runs the same search as its first stage.
#include <cstdint>
#include <vector>

#include "runtime/select/cut.h"
#include "runtime/select/detail.h"
#include "runtime/select/search.h"

namespace voyager {

struct SearchDesc {
  Search kind = Search::temporal;
  bool weights = true;  // also t of each cut node (METHOD §4)
  Lod lod = Lod::cut;   // all_leaves has no search
};

struct Scene;

// Throws Error(unsupported) for what a streamed scene cannot be drawn as, and Error(damaged_chunk)
// for a baseline of a scene with damage.
void check_detail(const Scene& scene, Lod lod);

// Milliseconds of the last run. A search that finds weights in the same pass counts
// them as search.
struct SearchTimes {
  double search = 0, weights = 0;
};

// Keeps its cut from run to run. Not thread-safe.
class SceneSearch {
 public:
  virtual ~SceneSearch() = default;
  // A device may still be at work when it returns; what follows waits for it.
  virtual void run(const CutQuery& query) = 0;
  virtual SearchTimes times() = 0;
  virtual SearchStats stats() = 0;
  // Node ids, ascending, and t of each (none where the weights are not wanted).
  virtual void read(std::vector<uint32_t>& cut, std::vector<float>& weights) = 0;
};

}  // namespace voyager
