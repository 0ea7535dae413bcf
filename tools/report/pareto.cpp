#include "tools/report/pareto.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/frame_rows.h"
#include "tools/lod_options.h"

namespace voyager::tools {

std::vector<size_t> pareto_front(const std::vector<ReportRow>& rows) {
  std::vector<size_t> order(rows.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return rows[a].frame.median != rows[b].frame.median
               ? rows[a].frame.median < rows[b].frame.median
               : rows[a].all.flip < rows[b].all.flip;
  });
  std::vector<size_t> front;
  double least = INFINITY;
  for (const size_t i : order)
    if (rows[i].all.flip < least) {
      least = rows[i].all.flip;
      front.push_back(i);
    }
  return front;
}

std::optional<size_t> recommend(const std::vector<ReportRow>& rows,
                                const std::vector<size_t>& front, double target) {
  std::optional<size_t> best;
  for (const size_t i : front)
    if (rows[i].frame.p95 <= target && (!best || rows[i].all.flip < rows[*best].all.flip)) best = i;
  return best;
}

std::string render_options(const ReportCase& is, double tau) {
  std::string text;
  if (is.time_budget > 0)
    text = fmt::format("--time-budget {:.3g}", is.time_budget);
  else
    text = draws_cut(is.desc.lod) ? fmt::format("--tau {:g}", tau) : "--lod off";
  if (draws_cut(is.desc.lod) && is.desc.lod != Lod::cut)
    text += fmt::format(" --select {}", select_name(is.desc.lod));
  if (draws_cut(is.desc.lod) && is.desc.search != Search::temporal) {
    text += fmt::format(" --search {}", search_name(is.desc.search));
    if (is.desc.search == Search::temporal_visit) text += " --slack off";
  }
  if (is.desc.splatting == Splatting::baseline_3dgs) return text + " --splat 3dgs";
  text += fmt::format(" --exp {}", exponential_name(is.desc.exponential));
  if (is.desc.exponential == Exponential::lut)
    text += fmt::format(" --lut-size {}", is.desc.lut_size);
  if (!is.desc.alpha_filter) text += " --filter off";
  return text;
}

}  // namespace voyager::tools
