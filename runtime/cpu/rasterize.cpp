#include "runtime/cpu/rasterize.h"

#include <array>

namespace voyager::cpu {

namespace generic {
RasterizeTile pick(Exponential, bool, bool, bool);
}
#if defined(VOYAGER_X86)
namespace avx2 {
RasterizeTile pick(Exponential, bool, bool, bool);
}
namespace avx512 {
RasterizeTile pick(Exponential, bool, bool, bool);
}
#endif

std::span<const NamedRasterizer> rasterizers() {
  static const auto all = [] {
    std::array<NamedRasterizer, 3> list{{{"generic", generic::pick}}};
    size_t count = 1;
#if defined(VOYAGER_X86)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      list[count++] = {"avx2", avx2::pick};
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
      list[count++] = {"avx512", avx512::pick};
#endif
    return std::pair(list, count);
  }();
  return std::span(all.first).first(all.second);
}

RasterizeTile pick_rasterizer(Exponential exponential, bool alpha_filter, bool depth, bool limits) {
  return rasterizers().back().pick(exponential, alpha_filter, depth, limits);
}

}  // namespace voyager::cpu
