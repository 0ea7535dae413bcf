#include <algorithm>
#include <utility>

#include "cuda/cut_state.h"
#include "cuda/search.h"
#include "cuda/search_launch.h"
#include "runtime/select/references.h"

namespace voyager::cuda {
namespace {

// Streaming takes over where more than one in so many subtrees has run out of slack:
// between where it begins to pay on a whole H200 (one in six) and on 16 of its
// multiprocessors (one in three). bench/NOTES.md has the measurement.
constexpr uint32_t kSubtreesADue = 4;

size_t count_leaves(const LodTree& tree) {
  return static_cast<size_t>(std::count_if(tree.records.begin(), tree.records.end(),
                                           [](const NodeRecord& r) { return r.child_count == 0; }));
}

class PartitionedSearch final : public CutSearch {
 public:
  PartitionedSearch(std::shared_ptr<const Device> device, std::shared_ptr<const DeviceTree> tree,
                    std::shared_ptr<const Scene> scene, Search kind, bool weights)
      : device_(std::move(device)),
        tree_(std::move(tree)),
        scene_(std::move(scene)),
        kind_(kind),
        weights_(weights),
        state_(scene_->search, count_leaves(scene_->tree), weights) {}

  // What it frees belongs to the device's context.
  ~PartitionedSearch() override { device_->use_quietly(); }

  void find(const CutQuery& query, cudaStream_t stream) override;
  void weigh(const CutQuery& query, cudaStream_t stream) override;
  CutList list() const override;
  size_t report_bytes() const override { return sizeof(FrameCounters); }
  void report(void* into, cudaStream_t stream) const override;
  CutFound found(const void* report) const override;
  bool counts_changes() const override { return true; }
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override;

 private:
  FrameCounters counters() const;
  SearchFrame frame(const CutQuery& query, cudaStream_t stream) const;

  std::shared_ptr<const Device> device_;
  std::shared_ptr<const DeviceTree> tree_;
  std::shared_ptr<const Scene> scene_;
  Search kind_;
  bool weights_;
  CutState state_;
  References references_;
  bool started_ = false;
};

SearchFrame PartitionedSearch::frame(const CutQuery& query, cudaStream_t stream) const {
  return {tree_->view(),
          state_.view(),
          make_sight(query),
          references_.current(),
          device_->multiprocessors(),
          stream};
}

void PartitionedSearch::find(const CutQuery& query, cudaStream_t stream) {
  references_.begin_frame(query);
  const SearchFrame now = frame(query, stream);
  const bool from_nothing = !std::exchange(started_, false);  // should a launch fail, too
  if (now.tree.subtree_count != 0) {
    if (kind_ == Search::streaming || from_nothing) {
      launch_streaming(now);
    } else if (kind_ == Search::temporal_visit) {
      launch_temporal_visit(now);
    } else {
      Travels travels;
      std::copy(references_.travel().begin(), references_.travel().end(), travels.of);
      travels.retired = references_.retired();
      launch_temporal(now, travels, now.tree.subtree_count / kSubtreesADue);
    }
    launch_place(now);
    launch_emit(now, weights_);
  }
  started_ = true;
}

void PartitionedSearch::weigh(const CutQuery& query, cudaStream_t stream) {
  const SearchFrame now = frame(query, stream);
  if (now.tree.subtree_count != 0) launch_weigh(now);
}

CutList PartitionedSearch::list() const {
  const StateView state = state_.view();
  return {state.nodes, weights_ ? state.weights : nullptr, &state.work[1].list_size,
          state_.list_room()};
}

FrameCounters PartitionedSearch::counters() const {
  FrameCounters counters;
  check(cudaMemcpy(&counters, state_.view().work + 1, sizeof counters, cudaMemcpyDeviceToHost),
        "counters");
  return counters;
}

void PartitionedSearch::report(void* into, cudaStream_t stream) const {
  check(cudaMemcpyAsync(into, state_.view().work + 1, sizeof(FrameCounters),
                        cudaMemcpyDeviceToHost, stream),
        "counters");
}

CutFound PartitionedSearch::found(const void* report) const {
  const FrameCounters& c = *static_cast<const FrameCounters*>(report);
  SearchStats stats;
  stats.ran = c.streamed != 0 ? Search::streaming : kind_;
  stats.nodes_tested = c.nodes_tested;
  stats.subtrees_visited = c.subtrees_visited;
  stats.chunks_read = c.chunks_read;
  stats.bytes_read = c.bytes_read;
  stats.entered = c.entered;
  stats.left = c.left;
  return {stats, c.cut_size};
}

void PartitionedSearch::read(std::vector<uint32_t>& cut, std::vector<float>& weights) {
  const size_t places = counters().list_size;
  const StateView state = state_.view();
  cut.resize(places);
  weights.resize(weights_ ? places : 0);
  if (places != 0)
    check(cudaMemcpy(cut.data(), state.nodes, places * sizeof(uint32_t), cudaMemcpyDeviceToHost),
          "cut");
  if (!weights.empty())
    check(cudaMemcpy(weights.data(), state.weights, places * sizeof(float), cudaMemcpyDeviceToHost),
          "weights");
  size_t used = 0;
  for (size_t i = 0; i < places; ++i) {
    if (cut[i] == kNoNode) continue;
    cut[used] = cut[i];
    if (weights_) weights[used] = weights[i];
    ++used;
  }
  cut.resize(used);
  weights.resize(weights_ ? used : 0);
}

}  // namespace

std::shared_ptr<const DeviceTree> upload_tree(const Scene& scene) {
  return std::make_shared<DeviceTree>(scene.search, scene.tree);
}

std::unique_ptr<CutSearch> create_partitioned_search(std::shared_ptr<const Device> device,
                                                     std::shared_ptr<const DeviceTree> tree,
                                                     std::shared_ptr<const Scene> scene,
                                                     Search kind, bool weights) {
  device->use();
  return std::make_unique<PartitionedSearch>(std::move(device), std::move(tree), std::move(scene),
                                             kind, weights);
}

}  // namespace voyager::cuda
