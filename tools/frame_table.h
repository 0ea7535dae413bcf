#pragma once
#include <nlohmann/json.hpp>

namespace voyager::tools {

// Tables of rows that report_row() gave: times, counters, floors.
void print_frames(const nlohmann::ordered_json& rows);

}  // namespace voyager::tools
