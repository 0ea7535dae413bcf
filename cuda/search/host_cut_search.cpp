#include "cuda/search/search.h"
#include "runtime/base/error.h"
#include "runtime/frame/host_search.h"

namespace voyager::cuda {
namespace {

class HostCutSearch final : public CutSearch {
 public:
  HostCutSearch(const std::shared_ptr<const Scene>& scene, Search kind, Workers& workers)
      : workers_(workers),
        search_(scene, {kind, true}, std::pmr::get_default_resource(), workers),
        nodes_(scene->node_count),
        weights_(scene->node_count),
        size_(1) {}

  void find(const CutQuery& query, cudaStream_t stream) override {
    search_.run(query, workers_);
    const auto& cut = search_.cut();
    host_weights_.resize(cut.size());
    for (size_t i = 0; i < cut.size(); ++i) host_weights_[i] = search_.items()[i].t;
    host_size_ = static_cast<uint32_t>(cut.size());
    copy(nodes_.data(), cut.data(), cut.size(), stream);
    copy(weights_.data(), host_weights_.data(), cut.size(), stream);
    copy(size_.data(), &host_size_, 1, stream);
  }
  void weigh(const CutQuery&, cudaStream_t) override {}  // found in the same pass
  CutList list() const override {
    return {nodes_.data(), weights_.data(), size_.data(), static_cast<uint32_t>(nodes_.size())};
  }
  size_t report_bytes() const override { return sizeof(CutFound); }
  void report(void* into, cudaStream_t) const override {
    *static_cast<CutFound*>(into) = {search_.stats(), host_size_};
  }
  CutFound found(const void* report) const override {
    return *static_cast<const CutFound*>(report);
  }
  bool counts_changes() const override { return search_.counts_changes(); }
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override {
    cut.assign(search_.cut().begin(), search_.cut().end());
    weights = host_weights_;
  }

 private:
  // From memory that is not pinned, so the source may change as soon as it returns.
  template <class T>
  static void copy(T* into, const T* from, size_t count, cudaStream_t stream) {
    if (count == 0) return;
    check(cudaMemcpyAsync(into, from, count * sizeof(T), cudaMemcpyHostToDevice, stream),
          "a cut that the host found");
  }

  Workers& workers_;
  HostSearch search_;
  std::vector<float> host_weights_;
  uint32_t host_size_ = 0;
  Buffer<uint32_t> nodes_;
  Buffer<float> weights_;
  Buffer<uint32_t> size_;
};

}  // namespace

std::unique_ptr<CutSearch> create_host_cut_search(const std::shared_ptr<const Scene>& scene,
                                                  Search kind, Workers& workers) {
  if (scene->streamed())
    throw Error(
        ErrorCode::unsupported,
        "search: found a search on the host for a streamed scene, expected one on the device, "
        "where its tree is");
  return std::make_unique<HostCutSearch>(scene, kind, workers);
}

}  // namespace voyager::cuda
