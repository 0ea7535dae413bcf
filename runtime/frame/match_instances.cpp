#include "runtime/frame/match_instances.h"

#include <algorithm>

namespace voyager {

std::vector<size_t> match_instances(const Scenes& before, const Scenes& now) {
  std::vector<size_t> from;
  from.reserve(now.size());
  std::vector<bool> taken(before.size());
  for (const auto& scene : now) {
    size_t of = 0;
    while (of < before.size() && (taken[of] || before[of] != scene)) ++of;
    if (of < before.size()) taken[of] = true;
    from.push_back(of < before.size() ? of : kNewInstance);
  }
  return from;
}

}  // namespace voyager
