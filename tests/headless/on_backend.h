#pragma once
// A test of each backend: the CPU's are there everywhere, CUDA's is named where it is skipped.
#include "host.h"
#include "tests/support/needs.h"

class OnBackend : public ::testing::TestWithParam<VoyBackend> {
 protected:
  void SetUp() override {
    if (voy.QueryBackend(GetParam()) == VOY_SUCCESS) return;
    const std::string why = voy.message();
    if (GetParam() == VOY_BACKEND_CUDA) VOYAGER_SKIP_WITHOUT(CUDA, why);
    FAIL() << why;
  }

  Library voy;
};

inline constexpr VoyBackend kEachBackend[] = {VOY_BACKEND_CPU, VOY_BACKEND_REFERENCE,
                                              VOY_BACKEND_CUDA};

// For INSTANTIATE_TEST_SUITE_P.
inline std::string backend_name(const ::testing::TestParamInfo<VoyBackend>& info) {
  if (info.param == VOY_BACKEND_AUTO) return "Auto";
  if (info.param == VOY_BACKEND_CPU) return "Cpu";
  return info.param == VOY_BACKEND_CUDA ? "Cuda" : "Reference";
}
