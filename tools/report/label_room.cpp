#include "tools/report/label_room.h"

#include <algorithm>

namespace voyager::tools {

bool LabelRoom::take(const LabelBox& box) {
  const auto overlaps = [&](const LabelBox& other) {
    return box.left < other.right && other.left < box.right && box.top < other.bottom &&
           other.top < box.bottom;
  };
  if (std::any_of(taken_.begin(), taken_.end(), overlaps)) return false;
  taken_.push_back(box);
  return true;
}

}  // namespace voyager::tools
