#include "tools/report/page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "tools/report/pareto.h"

namespace voyager::tools {
namespace {

constexpr const char* kStyle = R"(
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 70rem; padding: 0 1rem; color: #222; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; }
.box { background: #f2f6fa; border-left: 4px solid #0072b2; padding: .6rem 1rem; }
.plots { display: flex; flex-wrap: wrap; gap: 1rem; } .plots figure { margin: 0; }
svg { max-width: 100%; height: auto; } img { max-width: 100%; image-rendering: auto; }
.wrong { background: #fdece4; border-left: 4px solid #d55e00; padding: .6rem 1rem; } td .wrong { border: 0; padding: 0 .3rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; } th, td { padding: .2rem .55rem; text-align: right; }
th:first-child, td:first-child { text-align: left; white-space: nowrap; }
th { border-bottom: 2px solid #888; } tr.front { background: #e6f3ea; } tr:target { outline: 2px solid #d55e00; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(18rem, 1fr)); gap: .6rem; }
figcaption { font-size: 13px; color: #444; }
)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

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

std::string decibels(double psnr) {
  return std::isfinite(psnr) ? fmt::format("{:.1f}", psnr) : "∞";
}

std::string fixed(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "–";
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
      decibels(row.all.psnr),
      fixed(row.all.ssim, 4),
      fmt::format("{:.4f}", row.all.flip),
      fmt::format("{:.4f}", row.all.largest),
      fmt::format("{:.4f}", row.all.p999),
      fixed(row.all.popping, 3),
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
      "<th>PSNR, all leaves, dB</th><th>SSIM</th><th>FLIP</th><th>max</th><th>p99.9</th>"
      "<th>popping, 1/255</th></tr>\n";
  for (size_t i = 0; i < page.rows.size(); ++i)
    text += table_row(page.rows[i], i,
                      std::find(page.front.begin(), page.front.end(), i) != page.front.end());
  return text + "</table></div>\n";
}

std::string provenance_list(const nlohmann::ordered_json& json) {
  std::string text = "<dl>\n";
  for (const auto& [key, value] : json.items()) {
    const std::string shown =
        value.is_string() ? value.get<std::string>()
                          : value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(key), escaped(shown));
  }
  return text + "</dl>\n";
}

std::string plots(const ReportPage& page) {
  std::string text = "<div class=\"plots\">\n";
  for (const PagePlot& plot : page.plots)
    text += fmt::format(
        "<figure class=\"plot\">{}<figcaption><a href=\"{}\">PNG</a></figcaption>"
        "</figure>\n",
        plot_svg(plot.plot, plot.file.substr(0, plot.file.find('.'))), plot.file);
  return text + "</div>\n";
}

std::string pictures(const ReportPage& page) {
  std::string text;
  for (const PageRow& shown : page.shown) {
    const ReportRow& row = page.rows[shown.row];
    text += fmt::format(
        "<h3><a href=\"#row-{}\">{}</a>: {:.3f} ms, FLIP {:.4f}</h3>\n"
        "<div class=\"pictures\">\n",
        shown.row, escaped(row.is.name()), row.frame.median, row.all.flip);
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
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\"><link rel=\"icon\" href=\"data:,\">"
      "<title>{0}</title><style>{1}</style></head><body>\n<h1>{0}</h1>\n"
      "<p class=\"box\">{2}</p>\n{8}<p>{3} Figures: <a href=\"report.csv\">report.csv</a>, "
      "<a href=\"report.json\">report.json</a>.</p>\n"
      "<h2 id=\"plots\">Error against time</h2>\n{4}"
      "<h2 id=\"pictures\">What is worth its time, and what it costs</h2>\n{5}"
      "<h2 id=\"rows\">Every configuration</h2>\n<p>Green rows are on the front. Except for the "
      "PSNR of the same cut, errors are against the float64 reference of all leaves.</p>\n{6}"
      "<h2 id=\"provenance\">Provenance</h2>\n{7}</body></html>\n",
      escaped(page.title), kStyle, escaped(page.recommendation), escaped(page.method), plots(page),
      pictures(page), table(page), provenance_list(page.provenance), warnings(page));
}

}  // namespace voyager::tools
