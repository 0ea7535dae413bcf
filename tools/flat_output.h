#pragma once
// What convert and export say of the flat files that they write.
#include <string>

#include "runtime/scene/export/flat_file.h"

namespace voyager::tools {

// A note for each thing that the format has no place for.
void note_losses(const std::string& path, const FlatContents& contents);

// One line on standard output: what the file holds, and its size.
void describe_flat_file(const std::string& path, const FlatContents& contents);

}  // namespace voyager::tools
