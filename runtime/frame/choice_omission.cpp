#include "runtime/frame/choice_omission.h"

namespace voyager {

std::vector<Omission> omissions_of(const ViewChoices& choices, const ViewShape& shape) {
  std::vector<Omission> all;
  const uint64_t pixels = shape.eyes * shape.pixels;
  // What is kept of them is written as it comes and read once.
  if (pixels != 0 && !choices.limits)
    all.push_back({"depth limits", "no frame had any", pixels * choices.limit_bytes,
                   2 * pixels * choices.limit_bytes});
  if (choices.desc.exponential != Exponential::lut)
    all.push_back({"table of the exponential", "the view computes it",
                   (uint64_t{choices.desc.lut_size} + 1) * sizeof(float), 0});
  return all;
}

}  // namespace voyager
