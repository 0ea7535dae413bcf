#include "runtime/frame/scene_search.h"

#include "runtime/base/error.h"
#include "runtime/frame/scene.h"

namespace voyager {

void check_detail(const Scene& scene, Lod lod) {
  if (lod == Lod::cut) return;
  if (scene.streamed())
    throw Error(ErrorCode::unsupported, std::string("lod: found ") +
                                            (lod == Lod::all_leaves ? "all leaves"
                                             : lod == Lod::blocks   ? "blocks"
                                                                    : "levels") +
                                            " for a streamed scene, expected a cut: most of its "
                                            "tree is not resident");
  if (lod != Lod::all_leaves && !scene.damaged_chunks.empty())
    throw Error(ErrorCode::damaged_chunk, scene.damaged_chunks[0].message);
}

}  // namespace voyager
