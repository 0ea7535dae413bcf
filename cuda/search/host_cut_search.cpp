#include <algorithm>
#include <array>
#include <optional>

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
        size_(1) {}

  void find(const CutQuery& query, cudaStream_t stream) override {
    search_.run(query, workers_);
    const size_t next = (last_ + 1) % sent_.size();
    SentCut& sent = sent_[next];
    wait_for_host(sent.taken);
    // What frames in flight read is not freed beside them, nor what a call that failed has sent.
    const size_t size = search_.items().size();
    if (sending_ || sent.outgrown(size)) wait_for_host(stream);
    sending_ = true;
    sent.set(search_.items());
    send(nodes_, sent.nodes(), size, stream);
    send(weights_, sent.weights(), size, stream);
    send(size_, sent.size_word(), 1, stream);
    sent.taken.record(stream);
    sending_ = false;
    last_ = next;
  }
  void weigh(const CutQuery&, cudaStream_t) override {}  // found in the same pass
  CutList list() const override {
    return {nodes_.data(), weights_.data(), size_.data(), static_cast<uint32_t>(nodes_.size())};
  }
  size_t report_bytes() const override { return sizeof(CutFound); }
  void report(void* into, cudaStream_t) const override {
    *static_cast<CutFound*>(into) = {search_.stats(), sent_[last_].size()};
  }
  CutFound found(const void* report) const override {
    return *static_cast<const CutFound*>(report);
  }
  bool counts_changes() const override { return search_.counts_changes(); }
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override {
    const SentCut& sent = sent_[last_];
    cut.clear(), weights.clear();
    if (sent.size() == 0) return;
    cut.assign(sent.nodes(), sent.nodes() + sent.size());
    weights.assign(sent.weights(), sent.weights() + sent.size());
  }

 private:
  // In page-locked memory: a copy out of other memory would keep the host until the stream reaches
  // it.
  class SentCut {
   public:
    bool outgrown(size_t size) const { return memory_ && room_ < size; }
    void set(std::span<const DrawItem> items) {
      if (!memory_ || room_ < items.size()) grow(items.size() + items.size() / 2);
      *size_word() = static_cast<uint32_t>(items.size());
      std::transform(items.begin(), items.end(), nodes(),
                     [](const DrawItem& d) { return d.gaussian; });
      std::transform(items.begin(), items.end(), weights(), [](const DrawItem& d) { return d.t; });
    }
    // Before the first cut: 0.
    uint32_t size() const { return memory_ ? *size_word() : 0; }
    // Once there was one.
    uint32_t* size_word() const { return reinterpret_cast<uint32_t*>(memory_->data()); }
    uint32_t* nodes() const { return size_word() + 1; }
    float* weights() const { return reinterpret_cast<float*>(nodes() + room_); }

    Event taken{kWaitedFor};

   private:
    void grow(size_t room) {
      room_ = 0;
      memory_.reset();
      memory_.emplace((2 * room + 1) * sizeof(uint32_t));
      room_ = room;
    }

    size_t room_ = 0;
    std::optional<PinnedMemory> memory_;
  };

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
  std::array<SentCut, 3> sent_;  // of frames in flight
  size_t last_ = 0;
  bool sending_ = false;  // in a call that has not ended well
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
