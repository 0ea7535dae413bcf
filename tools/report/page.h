#pragma once
// The report as one page: no file beside it is needed to read it.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/report/page_parts.h"
#include "tools/report/report_row.h"

namespace voyager::tools {

struct PagePicture {
  std::string caption, png;  // the file's bytes
};

// Pictures of one row.
struct PageRow {
  size_t row;
  std::vector<PagePicture> pictures;
};

struct ReportPage {
  std::string title;
  nlohmann::ordered_json provenance;
  std::string method;          // how it was timed and compared, a sentence or two
  std::string recommendation;  // likewise
  std::vector<PagePlot> plots;
  const std::vector<ReportRow>& rows;
  std::vector<size_t> front;
  std::vector<PageRow> shown;
};

std::string html(const ReportPage& page);

}  // namespace voyager::tools
