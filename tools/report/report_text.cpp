#include "tools/report/report_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "tools/frame_rows.h"
#include "tools/report/pareto.h"

namespace voyager::tools {

namespace {

// "960 x 540"; cameras of a file may differ, then the least and the largest by area.
std::string sizes_text(const std::vector<FrameInput>& path) {
  std::set<std::tuple<uint64_t, uint32_t, uint32_t>> sizes;
  for (const FrameInput& frame : path) {
    const Camera& camera = frame.eyes[0].camera;
    sizes.insert({uint64_t{camera.width} * camera.height, camera.width, camera.height});
  }
  const auto text = [](const auto& size) {
    return fmt::format("{} x {}", std::get<1>(size), std::get<2>(size));
  };
  if (sizes.size() == 1) return text(*sizes.begin());
  return fmt::format("{} sizes from {} to {}", sizes.size(), text(*sizes.begin()),
                     text(*sizes.rbegin()));
}

}  // namespace

std::string method_text(const ReportPlan& plan) {
  return fmt::format(
      "{} frames of {} along the cameras, {} times after a start on the first {}; errors over "
      "{} of them, against the float64 reference. Figures:",
      plan.path.size(), sizes_text(plan.path), plan.repeats, std::min<size_t>(plan.path.size(), 32),
      plan.compared.size());
}

std::string recommendation_text(const std::vector<ReportRow>& rows, std::optional<size_t> best,
                                size_t fastest, double target) {
  const ReportRow& row = rows[best.value_or(fastest)];
  const std::string options = render_options(row.is, row.tau);
  if (best)
    return fmt::format(
        "For {:.4g} ms a frame: {} (SH degree {}, {}). It takes {:.3f} ms, {:.3f} at p95, for a "
        "FLIP of {:.4f} against all leaves.",
        target, options, row.is.sh_degree, storage_name(row.is.storage), row.frame.median,
        row.frame.p95, row.all.flip);
  return fmt::format(
      "Nothing that was measured stays within {:.4g} ms at p95. The fastest, {}, takes {:.3f} ms, "
      "{:.3f} at p95.",
      target, options, row.frame.median, row.frame.p95);
}

}  // namespace voyager::tools
