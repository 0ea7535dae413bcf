#pragma once
#include <string>
#include <vector>

#include "tools/report/report_row.h"

namespace voyager::tools {

// What is the same in every row.
struct ReportNames {
  std::string scene, camera_set, backend;
};

// A header and a line a row; an empty field is not known or has no meaning. docs/report.md explains
// the columns.
std::string report_csv(const ReportNames& names, const std::vector<ReportRow>& rows);

}  // namespace voyager::tools
