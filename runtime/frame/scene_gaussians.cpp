#include "runtime/frame/scene_gaussians.h"

#include <algorithm>

#include "runtime/format/quantise.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

// One that is empty has no memory.
template <class Array>
void fit(Array& array, size_t size) {
  Array(size, array.get_allocator()).swap(array);
}

void shorten_rows(int degree, int lower, std::pmr::vector<uint8_t>& rows) {
  const size_t from = sh_row_bytes(degree), to = sh_row_bytes(lower);
  const size_t count = rows.size() / from;
  std::pmr::vector<uint8_t> shorter(count * to, rows.get_allocator());
  for (size_t i = 0; i < count; ++i)
    shorten_sh(rows.data() + i * from, degree, lower, shorter.data() + i * to);
  shorter.swap(rows);
}

ScaleCodes scales_of(const GaussianWords& words) {
  const Vec3f& log = words.log_scale;
  return scale_codes(std::array<uint32_t, 3>{quantise_log_scale(log.x), quantise_log_scale(log.y),
                                             quantise_log_scale(log.z)});
}

}  // namespace

ShapeCode shape_code(const Chunk& chunk, size_t i) {
  const GaussianWords& words = chunk.words[i];
  const bool logit = chunk.has_logit(i);
  const uint32_t opacity =
      logit ? quantise_leaf_opacity(words.opacity) : float_to_half(words.opacity);
  ShapeCode code{bounds_code(scales_of(words).largest, opacity, logit), {}};
  std::copy_n(chunk.rotation_code[i].begin(), 3, code.rest.rotation);
  code.rest.node_code = chunk.node_code[i];
  code.rest.children =
      static_cast<uint8_t>(std::min(chunk.record_of(i).child_count, kManyChildren));
  return code;
}

void put_row(const Chunk& chunk, size_t i, int degree, uint8_t* row) {
  const size_t floats = 3 * static_cast<size_t>(sh_coefficients(degree));
  pack_sh(chunk.sh.data() + i * floats, degree, chunk.sh_scale, row);
  put_last_word(scales_of(chunk.words[i]).others, degree, row);
}

CodeGroups code_groups(const Scene& scene) {
  return {scene.group_blocks.empty() ? nullptr : scene.group_blocks.data(), scene.slot_nodes};
}

PackedSh packed_sh(const Scene& scene) {
  return {scene.sh_rows.data(), scene.sh_scales.data()};
}

size_t gaussian_count(const Scene& scene) {
  return is_coded(scene) ? scene.mean_codes.size() : scene.gaussians.size();
}

uint64_t gaussian_bytes(Storage storage, int degree) {
  if (storage == Storage::compact)
    return sizeof(MeanCode) + sizeof(ShapeCode) + sh_row_bytes(degree);
  return sizeof(Gaussian) + 3 * sizeof(float) * static_cast<uint64_t>(sh_coefficients(degree)) +
         (storage == Storage::flat ? 0 : sizeof(uint8_t));
}

GaussianArrays gaussian_arrays(const Scene& scene) {
  return {scene.gaussians.data(),  scene.sh.data(),     scene.node_code.data(),
          scene.sh_degree,         scene.doubles,       footprints_differ(scene),
          scene.mean_codes.data(), scene.shapes.data(), shape_tables(),
          packed_sh(scene),        code_groups(scene),  scene.mean_grids.data()};
}

void make_gaussian_room(size_t gaussians, size_t groups, Scene& scene) {
  const bool coded = is_coded(scene);
  const size_t in_floats = coded ? 0 : gaussians, in_codes = coded ? gaussians : 0;
  fit(scene.gaussians, 0), fit(scene.sh, 0), fit(scene.node_code, 0);
  fit(scene.mean_codes, 0), fit(scene.shapes, 0), fit(scene.sh_rows, 0);
  fit(scene.sh_scales, 0), fit(scene.mean_grids, 0), fit(scene.group_blocks, 0);
  fit(scene.gaussians, in_floats);
  fit(scene.sh, in_floats * sh_floats(scene));
  fit(scene.node_code, scene.flat() ? 0 : in_floats);
  fit(scene.mean_codes, in_codes);
  fit(scene.shapes, in_codes);
  fit(scene.sh_rows, in_codes * sh_row_bytes(scene.sh_degree));
  fit(scene.sh_scales, coded ? groups : 0);
  fit(scene.mean_grids, coded ? groups : 0);
}

void set_gaussian(const Chunk& chunk, size_t i, size_t index, Scene& scene) {
  if (!is_coded(scene)) {
    const float* sh = chunk.sh.data() + i * sh_floats(scene);
    scene.gaussians[index] = activate(chunk.words[i], chunk.has_logit(i));
    scene.node_code[index] = chunk.node_code[i];
    std::copy_n(sh, sh_floats(scene), scene.sh.data() + index * sh_floats(scene));
    return;
  }
  scene.mean_codes[index] = chunk.mean_code[i];
  scene.shapes[index] = shape_code(chunk, i);
  put_row(chunk, i, scene.sh_degree, scene.sh_rows.data() + index * sh_row_bytes(scene.sh_degree));
}

void set_nothing(size_t index, Scene& scene) {
  if (!is_coded(scene)) {
    scene.gaussians[index] = activate({{0, 0, 0}, {0, 0, 0}, {1, 0, 0, 0}, 0.0f}, false);
    return;
  }
  scene.mean_codes[index] = {};
  scene.shapes[index] = {};
}

void copy_sh(const Scene& scene, size_t index, float* sh) {
  if (is_coded(scene)) {
    const PackedSh packed = packed_sh(scene);
    unpack_sh(packed.rows + index * sh_row_bytes(scene.sh_degree), scene.sh_degree,
              packed.scales[code_groups(scene)(static_cast<uint32_t>(index))], sh);
  } else {
    std::copy_n(scene.sh.data() + index * sh_floats(scene), sh_floats(scene), sh);
  }
}

void lower_sh_degree(int degree, Scene& scene) {
  if (degree >= scene.sh_degree) return;
  if (is_coded(scene))
    shorten_rows(scene.sh_degree, degree, scene.sh_rows);
  else
    change_sh_degree(scene.sh, scene.sh_degree, degree);
  scene.sh_degree = degree;
}

const ShapeTables& shape_tables() {
  struct Tables {
    std::vector<float> scale, leaf_opacity, log_opacity;
    ShapeTables view;

    Tables() : scale(kScaleCodes), leaf_opacity(kOpacityCodes), log_opacity(2 * kOpacityCodes) {
      for (size_t code = 0; code < kOpacityCodes; ++code) {
        const auto q = static_cast<uint16_t>(code);
        const float s = restore_log_scale(q);
        GaussianWords words{{0, 0, 0}, {s, s, s}, {1, 0, 0, 0}, restore_leaf_opacity(q)};
        const Gaussian leaf = activate(words, true);
        words.opacity = half_to_float(q);
        if (code < kScaleCodes) scale[code] = leaf.scale.x;
        leaf_opacity[code] = leaf.opacity;
        log_opacity[code] = activate(words, false).log_opacity;
        log_opacity[kOpacityCodes + code] = leaf.log_opacity;
      }
      view = {scale.data(), leaf_opacity.data(), log_opacity.data()};
    }
  };
  static const Tables tables;
  return tables.view;
}

}  // namespace voyager
