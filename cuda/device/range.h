#pragma once
// A part of a frame under its stage's name in the profilers' timelines and filters
// (scripts/profile.sh). Costs nothing where no profiler is attached, or where the toolkit came
// without NVTX.
#if __has_include(<nvtx3/nvToolsExt.h>)
#include <nvtx3/nvToolsExt.h>
#define VOYAGER_NVTX 1
#endif

namespace voyager::cuda {

class Range {
 public:
#ifdef VOYAGER_NVTX
  // name: lives as long as the range.
  explicit Range(const char* name) {
    nvtxEventAttributes_t attributes{};
    attributes.version = NVTX_VERSION;
    attributes.size = NVTX_EVENT_ATTRIB_STRUCT_SIZE;
    attributes.messageType = NVTX_MESSAGE_TYPE_ASCII;
    attributes.message.ascii = name;
    nvtxDomainRangePushEx(domain(), &attributes);
  }
  ~Range() {
    nvtxDomainRangePop(domain());
  }
#else
  explicit Range(const char*) {}
#endif
  Range(const Range&) = delete;
  Range& operator=(const Range&) = delete;

#ifdef VOYAGER_NVTX
 private:
  static nvtxDomainHandle_t domain() {
    static const nvtxDomainHandle_t voyager = nvtxDomainCreateA("voyager");
    return voyager;
  }
#endif
};

}  // namespace voyager::cuda
