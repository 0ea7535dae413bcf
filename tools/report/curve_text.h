#pragma once
// Curves as a table of lines, and in words.
#include <string>
#include <vector>

#include "tools/report/curve_row.h"
#include "tools/report/measure.h"

namespace voyager::tools {

// A header and a line a row; an empty field is not known. docs/report.md explains the columns.
std::string curve_csv(const std::vector<CurveRow>& rows);

// What stands beside each curve of a table of means, share by share.
struct CurveLine {
  std::string name;
  std::vector<std::string> cells;
};
// PSNR of each tree in dB, and below it by how much that is above the last tree's. A star: not
// every view has a cut of that share.
std::vector<CurveLine> curve_lines(const std::vector<Curve>& curves);
// The same for a terminal.
std::string curve_table(const std::vector<Curve>& curves);
// "90 %"
std::string share_text(double share);

// How it was timed and compared. first: the tree whose leaves all are compared with.
std::string curve_method_text(const ReportPlan& plan, const std::string& first,
                              const Backend& backend);
inline constexpr const char* kStarText =
    "* not every view has a cut of this share: curve.csv has those that were drawn";

}  // namespace voyager::tools
