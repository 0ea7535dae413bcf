#pragma once
// The configurations of a frame that a report compares.
#include <string>
#include <vector>

#include "runtime/frame/backend.h"

namespace voyager::tools {

struct FrameRow {
  std::string name;
  PipelineDesc desc;
};

// From 3DGS, every leaf and no search, to ours, one step a row. "base" is the exhaustive
// search with 3DGS's splatting. fastest: the search of "ours".
std::vector<FrameRow> ablation_rows(Search fastest);

// `desc` with each exponential; "exact" is the first.
std::vector<FrameRow> exponential_rows(PipelineDesc desc);

// One row, named after its choices.
FrameRow chosen_row(const PipelineDesc& desc, bool flat);

const char* search_name(Search search);  // "temporal" with or without slack
const char* exponential_name(Exponential exponential);
const char* splatting_name(Splatting splatting);

}  // namespace voyager::tools
