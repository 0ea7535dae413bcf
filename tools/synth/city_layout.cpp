#include "tools/synth/city_layout.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/error.h"

namespace voyager::synth {
namespace {

constexpr uint64_t kMostGaussians = uint64_t{1} << 40;
constexpr double kGaussiansPerBlock = 40000.0;
// 64 blocks keep every coordinate under 2048 m, where 24-bit positions have
// 12 bits behind the point, as .spz files usually have them.
constexpr double kFewestBlocks = 2.0, kMostBlocks = 64.0;

}  // namespace

Layout city_layout(const CityDesc& desc) {
  if (desc.gaussians < 1 || desc.gaussians > kMostGaussians)
    throw Error(ErrorCode::invalid_argument, "synth city: gaussians is " +
                                                 std::to_string(desc.gaussians) +
                                                 ", expected 1 to 1099511627776");
  if (desc.sh_degree < 0 || desc.sh_degree > kMaxShDegree)
    throw Error(
        ErrorCode::invalid_argument,
        "synth city: the SH degree is " + std::to_string(desc.sh_degree) + ", expected 0 to 3");
  const double side =
      std::floor(std::sqrt(static_cast<double>(desc.gaussians) / kGaussiansPerBlock) + 0.5);
  return Layout(static_cast<int>(std::clamp(side, kFewestBlocks, kMostBlocks)), desc.seed);
}

}  // namespace voyager::synth
