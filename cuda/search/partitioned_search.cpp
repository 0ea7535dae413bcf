#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "cuda/interop/external_ring.h"
#include "cuda/search/cut_state.h"
#include "cuda/search/search.h"
#include "cuda/stream/device_pool.h"
#include "cuda/stream/stream_changes.h"
#include "runtime/base/error.h"
#include "runtime/select/references.h"
#include "runtime/stream/pool_share.h"

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

class PartitionedSearch final : public CutSearch, public PoolReaderState {
 public:
  PartitionedSearch(std::shared_ptr<const Device> device, std::shared_ptr<const DeviceTree> tree,
                    std::shared_ptr<const Scene> scene, Search kind, bool weights, Workers& workers)
      : device_(std::move(device)),
        tree_(std::move(tree)),
        scene_(std::move(scene)),
        kind_(without_sweep(kind)),
        weights_(weights),
        streamed_(scene_->streamed() ? std::make_unique<Streamed>(*scene_, *device_) : nullptr) {
    std::shared_lock<std::shared_mutex> hold;
    if (streamed_) {
      share_.emplace(*scene_->stream, *this, workers);
      hold = scene_->stream->hold();
    }
    make_state();
  }

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
  void drop() noexcept override;
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override;

 private:
  FrameCounters counters() const;
  SearchFrame frame(const CutQuery& query, cudaStream_t stream) const;
  uint64_t most_nodes() const;
  // Throws Error(internal) where the list has not had room for the cut.
  void require_room(const FrameCounters& counted) const;
  void make_state();
  bool fit_pool();
  bool follow_stream(const SearchFrame& now, bool goes_on);

  std::shared_ptr<const Device> device_;
  std::shared_ptr<const DeviceTree> tree_;
  std::shared_ptr<const Scene> scene_;
  Search kind_;
  bool weights_;
  const std::unique_ptr<Streamed> streamed_;  // where the scene is
  // None after drop(), which comes between frames, from any thread.
  std::unique_ptr<CutState> state_;
  std::mutex state_mutex_;
  // Of the last state, for those who ask between frames what there is, and read none of it.
  StateView view_{};
  uint32_t list_room_ = 0;
  float* list_weights_ = nullptr;    // by place; null until weigh() is called
  Buffer<float> weights_of_places_;  // their memory
  bool weighed_ = false;             // they are those of the last cut
  References references_;
  bool started_ = false;
  std::optional<PoolShare> share_;  // last: what goes first frees the state
};

SearchFrame PartitionedSearch::frame(const CutQuery& query, cudaStream_t stream) const {
  return {tree_->view(),         state_->view(tree_->view().places), make_sight(query),
          references_.current(), device_->multiprocessors(),         stream};
}

// No cut has more nodes. In a streamed scene the linker sees to that; of another the number of
// leaves was checked when the file was read.
uint64_t PartitionedSearch::most_nodes() const {
  return streamed_ ? scene_->stream->cut_nodes() : scene_->leaf_count;
}

void PartitionedSearch::make_state() {
  const uint32_t places = tree_->view().place_count;
  const uint32_t due = kind_ == Search::temporal_visit ? places : places / kSubtreesADue;
  auto state = std::make_unique<CutState>(scene_->search, places, due, most_nodes());
  const std::lock_guard lock(state_mutex_);
  state_ = std::move(state);
  view_ = state_->view();
  list_room_ = state_->list_room();
  list_weights_ = nullptr;
}

// No frame reads it: who calls has waited for them. Their counters may still be on their way to the
// host, and they may still tell what they have shown, for which the freeing of memory waits, as for
// all that the device does.
void PartitionedSearch::drop() noexcept {
  device_->use_quietly();
  const std::lock_guard lock(state_mutex_);
  state_.reset();
  weights_of_places_ = {};
}

// Whether its state is still there.
bool PartitionedSearch::fit_pool() {
  if (state_) return true;
  make_state();
  return false;
}

// Whether the search goes on from its last cut.
bool PartitionedSearch::follow_stream(const SearchFrame& now, bool goes_on) {
  const std::optional<Relinked> relinked =
      streamed_->changes.follow(*scene_->stream, streamed_->pool);
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
  weighed_ = false;
  if (streamed_) {
    streamed_->reader.begin(stream);
    goes_on = fit_pool() && goes_on;
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
    launch_emit(now);
  }
  started_ = true;
}

void PartitionedSearch::bound(const GaussianView& gaussians, cudaStream_t stream) {
  if (tree_->view().subtree_count != 0)
    launch_bound(state_->view(), gaussians, weights_, device_->multiprocessors(), stream);
}

void PartitionedSearch::weigh(const CutQuery& query, cudaStream_t stream) {
  if (!weights_) return;
  // Frames weigh as they draw: what only comparisons ask for takes memory here.
  if (list_weights_ == nullptr) {
    weights_of_places_ = Buffer<float>(list_room_);
    fill(weights_of_places_, 0);  // places that hold no node are read with the others
    list_weights_ = weights_of_places_.data();
  }
  if (tree_->view().subtree_count != 0)
    launch_weigh(weight_source(query), state_->view(), list_weights_, device_->multiprocessors(),
                 stream);
  weighed_ = true;
}

WeightSource PartitionedSearch::weight_source(const CutQuery& query) const {
  if (!weights_) return {};
  return {tree_->owners(), streamed_ ? streamed_->pool.nodes() : PoolNodes{}, tree_->view(),
          make_sight(query)};
}

CutList PartitionedSearch::list() const {
  return {view_.nodes, list_weights_, &view_.counted->list_size, list_room_, view_.bounds};
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

void PartitionedSearch::require_room(const FrameCounters& counted) const {
  if (counted.fit == SegmentFit::none)
    throw Error(ErrorCode::internal, "cut: found " + std::to_string(counted.cut_size) +
                                         " nodes, expected at most " + std::to_string(list_room_));
}

CutFound PartitionedSearch::found(const void* report) const {
  const FrameCounters& c = *static_cast<const FrameCounters*>(report);
  require_room(c);
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

void PartitionedSearch::read(std::vector<uint32_t>& cut, std::vector<float>& weights) {
  const std::lock_guard lock(state_mutex_);
  if (!state_)
    throw Error(ErrorCode::unsupported,
                "cut: found that the scene's memory was shared out anew since the last frame, "
                "expected a frame since");
  const FrameCounters counted = counters();
  require_room(counted);
  const size_t places = counted.list_size;
  const StateView state = state_->view();
  cut.resize(places);
  weights.resize(weighed_ ? places : 0);
  if (places != 0)
    check(cudaMemcpy(cut.data(), state.nodes, places * sizeof(uint32_t), cudaMemcpyDeviceToHost),
          "cut");
  if (!weights.empty())
    check(cudaMemcpy(weights.data(), list_weights_, places * sizeof(float), cudaMemcpyDeviceToHost),
          "weights");
  size_t used = 0;
  for (size_t i = 0; i < places; ++i) {
    if (cut[i] == kNoNode) continue;
    cut[used] = streamed_ ? streamed_->changes.id(cut[i]) : cut[i];
    if (!weights.empty()) weights[used] = weights[i];
    ++used;
  }
  cut.resize(used);
  if (!weights.empty()) weights.resize(used);
}

}  // namespace

std::shared_ptr<const DeviceTree> upload_tree(const Scene& scene) {
  return std::make_shared<DeviceTree>(scene.search, scene.tree);
}

std::unique_ptr<CutSearch> create_partitioned_search(std::shared_ptr<const Device> device,
                                                     std::shared_ptr<const DeviceTree> tree,
                                                     std::shared_ptr<const Scene> scene,
                                                     Search kind, bool weights, Workers& workers) {
  device->use();
  return std::make_unique<PartitionedSearch>(std::move(device), std::move(tree), std::move(scene),
                                             kind, weights, workers);
}

// A cut has no more nodes than there are whose children are not linked (Linker). Where families are
// as large as in the file as a whole, that is its share of leaves; a sixteenth is to spare. What
// the top of the tree, and a pool of a few chunks, may have comes on top of that. Each node of a
// cut has a leaf of its own below it, so that no cut has more nodes than the file has leaves. Where
// a file says so falsely the linker leaves out what is more, but for the top, which is always
// there.
RoomBytes with_view(const PoolBytes& pool, const Scene& scene, SlotShape shape) {
  constexpr double kSpare = 17.0 / 16;
  constexpr uint32_t kFewChunks = 64;
  const double share = std::min(
      1.0, kSpare * static_cast<double>(scene.leaf_count) / static_cast<double>(scene.node_count));
  const uint64_t top = uint64_t{kSubtreeNodes} * scene.search.tier_begin[1];
  const ListRoom list{
      .slot = static_cast<uint64_t>(std::ceil(share * shape.nodes)),
      .fixed = uint64_t{kFewChunks} * shape.nodes + top,
      .most = std::max<uint64_t>(scene.leaf_count, std::min<uint64_t>(top, scene.node_count)),
      .eight_nodes = CutState::eight_nodes(),
      .ends_of_eight = CutState::ends_of_eight(),
      .most_ends = CutState::most_ends(scene.search)};
  static_assert(kPageSubtrees % 8 == 0);
  const uint64_t page = kPageSubtrees / 8 * CutState::kEightPlaces;
  return {pool, {0, 0, CutState::fixed_bytes(scene.search) + page, page}, list};
}

}  // namespace voyager::cuda
