#include "runtime/frame/draw_list.h"

#include <algorithm>

#include "runtime/base/error.h"

namespace voyager {

GaussianArrays gaussian_arrays(const Scene& scene) {
  return {scene.gaussians.data(), scene.sh.data(), scene.axis_code.data(), scene.sh_degree};
}

DrawList::DrawList(std::shared_ptr<const Scene> scene, Lod lod, std::pmr::memory_resource* memory)
    : scene_(std::move(scene)),
      lod_(scene_->flat() ? Lod::all_leaves : lod),
      search_(memory),
      items_(memory) {
  for (const DamagedNodes& d : scene_->damaged) missing_.push_back({d.first, d.count});
  if (lod_ == Lod::all_leaves) list_leaves();
}

void DrawList::list_leaves() {
  if (scene_->flat()) {
    const auto count = static_cast<uint32_t>(scene_->gaussians.size());
    items_.reserve(count);
    for (uint32_t i = 0; i < count; ++i) items_.push_back({i, kNoNode, 1.0f, 1.0f});
    return;
  }
  items_.reserve(scene_->leaves.size());
  leaves_missing_ =
      std::find(scene_->leaves.begin(), scene_->leaves.end(), kNoNode) != scene_->leaves.end();
  if (leaves_missing_) return;
  for (const uint32_t node : scene_->leaves) items_.push_back({node, kNoNode, 1.0f, 1.0f});
}

void DrawList::refuse_damaged(uint32_t node) const {
  for (const DamagedNodes& d : scene_->damaged)
    if (node == kNoNode || (node >= d.first && node - d.first < d.count))
      throw Error(ErrorCode::damaged_chunk, d.message);
  throw Error(ErrorCode::internal,
              "node " + std::to_string(node) + ": missing, but in no damaged chunk");
}

void DrawList::update(const FrameInput& frame, Workers& workers) {
  if (lod_ == Lod::all_leaves) {
    if (leaves_missing_) refuse_damaged(kNoNode);
    return;
  }
  const CutQuery query{cut_centre(frame.camera.eye, scene_->origin),
                       target_size(frame.tau, frame.camera.fx)};
  search_.run(scene_->tree, missing_, query, workers);
  if (search_.needed_missing() != kNoNode) refuse_damaged(search_.needed_missing());

  const auto& cut = search_.cut();
  items_.resize(cut.size());
  const WeightParams weights{scene_->tree.records.data(), scene_->tree.parent.data(),
                             search_.sizes().data(), query.target_size};
  workers.for_blocks(cut.size(), 16384, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) items_[i] = weigh(weights, cut[i]);
  });
}

void DrawList::collect(FrameStats& stats) const {
  stats.cut_size = items_.size();
  stats.nodes_tested = lod_ == Lod::cut ? search_.nodes_tested() : 0;
  stats.bytes_read = stats.nodes_tested * sizeof(NodeRecord);
}

}  // namespace voyager
