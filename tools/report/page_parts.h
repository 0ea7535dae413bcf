#pragma once
// What the pages of reports have in common: no file beside one is needed to read it.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/plot.h"

namespace voyager::tools {

struct PagePlot {
  std::string file;  // its PNG's name, beside the page
  Plot plot;
};

// As text of a page, or an attribute's value.
std::string escaped(const std::string& text);
// "33.1"; "∞" where nothing differs.
std::string decibels(double psnr, int digits = 1);
// "–" where there is none.
std::string fixed(const std::optional<double>& value, int digits);
// The plots inline, each with a link to its PNG.
std::string plot_figures(const std::vector<PagePlot>& plots);

// Up to the title, which is shown; and from the provenance on.
std::string page_head(const std::string& title);
std::string page_end(const nlohmann::ordered_json& provenance);

}  // namespace voyager::tools
