#include "cuda/search/search.h"
#include "cuda/search/search_launch.h"
#include "runtime/base/error.h"

namespace voyager::cuda {
namespace {

class ExhaustiveSearch final : public CutSearch {
 public:
  ExhaustiveSearch(std::shared_ptr<const Device> device, const LodTree& tree, bool weights)
      : device_(std::move(device)),
        records_(upload(std::span<const NodeRecord>(tree.records))),
        parent_(upload(std::span<const uint32_t>(tree.parent))),
        tree_{records_.data(), parent_.data(), static_cast<uint32_t>(tree.size()),
              tree.blend_share},
        scratch_(exhaustive_scratch_bytes(tree_)),
        nodes_(tree.size()),
        weights_(weights ? tree.size() : 0),
        count_(1) {
    fill(count_, 0);
  }

  // What it frees belongs to the device's context.
  ~ExhaustiveSearch() override { device_->use_quietly(); }

  void find(const CutQuery& query, cudaStream_t stream) override {
    if (tree_.size != 0)
      launch_exhaustive(tree_, make_sight(query), scratch_.data(), scratch_.bytes(), nodes_.data(),
                        count_.data(), stream);
  }
  void weigh(const CutQuery& query, cudaStream_t stream) override {
    if (tree_.size != 0)
      launch_weights(tree_, make_sight(query), nodes_.data(), count_.data(), weights_.data(),
                     device_->multiprocessors(), stream);
  }
  CutList list() const override {
    return {nodes_.data(), weights_.data(), count_.data(), tree_.size};
  }
  bool counts_changes() const override { return false; }
  size_t report_bytes() const override { return sizeof(uint32_t); }
  void report(void* into, cudaStream_t stream) const override {
    check(cudaMemcpyAsync(into, count_.data(), sizeof(uint32_t), cudaMemcpyDeviceToHost, stream),
          "cut");
  }
  CutFound found(const void* report) const override {
    SearchStats stats;
    stats.nodes_tested = tree_.size;
    stats.bytes_read = tree_.size * (sizeof(NodeRecord) + sizeof(uint32_t));
    return {stats, *static_cast<const uint32_t*>(report)};
  }
  uint32_t cut_size() const {
    uint32_t size = 0;
    check(cudaMemcpy(&size, count_.data(), sizeof size, cudaMemcpyDeviceToHost), "cut");
    return size;
  }
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override {
    const uint32_t size = cut_size();
    cut.resize(size);
    weights.resize(weights_.size() == 0 ? 0 : size);
    if (size == 0) return;
    check(cudaMemcpy(cut.data(), nodes_.data(), size * sizeof(uint32_t), cudaMemcpyDeviceToHost),
          "cut");
    if (!weights.empty())
      check(
          cudaMemcpy(weights.data(), weights_.data(), size * sizeof(float), cudaMemcpyDeviceToHost),
          "weights");
  }

 private:
  std::shared_ptr<const Device> device_;
  Buffer<NodeRecord> records_;
  Buffer<uint32_t> parent_;
  ExhaustiveTree tree_;
  Buffer<char> scratch_;
  Buffer<uint32_t> nodes_;
  Buffer<float> weights_;
  Buffer<uint32_t> count_;
};

}  // namespace

std::unique_ptr<CutSearch> create_exhaustive_search(std::shared_ptr<const Device> device,
                                                    const Scene& scene, const LodTree& tree,
                                                    bool weights) {
  if (scene.streamed())
    throw Error(ErrorCode::unsupported,
                "search: found exhaustive for a streamed scene, expected streaming or temporal");
  device->use();
  return std::make_unique<ExhaustiveSearch>(std::move(device), tree, weights);
}

}  // namespace voyager::cuda
