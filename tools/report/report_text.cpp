#include "tools/report/report_text.h"

#include <fmt/core.h>

#include <algorithm>

#include "tools/frame_rows.h"
#include "tools/report/pareto.h"

namespace voyager::tools {

std::string method_text(const ReportPlan& plan) {
  const auto& camera = plan.path[0].eyes[0].camera;
  return fmt::format(
      "{} frames of {} x {} along the cameras, {} times after a start on the first {}; errors over "
      "{} of them, against the float64 reference. Figures:",
      plan.path.size(), camera.width, camera.height, plan.repeats,
      std::min<size_t>(plan.path.size(), 32), plan.compared.size());
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
