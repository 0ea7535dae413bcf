#pragma once
#include <string>
#include <vector>

#include "tools/report/page.h"

namespace voyager::tools {

// The front among all rows; and for each axis, its rows and the default.
std::vector<PagePlot> report_plots(const std::vector<ReportRow>& rows,
                                   const std::vector<size_t>& front);

// The names of all files that these can have.
std::vector<std::string> report_plot_files();

}  // namespace voyager::tools
