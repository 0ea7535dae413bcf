#pragma once
// A scene's Gaussians as kernels take them.
#include <cuda_runtime_api.h>

#include <cstdint>

#include "runtime/math/code_groups.h"
#include "runtime/math/mean_code.h"
#include "runtime/math/sh.h"
#include "runtime/math/sh_code.h"
#include "runtime/math/shape_code.h"
#include "runtime/select/pool_nodes.h"

namespace voyager::cuda {

// A node's parent, kNoNode of the root: by family, since siblings are consecutive.
struct ParentView {
  const uint32_t* parents;
  const RunBlock* families;  // null in a pool
  PoolParents pool{};

  // Of a coded scene.
  VOYAGER_HD bool owners_in_shapes() const { return pool.nodes.stride == sizeof(ShapeRest); }
#if defined(__CUDACC__)
  __device__ uint32_t operator()(uint32_t node) const {
    return families == nullptr ? pool(node) : __ldg(parents + run_of(families, node));
  }
#endif
};

enum class ShForm { half, single, coded };

struct CodedHull {
  MeanCode mean;
  uint32_t bounds;  // ShapeCode's
};

// The arrays are indexed by node id, or by address in a pool.
struct GaussianView {
  // Mean, and a word that bounds the support before all else is read: a CodedHull each, or of a
  // scene that is not coded a float4. The last word of that has the largest scale in its upper 16
  // bits, and in its lower 16 the radius of the support in standard deviations, at the least α*
  // there is, the truth's; 0 if α never reaches it. Both are rounded up to the upper half of a
  // binary32.
  const void* hulls;
  // Two words for each Gaussian: scale and log o, then rotation (w, x, y, z). A coded scene has one
  // ShapeRest for each.
  const void* shapes;
  // What interpolation reads. Null if every leaf is drawn, except node_codes of scenes with
  // differing footprints. A coded scene has opacities in its hulls, and node codes in its
  // shapes.
  const float* opacities;
  const uint8_t* node_codes;
  ParentView parents;
  // Null if the scene is coded: its shapes have the counts, except those of large families.
  const uint32_t* child_counts;
  const LargeFamily* large_families;
  const uint32_t* large_family_count;
  // SH coefficients [k][rgb]: binary16 padded to 16 bytes, binary32, or a coded scene's rows.
  const void* coefficients;
  int sh_degree;
  ShForm sh_form;
  bool doubles;     // nodes of one child are doubles, as files of version 4 have them
  bool footprints;  // that differ between nodes (METHOD §12)
  uint32_t count;
  // Of a coded scene.
  ShapeTables tables;
  const ShStepSizes* sh_steps;  // by group
  const MeanGrid* mean_grids;   // the same
  CodeGroups code_groups;
};

// 16-byte words of a Gaussian's coefficients in binary16.
VOYAGER_HD constexpr int half_sh_words(int degree) {
  return (3 * sh_coefficients(degree) + 7) / 8;
}

// Coefficients no larger than this are kept in binary16 on the device: each is then off by
// at most 2⁻⁹ (docs/numerics.md has what that does to colours).
inline constexpr float kMaxHalfCoefficient = 8.0f;

inline constexpr uint32_t coefficient_bytes(int degree, ShForm form) {
  return form == ShForm::coded  ? sh_row_bytes(degree)
         : form == ShForm::half ? 16u * static_cast<uint32_t>(half_sh_words(degree))
                                : 12u * static_cast<uint32_t>(sh_coefficients(degree));
}
inline constexpr uint32_t hull_bytes(ShForm form) {
  return form == ShForm::coded ? sizeof(CodedHull) : sizeof(float4);
}
inline constexpr uint32_t shape_bytes(ShForm form) {
  return form == ShForm::coded ? sizeof(ShapeRest) : 2 * sizeof(float4);
}

}  // namespace voyager::cuda
