#pragma once
// "bake --optimize", and what it says at the end.
#include <optional>

#include "runtime/optimize/optimize.h"
#include "tools/commands/measured_backend.h"

namespace CLI {
class App;
}

namespace voyager::tools {

struct OptimizeOptions {
  std::optional<OptimizeQuality> quality;
  double minutes = 0;     // above 0: in place of a quality
  BackendChoice backend;  // that draws the pictures

  bool wanted() const { return quality || minutes > 0; }
  OptimizeGoal goal(uint64_t merged_nodes) const;
};

void add_optimize_options(CLI::App& command, OptimizeOptions& options);

void print_learned(const OptimizeSummary& learned);

}  // namespace voyager::tools
