#include "tools/report/report_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "tools/report/frame_energy.h"

namespace voyager::tools {

std::string sizes_text(const std::vector<FrameInput>& path) {
  std::set<std::tuple<uint64_t, uint32_t, uint32_t>> sizes;
  for (const FrameInput& frame : path) {
    const voyager::Camera& camera = frame.eyes[0].camera;
    sizes.insert({uint64_t{camera.width} * camera.height, camera.width, camera.height});
  }
  const auto text = [](const auto& size) {
    return fmt::format("{} x {}", std::get<1>(size), std::get<2>(size));
  };
  if (sizes.size() == 1) return text(*sizes.begin());
  return fmt::format("{} sizes from {} to {}", sizes.size(), text(*sizes.begin()),
                     text(*sizes.rbegin()));
}

std::string method_text(const ReportPlan& plan, const std::string& sensor) {
  std::string text = fmt::format(
      "{} frames of {} along the cameras, {} times after a start on the first {}; errors over "
      "{} of them, against the float64 reference.",
      plan.path.size(), sizes_text(plan.path), plan.repeats, std::min<size_t>(plan.path.size(), 32),
      plan.compared.size());
  if (!sensor.empty())
    text += fmt::format(" Energy by {}, over {:g} s or more of the same frames.", sensor,
                        FrameEnergy::kLeast / 1000);
  return text;
}

std::string advice_text(const std::vector<ReportRow>& rows, const Advice& advice, double target) {
  const ReportRow& row = rows[advice.row];
  const std::string head =
      advice.in_time
          ? fmt::format("For {:.4g} ms a frame: ", target)
          : fmt::format("Nothing that was measured stays within {:.4g} ms at p95. The fastest: ",
                        target);
  return head + fmt::format(
                    "{} (SH degree {}, {}). It takes {:.3f} ms, {:.3f} at p95, for a FLIP of "
                    "{:.4f} against the truth.",
                    render_options(row.is, row.tau), row.is.sh_degree, storage_name(row.is.storage),
                    row.frame.median, row.frame.p95, row.truth.flip);
}

}  // namespace voyager::tools
