#pragma once
// Curves as plots and as one page.
#include "tools/report/curve_row.h"
#include "tools/report/page_parts.h"

namespace voyager::tools {

struct CurvePage {
  nlohmann::ordered_json provenance;
  std::string method;  // how it was timed and compared, a sentence or two
  const std::vector<PagePlot>& plots;
  const std::vector<CurveRow>& rows;
  const std::vector<Curve>& curves;  // of the rows
};

inline constexpr const char* kCurvePlotFiles[] = {"curve_first.png",  "curve_mean.png",
                                                  "curve_splats.png", "curve_time.png",
                                                  "curve_ssim.png",   "curve_flip.png"};
// PSNR over the cut's share of the leaves, of the first view and of all; and over time.
std::vector<PagePlot> curve_plots(const std::vector<CurveRow>& rows,
                                  const std::vector<Curve>& curves);
std::string html(const CurvePage& page);

}  // namespace voyager::tools
