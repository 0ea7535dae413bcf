#pragma once
#include <string>
#include <string_view>

namespace voyager {

// What a file says, as a terminal may show it: control characters, of which some move the cursor or
// change what a terminal does, and bytes that are not UTF-8 become \x1b and the like. All other
// text stays as it is.
std::string printable(std::string_view text);

}  // namespace voyager
