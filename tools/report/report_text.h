#pragma once
// What a report says in words.
#include <string>
#include <vector>

#include "tools/report/measure.h"
#include "tools/report/pareto.h"
#include "tools/report/report_row.h"

namespace voyager::tools {

// "960 x 540"; cameras of a file may differ, then the least and the largest by area.
std::string sizes_text(const std::vector<FrameInput>& path);
// How it was timed and compared. sensor: of energy; empty where there is none.
std::string method_text(const ReportPlan& plan, const std::string& sensor);
// Whole: every choice that the figures depend on.
std::string advice_text(const std::vector<ReportRow>& rows, const Advice& advice, double target);

}  // namespace voyager::tools
