#pragma once
#include <string>

#include "tools/image_size.h"
#include "tools/report/measure.h"
#include "tools/report/report_case.h"

namespace voyager::tools {

// What a report of this extent draws: the first of the file's cameras, as one walk, and of these
// some to be compared, each with the one behind it where there is one. Throws Error(refused_input)
// for a file without cameras, else as read_cameras() does.
ReportPlan report_plan(const std::string& cameras, const ImageSize& size, ReportExtent extent);
// The same, but that four are compared, or all where there are fewer.
ReportPlan curve_plan(const std::string& cameras, const ImageSize& size, ReportExtent extent);

}  // namespace voyager::tools
