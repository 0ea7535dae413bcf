#include <algorithm>
#include <utility>

#include "cuda/search/search.h"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

class SweepSearch final : public CutSearch {
 public:
  SweepSearch(std::shared_ptr<const Device> device, std::shared_ptr<const SweepTree> tree,
              const Scene& scene, bool weights)
      : device_(std::move(device)), tree_(std::move(tree)) {
    const SweepView view = tree_->view();
    allocate_together(ToAllocate{sizes_, view.records}, ToAllocate{cut_, (view.nodes + 31) / 32},
                      ToAllocate{tiles_, sweep_tiles(view.nodes)}, ToAllocate{counters_, 1},
                      ToAllocate{nodes_, scene.leaf_count},
                      ToAllocate{weights_, weights ? scene.leaf_count : 0});
    fill(cut_, 0);
    fill(tiles_, 0);
    fill(counters_, 0);
  }

  // What it frees belongs to the device's context.
  ~SweepSearch() override { device_->use_quietly(); }

  void find(const CutQuery& query, cudaStream_t stream) override {
    if (tree_->view().nodes == 0) return;
    run_ = run_ == kLastRun ? 1 : run_ + 1;
    launch_sweep(tree_->view(), state(), make_sight(query), run_, device_->multiprocessors(),
                 stream);
  }
  void weigh(const CutQuery&, cudaStream_t) override {}  // found with the cut
  CutList list() const override {
    return {nodes_.data(), weights_.data(), &counters_.data()->cut_size,
            static_cast<uint32_t>(nodes_.size())};
  }
  bool counts_changes() const override { return true; }
  size_t report_bytes() const override { return sizeof(SweepCounters); }
  void report(void* into, cudaStream_t stream) const override {
    check(cudaMemcpyAsync(into, counters_.data(), sizeof(SweepCounters), cudaMemcpyDeviceToHost,
                          stream),
          "cut");
  }
  CutFound found(const void* report) const override;
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override;

 private:
  static constexpr uint32_t kLastRun = 0x7fffffff;  // that publish() has room for

  SweepState state() const {
    return {sizes_.data(),    cut_.data(),   tiles_.data(),
            counters_.data(), nodes_.data(), weights_.data()};
  }

  std::shared_ptr<const Device> device_;
  std::shared_ptr<const SweepTree> tree_;
  Buffer<float> sizes_;
  Buffer<uint32_t> cut_;
  Buffer<unsigned long long> tiles_;
  Buffer<SweepCounters> counters_;
  Buffer<uint32_t> nodes_;
  Buffer<float> weights_;
  uint32_t run_ = 0;
};

CutFound SweepSearch::found(const void* report) const {
  const SweepCounters& c = *static_cast<const SweepCounters*>(report);
  const SweepView tree = tree_->view();
  SearchStats stats;
  stats.ran = Search::sweep;
  stats.nodes_tested = tree.records;
  stats.bytes_read = tree.records * (sizeof(float4) + sizeof(Vec3f) + 2 * sizeof(float)) +
                     cut_.size() * (sizeof(SweepWord) + sizeof(uint32_t));
  stats.entered = c.entered;
  stats.left = c.left;
  return {stats, c.cut_size};
}

void SweepSearch::read(std::vector<uint32_t>& cut, std::vector<float>& weights) {
  SweepCounters counters;
  check(cudaMemcpy(&counters, counters_.data(), sizeof counters, cudaMemcpyDeviceToHost), "cut");
  cut.resize(counters.cut_size);
  weights.resize(weights_.size() == 0 ? 0 : counters.cut_size);
  const auto copy = [](auto& into, const auto& from) {
    if (!into.empty())
      check(cudaMemcpy(into.data(), from.data(), into.size() * sizeof into[0],
                       cudaMemcpyDeviceToHost),
            "cut");
  };
  copy(cut, nodes_);
  copy(weights, weights_);
}

}  // namespace

std::unique_ptr<CutSearch> create_sweep_search(std::shared_ptr<const Device> device,
                                               std::shared_ptr<const SweepTree> tree,
                                               const Scene& scene, bool weights) {
  device->use();
  return std::make_unique<SweepSearch>(std::move(device), std::move(tree), scene, weights);
}

}  // namespace voyager::cuda
