#pragma once
#include <nlohmann/json.hpp>
#include <vector>

namespace voyager::tools {

// The value that a share `rank` of the samples does not exceed: 0.5 is the median. 0 of none.
double percentile(std::vector<double> samples, double rank);

// {"median", "p95", "p99", "mean"}
nlohmann::ordered_json summary(const std::vector<double>& samples);

}  // namespace voyager::tools
