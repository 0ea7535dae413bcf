#include "tools/report/page_parts.h"

#include <fmt/core.h>

#include <cmath>

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

}  // namespace

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

std::string decibels(double psnr, int digits) {
  return std::isfinite(psnr) ? fmt::format("{:.{}f}", psnr, digits) : "∞";
}

std::string fixed(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "–";
}

std::string plot_figures(const std::vector<PagePlot>& plots) {
  std::string text = "<div class=\"plots\">\n";
  for (const PagePlot& plot : plots)
    text += fmt::format(
        "<figure class=\"plot\">{}<figcaption><a href=\"{}\">PNG</a></figcaption>"
        "</figure>\n",
        plot_svg(plot.plot, plot.file.substr(0, plot.file.find('.'))), plot.file);
  return text + "</div>\n";
}

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\"><link rel=\"icon\" href=\"data:,\">"
      "<title>{0}</title><style>{1}</style></head><body>\n<h1>{0}</h1>\n",
      escaped(title), kStyle);
}

std::string page_end(const nlohmann::ordered_json& provenance) {
  return fmt::format("<h2 id=\"provenance\">Provenance</h2>\n{}</body></html>\n",
                     provenance_list(provenance));
}

}  // namespace voyager::tools
