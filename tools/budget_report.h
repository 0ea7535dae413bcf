#pragma once
// What a time budget made of a run of frames.
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/frame_bench.h"

namespace voyager::tools {

// One camera's images against all leaves: PSNR in dB, infinite where they are the same.
struct BudgetError {
  size_t camera;     // in the path
  double fixed_tau;  // of `fixed`
  double budget, fixed;
};

// Of frames under one budget, at least one. docs/command-line.md explains the fields.
nlohmann::ordered_json time_budget_json(const FrameRun& run,
                                        const std::vector<BudgetError>& errors);

// One line.
void print_time_budget(const nlohmann::ordered_json& json);

}  // namespace voyager::tools
