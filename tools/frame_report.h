#pragma once
// Turns measured frames into rows of JSON: times, counters, floors, scores.
#include <nlohmann/json.hpp>

#include "tools/frame_bench.h"
#include "tools/frame_rows.h"

namespace voyager::tools {

struct ReportContext {
  const FramePath& path;
  DeviceRates rates;  // of the device that drew; zero where unknown
  int sh_degree;
  bool flat;  // the scene has no tree, so that nothing is searched
};

// {"name", the choices, "ms": {"frame", "splat", each stage: summary()}, "counters", "bytes",
// "work_efficiency", "floor", "orin", and "cameras" where the path was repeated}; null where
// something is not known. docs/command-line.md explains the fields.
nlohmann::ordered_json report_row(const FrameRow& row, const FrameRun& run,
                                  const ReportContext& context);

// Adds "speedup": how often faster than the rows "base" and "3dgs", by the frame's median;
// null where there is no such row.
void add_speedups(nlohmann::ordered_json& rows);

// Adds "error": of the row's images against those of `expected`.
void add_error(nlohmann::ordered_json& row, const ImageError& error, size_t images);

}  // namespace voyager::tools
