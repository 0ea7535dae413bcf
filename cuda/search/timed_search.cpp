#include "cuda/device/frame_timer.h"
#include "cuda/device/head_start.h"
#include "cuda/search/search.h"

namespace voyager::cuda {
namespace {

enum Mark : size_t { kBegin, kFound, kWeighed, kMarks };

class TimedSearch final : public SceneSearch {
 public:
  TimedSearch(std::shared_ptr<const Device> device, std::unique_ptr<CutSearch> search,
              const SearchDesc& desc)
      : device_(std::move(device)),
        search_(std::move(search)),
        desc_(desc),
        timer_(stream_, kMarks),
        report_(search_->report_bytes()) {}

  // What it frees belongs to the device's context.
  ~TimedSearch() override { device_->use_quietly(); }

  void run(const CutQuery& query) override {
    device_->use();
    give_head_start(stream_.get());
    timer_.mark(kBegin);
    search_->find(query, stream_.get());
    timer_.mark(kFound);
    if (desc_.weights) search_->weigh(weights_query(desc_.lod, query), stream_.get());
    timer_.mark(kWeighed);
    search_->report(report_.data(), stream_.get());
    search_->end_frame(stream_.get());
  }
  SearchTimes times() override {
    device_->use();
    return {timer_.milliseconds(kBegin, kFound), timer_.milliseconds(kFound, kWeighed)};
  }
  SearchStats stats() override {
    device_->use();
    stream_.wait();
    return search_->found(report_.data()).stats;
  }
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override {
    device_->use();
    stream_.wait();
    search_->read(cut, weights);
  }

 private:
  std::shared_ptr<const Device> device_;
  std::unique_ptr<CutSearch> search_;
  SearchDesc desc_;
  Stream stream_;
  FrameTimer timer_;
  PinnedMemory report_;
};

}  // namespace

std::unique_ptr<SceneSearch> create_timed_search(std::shared_ptr<const Device> device,
                                                 std::unique_ptr<CutSearch> search,
                                                 const SearchDesc& desc) {
  device->use();
  return std::make_unique<TimedSearch>(std::move(device), std::move(search), desc);
}

}  // namespace voyager::cuda
