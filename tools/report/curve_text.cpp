#include "tools/report/curve_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "tools/report/csv_line.h"
#include "tools/report/page_parts.h"
#include "tools/report/report_text.h"

namespace voyager::tools {
namespace {

const char* const kColumns[] = {"tree", "view",    "share",     "cut_share", "tau",
                                "cut",  "splats",  "pairs",     "psnr_db",   "ssim",
                                "flip", "popping", "ms_median", "not_finite"};

// "+0.51"; nothing where one of the two has no difference at all.
std::string difference(double psnr, double last) {
  if (psnr == last) return "0.00";
  const double difference = psnr - last;
  return std::isfinite(difference) ? fmt::format("{:+.2f}", difference) : "–";
}

// In characters, of UTF-8.
size_t width_of(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string padding(const std::string& text, size_t width) {
  return std::string(width - std::min(width, width_of(text)), ' ');
}

}  // namespace

std::string curve_csv(const std::vector<CurveRow>& rows) {
  CsvLine header;
  for (const char* column : kColumns) header.text(column);
  std::string csv = header.take();
  for (const CurveRow& row : rows) {
    CsvLine line;
    line.text(row.tree).text(row.view).number(row.share).number(row.cut_share).number(row.tau);
    line.number(row.cut).number(row.splats).number(row.pairs);
    line.decibels(row.error.psnr).number(row.error.ssim).number(row.error.flip);
    line.number(row.error.popping).number(row.milliseconds);
    line.number(static_cast<double>(row.error.not_finite));
    csv += line.take();
  }
  return csv;
}

std::string share_text(double share) {
  return fmt::format("{:.0f} %", 100 * share);
}

std::vector<CurveLine> curve_lines(const std::vector<Curve>& curves) {
  std::vector<CurveLine> lines;
  const Curve& last = curves.back();
  for (const Curve& curve : curves) {
    CurveLine psnr{curve.tree, {}}, above{"  above " + last.tree, {}};
    for (size_t i = 0; i < curve.means.size(); ++i) {
      const CurveRow& mean = curve.means[i];
      psnr.cells.push_back(decibels(mean.error.psnr, 2) + (curve.everywhere[i] ? "" : "*"));
      above.cells.push_back(difference(mean.error.psnr, last.means[i].error.psnr));
    }
    lines.push_back(psnr);
    if (&curve != &last) lines.push_back(above);
  }
  return lines;
}

std::string curve_table(const std::vector<Curve>& curves) {
  std::vector<CurveLine> lines = {{"mean PSNR, dB", {}}};
  for (const double share : kCurveShares) lines[0].cells.push_back(share_text(share));
  for (const CurveLine& line : curve_lines(curves)) lines.push_back(line);
  size_t width = 0;
  for (const CurveLine& line : lines) width = std::max(width, width_of(line.name));
  std::string text;
  for (const CurveLine& line : lines) {
    text += line.name + padding(line.name, width);
    for (const std::string& cell : line.cells) text += padding(cell, 8) + cell;
    text += "\n";
  }
  if (text.find('*') != std::string::npos) text += std::string(kStarText) + "\n";
  return text;
}

std::string curve_method_text(const ReportPlan& plan, const std::string& first,
                              const Backend& backend) {
  return fmt::format(
      "{} views of {}, each at the τ at which its cut has the share of the leaves. Errors are "
      "against the truth of {}: every leaf, the mean of many samples a pixel, drawn by the same "
      "backend ({}) with the exact exponential. Milliseconds are of a view that stands still; of "
      "the flight, of the second view of a pair that comes after the first.",
      plan.compared.size(), sizes_text(plan.path), first, backend.device_name());
}

}  // namespace voyager::tools
