#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace voyager::tools {

// No output of a command may be one of its inputs or another output, whatever links lead there.
// Empty names do not count. Throws Error(invalid_argument) naming both.
void require_distinct(const std::vector<std::string>& outputs,
                      const std::vector<std::string>& inputs);

// Nor may any of them be in a folder that the command makes and removes, or be that folder.
void require_outside(const std::string& folder, const std::vector<std::string>& paths);

// Nor may that folder be below the name of an output, which is a file. Throws
// Error(invalid_argument).
void require_not_below(const std::string& output, const std::string& folder);

// Throws Error(invalid_argument) unless the name ends in one of the extensions (".png"), in any
// case of letters.
void require_extension(const std::string& option, const std::string& path,
                       const std::vector<std::string>& extensions);

// Before the work that is to fill a file: throws Error(io) where it could not be written. `bytes`
// is what it will take at least, as far as that is known.
void require_writable(const std::string& path, uint64_t bytes = 0);

}  // namespace voyager::tools
