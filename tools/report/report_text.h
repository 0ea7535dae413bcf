#pragma once
// What a report says in words.
#include <optional>
#include <string>
#include <vector>

#include "tools/report/measure.h"
#include "tools/report/report_row.h"

namespace voyager::tools {

// How it was timed and compared.
std::string method_text(const ReportPlan& plan);
// The best row within the target, milliseconds; where there is none, the fastest.
std::string recommendation_text(const std::vector<ReportRow>& rows, std::optional<size_t> best,
                                size_t fastest, double target);

}  // namespace voyager::tools
