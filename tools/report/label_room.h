#pragma once
#include <vector>

namespace voyager::tools {

struct LabelBox {
  double left = 0, top = 0, right = 0, bottom = 0;
};

// What is taken of a plot's plane, so that no label covers another.
class LabelRoom {
 public:
  // False, and as before, where the box overlaps one that was taken.
  bool take(const LabelBox& box);

 private:
  std::vector<LabelBox> taken_;
};

}  // namespace voyager::tools
