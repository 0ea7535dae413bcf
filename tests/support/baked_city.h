#pragma once
// A small synthetic city of SH degree 0 with its tree.
#include "runtime/scene/append.h"
#include "tests/support/scene_files.h"
#include "tools/synth/city.h"

namespace voyager::test {

inline BakedScene baked_city(uint64_t gaussians) {
  GaussianCloud all;
  synth::generate_city(
      {.gaussians = gaussians, .seed = 7, .sh_degree = 0},
      [&](const GaussianCloud& part) { append(all, GaussianCloud(part), "city"); });
  return bake(all);
}

}  // namespace voyager::test
