#pragma once
#include <string>
#include <vector>

#include "runtime/frame/backend.h"
#include "tools/image_size.h"
#include "tools/report/report_case.h"

namespace voyager::tools {

struct CurveRequest {
  std::vector<std::string> trees;  // files or URLs, of one scene
  std::string cameras;             // a file
  std::string output;              // a folder
  ReportExtent extent = ReportExtent::standard;
  ImageSize size;
  std::vector<std::string> arguments;  // how the request was put, for the provenance
};

// Measures what cuts of given shares of the leaves look like and cost, of each tree on the
// backend, and leaves the table, the page and the plots in the folder; the means on standard
// output. Throws Error(invalid_argument) for a scene without a tree, Error(refused_input) where
// the trees' leaves differ in number.
void make_curve(const CurveRequest& request, Backend& backend);

}  // namespace voyager::tools
