#pragma once
// That the scene is there, and which file it is: said in the work folder before that is removed, so
// that a bake which was killed in between has nothing to do again.
#include <optional>
#include <string>

#include "runtime/bake/bake.h"
#include "runtime/bake/work_folder.h"

namespace voyager {

// After the scene has its name. Throws Error(io).
void note_merged(const WorkFolder& folder, const std::string& output, const BakeSummary& summary);

// What it came to; nothing where the output is not the file that was merged, or no longer there.
std::optional<BakeSummary> read_merged(const WorkFolder& folder, const std::string& output);

}  // namespace voyager
