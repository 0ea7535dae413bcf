#include "runtime/frame/draw_list.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager {

DrawList::DrawList(std::shared_ptr<const Scene> scene, Lod lod, Search search,
                   std::pmr::memory_resource* memory, Workers& workers)
    : scene_(std::move(scene)), leaves_(memory) {
  check_detail(*scene_, lod);
  if (scene_->flat() || !draws_cut(lod))
    list_leaves();
  else
    search_.emplace(scene_, SearchDesc{search, true, lod}, memory, workers);
}

void DrawList::list_leaves() {
  if (scene_->flat()) {
    const auto count = static_cast<uint32_t>(gaussian_count(*scene_));
    leaves_.reserve(count);
    for (uint32_t i = 0; i < count; ++i) leaves_.push_back({i, kNoNode, 1.0f, 1.0f});
    return;
  }
  leaves_.reserve(scene_->leaves.size());
  leaves_missing_ =
      std::find(scene_->leaves.begin(), scene_->leaves.end(), kNoNode) != scene_->leaves.end();
  if (leaves_missing_) return;
  for (const uint32_t node : scene_->leaves) leaves_.push_back({node, kNoNode, 1.0f, 1.0f});
}

void DrawList::update(const CutQuery& query, Workers& workers) {
  if (leaves_missing_) throw Error(ErrorCode::damaged_chunk, scene_->damaged[0].message);
  if (search_) search_->run(query, workers);
}

void DrawList::collect(FrameStats& stats) const {
  stats.cut_size += items().size();
  if (search_) add_search(search_->stats(), search_->counts_changes(), stats);
}

}  // namespace voyager
