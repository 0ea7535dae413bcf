#pragma once
#include <string>
#include <vector>

namespace voyager::tools {

// No output of a command may be one of its inputs or another output. Empty
// names do not count. Throws Error(invalid_argument) naming both.
void require_distinct(const std::vector<std::string>& outputs,
                      const std::vector<std::string>& inputs);

// Throws Error(invalid_argument) unless the name ends in one of the extensions (".png").
void require_extension(const std::string& option, const std::string& path,
                       const std::vector<std::string>& extensions);

}  // namespace voyager::tools
