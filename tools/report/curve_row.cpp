#include "tools/report/curve_row.h"

#include <algorithm>
#include <cmath>

namespace voyager::tools {

bool CurveRow::has_share() const {
  return std::fabs(cut_share - share) <= 0.01 * share;
}

CurveRow mean_row(const std::vector<CurveRow>& rows, const std::string& view) {
  CurveRow mean = rows[0];
  mean.view = view;
  const auto count = static_cast<double>(rows.size());
  const auto take = [&](auto value) {
    double sum = 0;
    for (const CurveRow& row : rows) sum += value(row);
    return sum / count;
  };
  for (double CurveRow::*value : {&CurveRow::cut_share, &CurveRow::tau, &CurveRow::cut,
                                  &CurveRow::splats, &CurveRow::pairs, &CurveRow::milliseconds})
    mean.*value = take([&](const CurveRow& row) { return row.*value; });
  for (double ReportError::*value :
       {&ReportError::psnr, &ReportError::flip, &ReportError::largest, &ReportError::p999})
    mean.error.*value = take([&](const CurveRow& row) { return row.error.*value; });
  mean.error.ssim = 0.0;
  mean.error.not_finite = 0;
  double popping = 0;
  size_t pops = 0;
  for (const CurveRow& row : rows) {
    const std::optional<double>& ssim = row.error.ssim;
    mean.error.ssim =
        mean.error.ssim && ssim ? std::optional(*mean.error.ssim + *ssim / count) : std::nullopt;
    mean.error.not_finite += row.error.not_finite;
    popping += row.error.popping.value_or(0);
    pops += row.error.popping.has_value();
  }
  mean.error.popping = std::nullopt;
  if (pops > 0) mean.error.popping = popping / static_cast<double>(pops);
  return mean;
}

std::vector<Curve> mean_curves(const std::vector<CurveRow>& rows) {
  std::vector<Curve> curves;
  for (const CurveRow& row : rows) {
    if (!curves.empty() && curves.back().tree == row.tree) continue;
    Curve& curve = curves.emplace_back(Curve{row.tree, {}, {}});
    for (const double share : kCurveShares) {
      std::vector<CurveRow> views;
      for (const CurveRow& of : rows)
        if (of.tree == row.tree && of.share == share && of.view != kFlight) views.push_back(of);
      curve.means.push_back(mean_row(views, "mean"));
      curve.everywhere.push_back(std::all_of(views.begin(), views.end(),
                                             [](const CurveRow& of) { return of.has_share(); }));
    }
  }
  return curves;
}

nlohmann::ordered_json to_json(const CurveRow& row) {
  nlohmann::ordered_json json = {
      {"tree", row.tree}, {"view", row.view}, {"share", row.share},   {"cut_share", row.cut_share},
      {"tau", row.tau},   {"cut", row.cut},   {"splats", row.splats}, {"pairs", row.pairs}};
  json.update(to_json(row.error));
  json["ms_median"] = row.milliseconds;
  return json;
}

}  // namespace voyager::tools
