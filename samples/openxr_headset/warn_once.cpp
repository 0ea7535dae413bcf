#include "warn_once.h"

#include <cstdio>
#include <set>

namespace host {

void warn_once(const std::string& text) {
  static std::set<std::string> said;
  if (said.insert(text).second) std::fprintf(stderr, "%s\n", text.c_str());
}

}  // namespace host
