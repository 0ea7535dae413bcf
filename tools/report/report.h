#pragma once
#include <string>
#include <vector>

#include "runtime/frame/backend.h"
#include "tools/image_size.h"
#include "tools/report/report_case.h"

namespace voyager::tools {

struct ReportRequest {
  std::string scene;    // a file or a URL
  std::string cameras;  // a file
  std::string output;   // a folder
  ReportExtent extent = ReportExtent::standard;
  ImageSize size;
  double target = 1000.0 / 90;  // milliseconds a frame, for the recommendation
  // How the request was put, without the target: with the files and the machine, all that
  // measurements depend on. A report that was ended goes on where these are the same.
  std::vector<std::string> arguments;
};

// Measures every configuration on the backend, and leaves the table, the page and the plots in the
// folder; says on standard output what it recommends. Throws Error, and leaves what was measured
// for the next time.
void make_report(const ReportRequest& request, Backend& backend);

}  // namespace voyager::tools
