#include <algorithm>
#include <utility>

#include "cuda/interop/external_ring.h"
#include "cuda/search/cut_state.h"
#include "cuda/search/search.h"
#include "cuda/stream/device_pool.h"
#include "cuda/stream/stream_changes.h"
#include "runtime/select/references.h"

namespace voyager::cuda {
namespace {

// Streaming takes over where more than one in so many of the tables' subtrees has run out of slack:
// on a whole H100 and on 16 of its multiprocessors it pays by then, with tables of all subtrees.
// bench/NOTES.md has the measurement.
constexpr uint32_t kSubtreesADue = 8;

// What a search of a streamed scene follows.
struct Streamed {
  Streamed(const Scene& scene, const Device& device) : pool(pool_of(scene, device)), reader(pool) {}

  DevicePool& pool;
  PoolReader reader;
  StreamChanges changes;
};

class PartitionedSearch final : public CutSearch {
 public:
  PartitionedSearch(std::shared_ptr<const Device> device, std::shared_ptr<const DeviceTree> tree,
                    std::shared_ptr<const Scene> scene, Search kind, bool weights)
      : device_(std::move(device)),
        tree_(std::move(tree)),
        scene_(std::move(scene)),
        kind_(without_sweep(kind)),
        weights_(weights),
        streamed_(scene_->streamed() ? std::make_unique<Streamed>(*scene_, *device_) : nullptr),
        most_(most_nodes()),
        state_(std::make_unique<CutState>(scene_->search, tree_->view().place_count, most_,
                                          weights)) {}

  // What it frees belongs to the device's context.
  ~PartitionedSearch() override { device_->use_quietly(); }

  void find(const CutQuery& query, cudaStream_t stream) override;
  void bound(const GaussianView& gaussians, cudaStream_t stream) override;
  void weigh(const CutQuery& query, cudaStream_t stream) override;
  WeightSource weight_source(const CutQuery& query) const override;
  CutList list() const override;
  void end_frame(cudaStream_t stream) noexcept override {
    if (streamed_) streamed_->reader.end(stream);
  }
  size_t report_bytes() const override { return sizeof(FrameCounters); }
  void report(void* into, cudaStream_t stream) const override;
  CutFound found(const void* report) const override;
  bool counts_changes() const override { return true; }
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override;

 private:
  FrameCounters counters() const;
  SearchFrame frame(const CutQuery& query, cudaStream_t stream) const;
  uint64_t most_nodes() const;
  bool fit_pool(cudaStream_t stream);
  bool follow_stream(const SearchFrame& now, bool goes_on);

  std::shared_ptr<const Device> device_;
  std::shared_ptr<const DeviceTree> tree_;
  std::shared_ptr<const Scene> scene_;
  Search kind_;
  bool weights_;
  const std::unique_ptr<Streamed> streamed_;  // where the scene is
  uint64_t most_;                             // nodes of a cut
  std::unique_ptr<CutState> state_;
  References references_;
  bool started_ = false;
};

SearchFrame PartitionedSearch::frame(const CutQuery& query, cudaStream_t stream) const {
  return {tree_->view(),         state_->view(tree_->view().places), make_sight(query),
          references_.current(), device_->multiprocessors(),         stream};
}

// Of a streamed scene: of those that are there. That a tree has no more leaves than its file says
// is known only where all of it was read.
uint64_t PartitionedSearch::most_nodes() const {
  if (!streamed_) return scene_->leaf_count;
  return std::min<uint64_t>(scene_->node_count, streamed_->pool.gaussians().count);
}

// Whether there was room for a cut of the pool, which may have grown.
bool PartitionedSearch::fit_pool(cudaStream_t stream) {
  const uint64_t most = most_nodes();
  const uint32_t places = tree_->view().place_count;
  if (state_ && most <= most_ && places <= state_->view().place_count) return true;
  wait_for_host(stream);
  state_.reset();
  state_ = std::make_unique<CutState>(scene_->search, places, most, weights_);
  most_ = most;
  return false;
}

// Whether the search goes on from its last cut.
bool PartitionedSearch::follow_stream(const SearchFrame& now, bool goes_on) {
  const std::optional<Relinked> relinked = streamed_->changes.follow(*scene_->stream);
  if (!goes_on || !relinked) {
    launch_forget(now);
    return false;
  }
  if (relinked->unlinked_count + relinked->changed_count == 0) return true;
  launch_relink(now, *relinked);
  streamed_->changes.read_by(now.stream);
  return true;
}

void PartitionedSearch::find(const CutQuery& query, cudaStream_t stream) {
  references_.begin_frame(query);
  bool goes_on = std::exchange(started_, false);  // should a launch fail, it does not
  if (streamed_) {
    streamed_->reader.begin(stream);
    goes_on = fit_pool(stream) && goes_on;
  }
  const SearchFrame now = frame(query, stream);
  if (streamed_) goes_on = follow_stream(now, goes_on);
  if (now.tree.subtree_count != 0) {
    if (kind_ == Search::streaming || !goes_on) {
      launch_streaming(now);
    } else if (kind_ == Search::temporal_visit) {
      launch_list_open(now);
      launch_temporal(now, UINT32_MAX);
    } else {
      Travels travels;
      std::copy(references_.travel().begin(), references_.travel().end(), travels.of);
      travels.retired = references_.retired();
      launch_check(now, travels, references_.journey());
      launch_temporal(now, now.tree.place_count / kSubtreesADue);
    }
    launch_place(now);
    launch_emit(now, weights_);
  }
  started_ = true;
}

void PartitionedSearch::bound(const GaussianView& gaussians, cudaStream_t stream) {
  if (tree_->view().subtree_count != 0)
    launch_bound(state_->view(), gaussians, weights_, device_->multiprocessors(), stream);
}

void PartitionedSearch::weigh(const CutQuery& query, cudaStream_t stream) {
  if (tree_->view().subtree_count != 0)
    launch_weigh(weight_source(query), state_->view(), device_->multiprocessors(), stream);
}

WeightSource PartitionedSearch::weight_source(const CutQuery& query) const {
  if (!weights_) return {};
  const StateView state = state_->view();
  return {state.origin, tree_->view(), make_sight(query), state.weights};
}

CutList PartitionedSearch::list() const {
  const StateView state = state_->view();
  return {state.nodes, weights_ ? state.weights : nullptr, &state.counted->list_size,
          state_->list_room(), state.bounds};
}

FrameCounters PartitionedSearch::counters() const {
  FrameCounters counters;
  check(cudaMemcpy(&counters, state_->view().counted, sizeof counters, cudaMemcpyDeviceToHost),
        "counters");
  return counters;
}

void PartitionedSearch::report(void* into, cudaStream_t stream) const {
  check(cudaMemcpyAsync(into, state_->view().counted, sizeof(FrameCounters), cudaMemcpyDeviceToHost,
                        stream),
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
  stats.stand_ins = c.stand_ins;
  return {stats, c.cut_size};
}

// Ids that were found with the list: what an address held then may be gone now.
void PartitionedSearch::read(std::vector<uint32_t>& cut, std::vector<float>& weights) {
  const size_t places = counters().list_size;
  const StateView state = state_->view();
  cut.resize(places);
  weights.resize(weights_ ? places : 0);
  if (places != 0)
    check(cudaMemcpy(cut.data(), streamed_ ? state.ids : state.nodes, places * sizeof(uint32_t),
                     cudaMemcpyDeviceToHost),
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
