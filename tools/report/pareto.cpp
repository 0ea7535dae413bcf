#include "tools/report/pareto.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "tools/frame_rows.h"
#include "tools/lod_options.h"

namespace voyager::tools {
namespace {

bool can_be_advised(const ReportRow& row, const ReportRow& first) {
  return row.is.sh_degree == first.is.sh_degree && row.is.group != "search" &&
         row.is.group != "filter";
}

// Of the same error the first row, then the fastest.
std::vector<size_t> by_error(const std::vector<ReportRow>& rows) {
  std::vector<size_t> order(rows.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto key = [&](size_t i) {
    return std::tuple(rows[i].truth.flip, i != 0, rows[i].frame.median);
  };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return key(a) < key(b); });
  return order;
}

}  // namespace

std::vector<size_t> pareto_front(const std::vector<ReportRow>& rows) {
  std::vector<size_t> order(rows.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return rows[a].frame.median != rows[b].frame.median
               ? rows[a].frame.median < rows[b].frame.median
               : rows[a].truth.flip < rows[b].truth.flip;
  });
  std::vector<size_t> front;
  double least = INFINITY;
  for (const size_t i : order)
    if (rows[i].truth.flip < least) {
      least = rows[i].truth.flip;
      front.push_back(i);
    }
  return front;
}

Advice advise(const std::vector<ReportRow>& rows, double target) {
  Advice best;
  for (size_t i = 1; i < rows.size(); ++i)
    if (can_be_advised(rows[i], rows[0]) && rows[i].frame.median < rows[best.row].frame.median)
      best.row = i;
  for (const size_t i : by_error(rows))
    if (can_be_advised(rows[i], rows[0]) && rows[i].frame.p95 <= target) return {i, true};
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
