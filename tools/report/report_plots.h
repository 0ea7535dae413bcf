#pragma once
#include <vector>

#include "tools/report/page.h"

namespace voyager::tools {

// The front among all rows; and for each axis, its rows and the default.
std::vector<PagePlot> report_plots(const std::vector<ReportRow>& rows,
                                   const std::vector<size_t>& front);

}  // namespace voyager::tools
