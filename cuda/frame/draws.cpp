#include "cuda/frame/draws.h"

#include <algorithm>
#include <numeric>

#include "runtime/base/error.h"
#include "runtime/frame/frame_search.h"

namespace voyager::cuda {
namespace {

class CutDraws final : public Draws {
 public:
  CutDraws(std::unique_ptr<CutSearch> search, Lod lod) : search_(std::move(search)), lod_(lod) {}

  void update(const CutQuery& query, const GaussianView& gaussians, cudaStream_t stream) override {
    search_->find(query, stream);
    search_->bound(gaussians, stream);
    query_ = query;
  }
  void weigh(cudaStream_t stream) override { search_->weigh(weights_query(lod_, query_), stream); }
  DrawView view() const override {
    return {search_->list(), nullptr, search_->weight_source(weights_query(lod_, query_))};
  }
  void end_frame(cudaStream_t stream) noexcept override { search_->end_frame(stream); }
  size_t report_bytes() const override { return search_->report_bytes(); }
  void report(void* into, cudaStream_t stream) const override { search_->report(into, stream); }
  bool counts_changes() const override { return search_->counts_changes(); }
  void collect(const void* report, FrameStats& stats) const override {
    const CutFound found = search_->found(report);
    add_search(found.stats, search_->counts_changes(), stats);
    stats.cut_size += found.cut_size;
    stats.bytes[kSearch] += found.stats.bytes_read;
  }
  void read_cut(std::pmr::vector<uint32_t>& cut) override {
    std::vector<uint32_t> nodes;
    std::vector<float> weights;
    search_->read(nodes, weights);
    cut.assign(nodes.begin(), nodes.end());
  }

 private:
  std::unique_ptr<CutSearch> search_;
  Lod lod_;
  CutQuery query_{};  // the last frame's
};

// A tree's leaves go in the order of their nodes, neighbours together; the contract's
// order is the input's.
class LeafDraws final : public Draws {
 public:
  explicit LeafDraws(const Scene& scene) {
    if (std::find(scene.leaves.begin(), scene.leaves.end(), kNoNode) != scene.leaves.end()) {
      damage_ = scene.damaged[0].message;
      return;
    }
    const auto count =
        static_cast<uint32_t>(scene.flat() ? scene.gaussians.size() : scene.leaves.size());
    size_ = upload(std::span<const uint32_t>(&count, 1));
    count_ = count;
    if (scene.flat()) return;
    std::vector<uint32_t> order(count), nodes(count);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return scene.leaves[a] < scene.leaves[b]; });
    for (uint32_t i = 0; i < count; ++i) nodes[i] = scene.leaves[order[i]];
    nodes_ = upload(std::span<const uint32_t>(nodes));
    ids_ = upload(std::span<const uint32_t>(order));
  }

  void update(const CutQuery&, const GaussianView&, cudaStream_t) override {
    if (!damage_.empty()) throw Error(ErrorCode::damaged_chunk, damage_);
  }
  DrawView view() const override {
    return {{nodes_.data(), nullptr, size_.data(), count_}, ids_.data()};
  }
  size_t report_bytes() const override { return 0; }
  void report(void*, cudaStream_t) const override {}
  bool counts_changes() const override { return true; }
  void collect(const void*, FrameStats& stats) const override { stats.cut_size += count_; }
  void read_cut(std::pmr::vector<uint32_t>& cut) override { cut.clear(); }

 private:
  std::string damage_;  // what is wrong with a leaf, if one is
  Buffer<uint32_t> nodes_, ids_, size_;
  uint32_t count_ = 0;
};

}  // namespace

std::unique_ptr<Draws> create_draws(const Scene& scene, Lod lod,
                                    std::unique_ptr<CutSearch> search) {
  check_detail(scene, lod);
  if (scene.flat() || !draws_cut(lod)) return std::make_unique<LeafDraws>(scene);
  return std::make_unique<CutDraws>(std::move(search), lod);
}

}  // namespace voyager::cuda
