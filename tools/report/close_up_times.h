#pragma once
// What the default takes close up, where a frame takes longest. It is no configuration: its path is
// another, so that it stands beside the table.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/close_up.h"
#include "tools/report/report_row.h"

namespace voyager::tools {

struct CloseUpTimes {
  double time_budget = 0;  // milliseconds; 0: tau is fixed
  double tau = 0;          // as used, the median
  double splats = 0;       // a mean frame's
  ReportTimes frame;
};

// Along close_up_cameras() from this camera: at the case's tau and, of a scene with a tree, in a
// budget of `target` milliseconds. Empty where nothing is in front of the camera.
std::vector<CloseUpTimes> close_up_times(const FrameMaker& maker, const ReportCase& is,
                                         const Camera& from, double target);

nlohmann::ordered_json to_json(const CloseUpTimes& times);
// One sentence; empty where there are none.
std::string close_up_text(const std::vector<CloseUpTimes>& times);

}  // namespace voyager::tools
