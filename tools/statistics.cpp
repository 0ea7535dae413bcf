#include "tools/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace voyager::tools {

double percentile(std::vector<double> samples, double rank) {
  if (samples.empty()) return 0;
  const double place = std::ceil(rank * static_cast<double>(samples.size())) - 1;
  const auto nth = samples.begin() + static_cast<std::ptrdiff_t>(std::max(0.0, place));
  std::nth_element(samples.begin(), nth, samples.end());
  return *nth;
}

nlohmann::ordered_json summary(const std::vector<double>& samples) {
  const double sum = std::accumulate(samples.begin(), samples.end(), 0.0);
  return {{"median", percentile(samples, 0.5)},
          {"p95", percentile(samples, 0.95)},
          {"p99", percentile(samples, 0.99)},
          {"mean", samples.empty() ? 0.0 : sum / static_cast<double>(samples.size())}};
}

}  // namespace voyager::tools
