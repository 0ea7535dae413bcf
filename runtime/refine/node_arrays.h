#pragma once
// A baked scene's nodes as stages take them (runtime/stages/interpolate.h).
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/lod/baked_scene.h"
#include "runtime/lod/summarise.h"
#include "runtime/math/sh.h"

namespace voyager {

class NodeArrays {
 public:
  // The scene outlives this.
  NodeArrays(const BakedScene& baked, Workers& workers)
      : degree_(baked.leaves.sh_degree),
        footprints_(baked.leaves.native.levels > 1),
        codes_(baked.node_code.data()),
        gaussians_(baked.tree.size()),
        sh_(baked.tree.size()) {
    workers.for_blocks(gaussians_.size(), 4096, [&](size_t begin, size_t end) {
      for (size_t n = begin; n < end; ++n) {
        const MergeInput node = node_gaussian(static_cast<uint32_t>(n), baked);
        gaussians_[n] = node.gaussian;
        sh_[n] = node.sh;
      }
    });
  }

  int sh_degree() const { return degree_; }
  const Vec3f& mean(uint32_t i) const { return gaussians_[i].mean; }
  const Gaussian& gaussian(uint32_t i) const { return gaussians_[i]; }
  float opacity(uint32_t i) const { return gaussians_[i].opacity; }
  int node_code(uint32_t i) const { return codes_[i]; }
  bool footprints_differ() const { return footprints_; }
  auto sh(uint32_t i) const {
    return [own = sh_[i]](int k, int channel) { return own[3 * k + channel]; };
  }

 private:
  int degree_;
  bool footprints_;
  const uint8_t* codes_;
  std::vector<Gaussian> gaussians_;
  std::vector<const float*> sh_;
};

}  // namespace voyager
