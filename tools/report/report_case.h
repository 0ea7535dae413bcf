#pragma once
// The configurations that a report measures.
#include <optional>
#include <string>
#include <vector>

#include "runtime/format/layout.h"
#include "runtime/frame/backend.h"

namespace voyager::tools {

enum class ReportExtent { quick, standard, full };

struct ReportCase {
  std::string group;  // what it varies: "tau", "exp", "filter", "sh", "quality", "search", ...
  PipelineDesc desc;
  double tau = 3;          // of a cut
  double time_budget = 0;  // milliseconds; 0: tau is fixed
  int sh_degree = 0;       // at most the scene's
  Storage storage = Storage::flat;

  // "tau 3, temporal, ex2, sh 3, compact", unique in a report.
  std::string name() const;
};

// What of a case depends on the scene and on who draws it.
struct ReportSubject {
  bool flat = false;  // no tree
  int sh_degree = 0;
  std::vector<Storage> storages;  // the file's own first
  std::vector<Exponential> exponentials;
  Search search = Search::temporal;  // that runs where none is chosen
  bool baseline = false;             // the backend has Splatting::baseline_3dgs
};

// One case for each value of each axis, the others as in the first, which is what a host gets that
// chooses nothing; and, unless quick, combinations of the axes that trade error for time.
std::vector<ReportCase> report_cases(ReportExtent extent, const ReportSubject& subject);

// `base` under budgets of two thirds and of a third of a frame's time.
std::vector<ReportCase> time_budget_cases(const ReportCase& base, double milliseconds);

const char* storage_name(Storage storage);

}  // namespace voyager::tools
