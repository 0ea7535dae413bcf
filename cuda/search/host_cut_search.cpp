#include <algorithm>

#include "cuda/interop/external_ring.h"
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
        size_(1),
        sent_((2 * size_t{scene->node_count} + 1) * sizeof(uint32_t)),
        was_sent_(kWaitedFor) {}

  void find(const CutQuery& query, cudaStream_t stream) override {
    search_.run(query, workers_);
    const auto& cut = search_.cut();
    wait_for_host(was_sent_);
    auto* const nodes = reinterpret_cast<uint32_t*>(sent_.data());
    auto* const weights = reinterpret_cast<float*>(nodes + nodes_.size());
    uint32_t& size = nodes[2 * nodes_.size()];
    std::copy(cut.begin(), cut.end(), nodes);
    for (size_t i = 0; i < cut.size(); ++i) weights[i] = search_.items()[i].t;
    size = static_cast<uint32_t>(cut.size());
    send(nodes_, nodes, cut.size(), stream);
    send(weights_, weights, cut.size(), stream);
    send(size_, &size, 1, stream);
    was_sent_.record(stream);
  }
  void weigh(const CutQuery&, cudaStream_t) override {}  // found in the same pass
  CutList list() const override {
    return {nodes_.data(), weights_.data(), size_.data(), static_cast<uint32_t>(nodes_.size())};
  }
  size_t report_bytes() const override { return sizeof(CutFound); }
  void report(void* into, cudaStream_t) const override {
    *static_cast<CutFound*>(into) = {search_.stats(), static_cast<uint32_t>(search_.cut().size())};
  }
  CutFound found(const void* report) const override {
    return *static_cast<const CutFound*>(report);
  }
  bool counts_changes() const override { return search_.counts_changes(); }
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override {
    cut.assign(search_.cut().begin(), search_.cut().end());
    weights.resize(cut.size());
    for (size_t i = 0; i < cut.size(); ++i) weights[i] = search_.items()[i].t;
  }

 private:
  template <class T>
  static void send(const Buffer<T>& into, const T* from, size_t count, cudaStream_t stream) {
    if (count == 0) return;
    check(cudaMemcpyAsync(into.data(), from, count * sizeof(T), cudaMemcpyHostToDevice, stream),
          "a cut that the host found");
  }

  Workers& workers_;
  HostSearch search_;
  Buffer<uint32_t> nodes_;
  Buffer<float> weights_;
  Buffer<uint32_t> size_;
  // Of the last frame: nodes, weights and size on their way. A copy out of pageable memory would
  // keep the host until the stream comes to it.
  PinnedMemory sent_;
  Event was_sent_;
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
