#pragma once
#include <string>

namespace voyager {

// A file with holes reads as zeros for free, as long as its size claims; what reads it must not
// take that for data. Throws Error(refused_input) for a regular file of more than 64 MB of which
// less than a quarter is data. Where a file system does not know, all of a file is. The position
// of the descriptor is kept.
void require_data(int fd, const std::string& name);

}  // namespace voyager
