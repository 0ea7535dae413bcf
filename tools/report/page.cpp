#include "tools/report/page.h"

#include <fmt/core.h>

#include <algorithm>

#include "tools/report/page_parts.h"
#include "tools/report/pareto.h"

namespace voyager::tools {
namespace {

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t three = 0;
    for (size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : kDigits[three >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string not_finite(const ReportRow& row) {
  return fmt::format("{} pixels not finite", row.not_finite());
}

// Nothing where all is well.
std::string warnings(const ReportPage& page) {
  std::string text;
  for (size_t i = 0; i < page.rows.size(); ++i)
    if (page.rows[i].not_finite() > 0)
      text += fmt::format("<a href=\"#row-{}\">{}</a>: {}. ", i, escaped(page.rows[i].is.name()),
                          not_finite(page.rows[i]));
  return text.empty() ? text : "<p class=\"wrong\">" + text + "</p>\n";
}

std::string table_row(const ReportRow& row, size_t index, bool front) {
  const std::string cells[] = {
      fmt::format("{:.0f}", row.cut),
      fmt::format("{:.3f}", row.frame.median),
      fmt::format("{:.3f}", row.frame.p95),
      fmt::format("{:.3f}", row.frame.p99),
      row.bytes > 0 ? fmt::format("{:.1f}", row.bytes / 1e6) : "–",
      row.joules ? fmt::format("{:.3g}", *row.joules) : "–",
      decibels(row.same.psnr),
      decibels(row.truth.psnr),
      fixed(row.truth.ssim, 4),
      fmt::format("{:.4f}", row.truth.flip),
      fmt::format("{:.4f}", row.truth.largest),
      fmt::format("{:.4f}", row.truth.p999),
      fixed(row.truth.popping, 3),
      fixed(row.dolly, 3),
      fixed(row.turn, 3),
  };
  std::string text = fmt::format(
      "<tr id=\"row-{}\"{}><td>{}{}</td>", index, front ? " class=\"front\"" : "",
      escaped(row.is.name()),
      row.not_finite() > 0 ? " <span class=\"wrong\">" + not_finite(row) + "</span>" : "");
  for (const std::string& cell : cells) text += "<td>" + cell + "</td>";
  return text + "</tr>\n";
}

std::string table(const ReportPage& page) {
  std::string text =
      "<div class=\"wide\"><table><tr><th>configuration</th><th>cut</th><th>ms</th><th>p95</th>"
      "<th>p99</th><th>MB moved</th><th>joules</th><th>PSNR, same cut, dB</th>"
      "<th>PSNR, truth, dB</th><th>SSIM</th><th>FLIP</th><th>max</th><th>p99.9</th>"
      "<th>popping, 1/255</th><th>shimmer, dolly</th><th>turn</th></tr>\n";
  for (size_t i = 0; i < page.rows.size(); ++i)
    text += table_row(page.rows[i], i,
                      std::find(page.front.begin(), page.front.end(), i) != page.front.end());
  return text + "</table></div>\n";
}

std::string pictures(const ReportPage& page) {
  std::string text;
  for (const PageRow& shown : page.shown) {
    const ReportRow& row = page.rows[shown.row];
    text += fmt::format(
        "<h3><a href=\"#row-{}\">{}</a>: {:.3f} ms, FLIP {:.4f}</h3>\n"
        "<div class=\"pictures\">\n",
        shown.row, escaped(row.is.name()), row.frame.median, row.truth.flip);
    for (const PagePicture& picture : shown.pictures)
      text += fmt::format(
          "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\">"
          "<figcaption>{0}</figcaption></figure>\n",
          escaped(picture.caption), base64(picture.png));
    text += "</div>\n";
  }
  return text;
}

}  // namespace

std::string html(const ReportPage& page) {
  return page_head(page.title) +
         fmt::format(
             "<p class=\"box\">{}</p>\n{}<p>{} Figures: <a href=\"report.csv\">report.csv</a>, "
             "<a href=\"report.json\">report.json</a>.</p>\n"
             "<h2 id=\"plots\">Error against time</h2>\n{}"
             "<h2 id=\"pictures\">What is worth its time, and what it costs</h2>\n{}"
             "<h2 id=\"rows\">Every configuration</h2>\n<p>Green rows are on the front. Except for "
             "the PSNR of the same cut, which is against the float64 reference, errors are against "
             "the "
             "truth: every leaf, the mean of many samples a pixel.</p>\n"
             "{}",
             escaped(page.recommendation), warnings(page), escaped(page.method),
             plot_figures(page.plots), pictures(page), table(page)) +
         page_end(page.provenance);
}

}  // namespace voyager::tools
