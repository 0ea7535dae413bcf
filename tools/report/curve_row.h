#pragma once
// What a cut of so many of a tree's leaves looks like and costs.
#include <string>
#include <vector>

#include "tools/report/report_row.h"

namespace voyager::tools {

// Of the leaves, largest first.
inline constexpr double kCurveShares[] = {0.9, 0.8, 0.65, 0.5, 0.35, 0.2, 0.1};
inline constexpr const char* kFlight = "flight";

struct CurveRow {
  std::string tree;
  std::string view;      // the camera's index among the file's, or kFlight
  double share = 0;      // of kCurveShares, as asked for
  double cut_share = 0;  // that the cut has
  double tau = 0, cut = 0, splats = 0, pairs = 0;
  ReportError error;  // against every leaf
  double milliseconds = 0;

  // As far as this is possible: trees have no cuts between some sizes, and none above tau 0's.
  bool has_share() const;
};

// Means of each number, of decibels too; rows of one tree at one share, not empty. Popping over
// those that have it; pixels that are not finite are added up.
CurveRow mean_row(const std::vector<CurveRow>& rows, const std::string& view);

// One tree over kCurveShares, each the mean over its views.
struct Curve {
  std::string tree;
  std::vector<CurveRow> means;
  std::vector<bool> everywhere;  // every view has a cut of that share
};

// Of the trees in their order.
std::vector<Curve> mean_curves(const std::vector<CurveRow>& rows);

nlohmann::ordered_json to_json(const CurveRow& row);

}  // namespace voyager::tools
