#pragma once
// One node's Gaussian as it is in a flat scene.
#include "runtime/format/chunk.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// A linear opacity becomes flat_logit() of it. sh: as many as the cloud has of each.
inline void append_flat(const GaussianWords& words, bool has_logit, const float* sh,
                        GaussianCloud& cloud) {
  const auto add = [](std::pmr::vector<float>& to, const float* from, size_t count) {
    to.insert(to.end(), from, from + count);
  };
  add(cloud.position, &words.mean.x, 3);
  add(cloud.log_scale, &words.log_scale.x, 3);
  add(cloud.rotation, &words.rotation.w, 4);
  cloud.opacity.push_back(has_logit ? words.opacity : flat_logit(words.opacity));
  add(cloud.sh, sh, static_cast<size_t>(cloud.coefficients()) * 3);
}

// Of node i of a chunk; positions are relative to the file's origin.
inline void append_flat(const Chunk& chunk, size_t i, GaussianCloud& cloud) {
  const auto floats = static_cast<size_t>(cloud.coefficients()) * 3;
  append_flat(chunk.words[i], chunk.has_logit(i), &chunk.sh[i * floats], cloud);
}

}  // namespace voyager
