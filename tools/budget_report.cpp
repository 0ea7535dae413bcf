#include "tools/budget_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "tools/console.h"
#include "tools/statistics.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

bool is_late(const FrameStats& stats) {
  return stats.total_milliseconds > stats.time_budget;
}

template <class Counted>
double share(const std::vector<FrameStats>& frames, const Counted& counted) {
  const auto count = std::count_if(frames.begin(), frames.end(), counted);
  return static_cast<double>(count) / static_cast<double>(frames.size());
}

// Of the frames, those with another τ than the one before.
double share_moved(const std::vector<double>& taus) {
  size_t moved = 0;
  for (size_t i = 1; i < taus.size(); ++i) moved += taus[i] != taus[i - 1];
  return static_cast<double>(moved) / static_cast<double>(taus.size());
}

// JSON has no infinity: null is the same image.
Json decibels(double psnr) {
  return std::isfinite(psnr) ? Json(psnr) : Json();
}

Json to_json(const std::vector<BudgetError>& errors, const std::vector<double>& taus) {
  Json json = Json::array();
  for (const BudgetError& error : errors)
    json.push_back({{"camera", error.camera},
                    {"tau", taus[error.camera]},
                    {"budget", decibels(error.budget)},
                    {"fixed_tau", error.fixed_tau},
                    {"fixed", decibels(error.fixed)}});
  return json;
}

}  // namespace

Json time_budget_json(const FrameRun& run, const std::vector<BudgetError>& errors) {
  const std::vector<FrameStats>& frames = run.timed;
  std::vector<double> taus, times;
  std::vector<uint64_t> cuts;
  for (const FrameStats& stats : frames) {
    taus.push_back(stats.tau);
    times.push_back(stats.total_milliseconds);
    cuts.push_back(stats.cut_size);
  }
  const auto unreachable = [](const FrameStats& s) { return is_late(s) && s.tau_is_greatest; };
  return {{"milliseconds", frames[0].time_budget},
          {"on_time", 1 - share(frames, is_late)},
          {"unreachable", share(frames, unreachable)},
          {"moved", share_moved(taus)},
          {"tau", summary(taus)},
          {"ms", summary(times)},
          {"path", {{"tau", taus}, {"ms", times}, {"cut", cuts}}},
          {"psnr", to_json(errors, taus)}};
}

void print_time_budget(const Json& json) {
  say(fmt::format(
      "budget {} ms: {:.1f} % of the frames on time, tau {:.2f} (median), p99 {:.3f} ms\n",
      json["milliseconds"].get<double>(), 100 * json["on_time"].get<double>(),
      json["tau"]["median"].get<double>(), json["ms"]["p99"].get<double>()));
}

}  // namespace voyager::tools
