#pragma once
// METHOD §4 as a stage: which Gaussian a cut node draws, and how much of its parent.
#include "runtime/lod/tree.h"
#include "runtime/math/code_groups.h"
#include "runtime/math/lerp.h"
#include "runtime/math/mean_code.h"
#include "runtime/math/node_code.h"
#include "runtime/math/sh.h"
#include "runtime/math/sh_code.h"
#include "runtime/math/shape_code.h"

namespace voyager {

// One Gaussian to draw. t = 1: its stored values, untouched, and no parent is read.
struct DrawItem {
  uint32_t gaussian;
  uint32_t parent;
  float t;
  float inverse_k;  // 1 / number of siblings, itself included
};

struct WeightParams {
  const NodeRecord* records;
  const uint32_t* parent;
  const float* sizes;  // screen_size of each node
  float target_size;   // τ*
  float blend_share;   // LodTree's
};

VOYAGER_HD DrawItem weigh(const WeightParams& params, uint32_t node) {
  const uint32_t parent = params.parent[node];
  const bool has_parent = parent != kNoNode;
  const float t = interpolation_weight(has_parent, has_parent ? params.sizes[parent] : 0.0f,
                                       params.sizes[node], params.target_size, params.blend_share);
  if (t == 1.0f) return {node, kNoNode, 1.0f, 1.0f};
  return {node, parent, t, 1.0f / static_cast<float>(params.records[parent].child_count)};
}

// The coefficients of one Gaussian on the host, [k][rgb]: where they lie, or unpacked.
class ShOf {
 public:
  explicit ShOf(const float* floats) : floats_(floats) {}
  ShOf(const uint8_t* row, int degree, const ShScales& scales) : floats_(nullptr) {
    unpack_sh(row, degree, scales, unpacked_);
  }
  float operator()(int k, int channel) const {
    return (floats_ != nullptr ? floats_ : unpacked_)[3 * k + channel];
  }

 private:
  const float* floats_;
  float unpacked_[3 * sh_coefficients(kMaxShDegree)];
};

struct PackedSh {
  const uint8_t* rows = nullptr;
  const ShScales* scales = nullptr;  // by group
};

// What a stage reads of the scene, on the host. A device has a layout of its own with
// the same members, which is why the functors below take any.
struct GaussianArrays {
  const Gaussian* gaussians;
  const float* coefficients;  // [k][rgb] a Gaussian
  const uint8_t* node_codes;  // of a tree; a flat scene has none
  int degree;
  bool doubles;     // nodes of one child are doubles, as files of version 4 have them
  bool footprints;  // that differ between nodes
  // In place of gaussians, coefficients and node codes, of a compact scene; else null.
  const MeanCode* means = nullptr;
  const ShapeCode* shapes = nullptr;
  ShapeTables tables{};
  PackedSh packed{};
  CodeGroups groups{};
  const MeanGrid* grids = nullptr;  // by group

  int sh_degree() const { return degree; }
  bool coded() const { return shapes != nullptr; }
  Vec3f mean(uint32_t i) const {
    return coded() ? restored_mean(means[i], grids[groups(i)]) : gaussians[i].mean;
  }
  Gaussian gaussian(uint32_t i) const {
    if (!coded()) return gaussians[i];
    Gaussian g = restored_shape(shapes[i], last_word(row(i), degree), tables);
    g.mean = mean(i);
    return g;
  }
  // Of a coded scene: what bounds its support, for less than gaussian() takes.
  float largest_scale(uint32_t i) const { return tables.scale[largest_scale_code(shapes[i])]; }
  float log_opacity(uint32_t i) const { return restored_log_opacity(shapes[i], tables); }
  float opacity(uint32_t i) const {
    return coded() ? restored_opacity(shapes[i], tables) : gaussians[i].opacity;
  }
  int node_code(uint32_t i) const { return coded() ? shapes[i].rest.node_code : node_codes[i]; }
  bool footprints_differ() const { return footprints; }
  // sh(i)(k, channel)
  ShOf sh(uint32_t i) const {
    if (!coded()) return ShOf(coefficients + i * 3 * static_cast<size_t>(sh_coefficients(degree)));
    return {row(i), degree, packed.scales[groups(i)]};
  }

 private:
  const uint8_t* row(uint32_t i) const { return packed.rows + size_t{i} * sh_row_bytes(degree); }
};

// What is drawn of a cut node. A double holds its only child's Gaussian: between the two there is
// nothing to interpolate, whatever t is.
VOYAGER_HD DrawItem drawn_item(const DrawItem& item, bool doubles) {
  if (doubles && item.inverse_k == 1.0f) return {item.gaussian, kNoNode, 1.0f, 1.0f};
  return item;
}

template <class Arrays>
VOYAGER_HD Vec3f interpolated_mean(const Arrays& arrays, const DrawItem& item) {
  const Vec3f mean = arrays.mean(item.gaussian);
  return item.t == 1.0f ? mean : lerp_rn(arrays.mean(item.parent), mean, item.t);
}

template <class T>
struct Shape {
  Vec3<T> scale;
  Quat<T> rotation;
  T opacity, log_opacity;
};

template <class T>
VOYAGER_HD Shape<T> stored_shape(const Gaussian& g) {
  return {{T(g.scale.x), T(g.scale.y), T(g.scale.z)},
          {T(g.rotation.w), T(g.rotation.x), T(g.rotation.y), T(g.rotation.z)},
          T(g.opacity),
          T(g.log_opacity)};
}

template <class T, class Arrays>
VOYAGER_HD Shape<T> interpolated_shape(const Arrays& arrays, const DrawItem& item) {
  Shape<T> shape = stored_shape<T>(arrays.gaussian(item.gaussian));
  if (item.t == 1.0f) return shape;
  const Shape<T> parent = stored_shape<T>(arrays.gaussian(item.parent));
  const int code = axis_code_of(arrays.node_code(item.gaussian));
  if (code != 0) {
    shape.scale = turn_scale(shape.scale, code);
    shape.rotation = shape.rotation * cube_rotation<T>(code);
  }
  const T t = T(item.t);
  shape.scale = lerp_positive(parent.scale, shape.scale, t);
  shape.rotation = lerp(parent.rotation, shape.rotation, t);
  shape.opacity =
      lerp_positive(T(arrays.opacity(item.parent)), T(arrays.opacity(item.gaussian)), t);
  shape.log_opacity = std::log(shape.opacity);
  return shape;
}

// METHOD §6: what an instance's opacity makes of the Gaussian's. 1 changes no bit, 0 leaves
// nothing.
template <class T>
VOYAGER_HD void fade(Shape<T>& shape, T opacity, T log_opacity) {
  shape.opacity *= opacity;
  shape.log_opacity += log_opacity;
}

// METHOD §12; largest: the scene's of level 0. Where all have that one, no code is read.
template <class T, class Arrays>
VOYAGER_HD T interpolated_footprint(const Arrays& arrays, const DrawItem& item, T largest) {
  if (!arrays.footprints_differ()) return largest;
  const T own = footprint_at(largest, footprint_level_of(arrays.node_code(item.gaussian)));
  if (item.t == 1.0f) return own;
  const T parent = footprint_at(largest, footprint_level_of(arrays.node_code(item.parent)));
  return lerp_positive(parent, own, T(item.t));
}

// direction: unit, from the camera to the interpolated mean, world axes.
template <class T, class Arrays>
VOYAGER_HD Vec3<T> interpolated_colour(const Arrays& arrays, const DrawItem& item,
                                       const Vec3<T>& direction) {
  const auto own = arrays.sh(item.gaussian);
  if (item.t == 1.0f)
    return sh_colour(arrays.sh_degree(), direction,
                     [&](int k, int channel) { return T(own(k, channel)); });
  const auto parent = arrays.sh(item.parent);
  const T t = T(item.t);
  return sh_colour(arrays.sh_degree(), direction, [&](int k, int channel) {
    return lerp(T(parent(k, channel)), T(own(k, channel)), t);
  });
}

}  // namespace voyager
