#pragma once
#include <algorithm>
#include <string_view>

namespace voyager {

// Whatever the case of letters: names come from systems that do not tell it apart. The ending is in
// lower case.
inline bool has_ending(std::string_view name, std::string_view ending) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  return name.size() >= ending.size() &&
         std::equal(ending.begin(), ending.end(), name.end() - static_cast<long>(ending.size()),
                    [&](char b, char a) { return same(a, b); });
}

}  // namespace voyager
