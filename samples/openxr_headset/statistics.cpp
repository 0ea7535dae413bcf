#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace host {

void Statistics::waited(const XrFrameState& state) {
  if (last_ && state.predictedDisplayPeriod > 0) {
    const double periods = static_cast<double>(state.predictedDisplayTime - *last_) /
                           static_cast<double>(state.predictedDisplayPeriod);
    missed_ += static_cast<uint64_t>(std::max(std::round(periods) - 1, 0.0));
  }
  last_ = state.predictedDisplayTime;
}

double Statistics::percentile(double share) const {
  std::vector<double> sorted = milliseconds_;
  std::sort(sorted.begin(), sorted.end());
  const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<size_t>(rank, 1, sorted.size()) - 1];
}

std::string Statistics::summary() const {
  char text[256];
  std::snprintf(text, sizeof text,
                "%llu frames shown, %llu empty, %llu display periods missed; sessions: %llu "
                "restarts, %llu losses",
                static_cast<unsigned long long>(frames()), static_cast<unsigned long long>(empty_),
                static_cast<unsigned long long>(missed_),
                static_cast<unsigned long long>(restarts_),
                static_cast<unsigned long long>(losses_));
  std::string summary = text;
  if (frames() > 0) {
    std::snprintf(text, sizeof text, "; frame time %.2f ms median, %.2f ms p99", percentile(0.5),
                  percentile(0.99));
    summary += text;
  }
  return summary;
}

}  // namespace host
