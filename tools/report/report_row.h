#pragma once
// One configuration, measured.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tools/report/report_case.h"

namespace voyager::tools {

// docs/metrics.md
struct ReportError {
  double psnr = 0;             // dB; infinite where nothing differs
  std::optional<double> ssim;  // none of images smaller than its window
  double flip = 0, largest = 0, p999 = 0;
  std::optional<double> popping;  // 1/255, mean a frame; none where no frame follows another
  size_t not_finite = 0;  // pixels, of all compared frames, where either image has such a colour
};

struct ReportTimes {
  double median = 0, p95 = 0, p99 = 0;  // milliseconds
};

struct ReportRow {
  ReportCase is;
  double tau = 0;  // as used; of a time budget, the median
  // Means over the timed frames.
  double cut = 0, splats = 0, pairs = 0, bytes = 0;
  ReportTimes frame;
  std::vector<ReportTimes> stages;    // by Stage
  size_t timed = 0;                   // frames
  std::optional<double> joules;       // a frame
  ReportError same;                   // against the reference of the same cut
  ReportError truth;                  // against the truth (METHOD §12): what is lost in all
  std::optional<double> dolly, turn;  // shimmer along slow_paths(), against the truth's own

  size_t not_finite() const { return std::max(same.not_finite, truth.not_finite); }
};

// Infinity, which JSON has not, is null; so is what is not known.
nlohmann::ordered_json to_json(const ReportError& error);
// Every field; row_from_json() gives the row back, so that a report can go on, or throws
// nlohmann::json::exception where a field is missing that rows did not have from the start.
nlohmann::ordered_json to_json(const ReportRow& row);
ReportRow row_from_json(const nlohmann::ordered_json& json, const ReportCase& is);

}  // namespace voyager::tools
