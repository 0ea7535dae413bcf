#include "runtime/frame/scene_sh.h"

#include <algorithm>

#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

size_t floats_of(const Scene& scene) {
  return 3 * static_cast<size_t>(scene.coefficients());
}

template <class Array>
void fit(Array& array, size_t size) {
  Array(size, array.get_allocator()).swap(array);
}

// The first bytes of a row are those of a lower degree.
void shorten_rows(size_t from, size_t to, std::pmr::vector<uint8_t>& rows) {
  const size_t count = rows.size() / from;
  std::pmr::vector<uint8_t> shorter(count * to, rows.get_allocator());
  for (size_t i = 0; i < count; ++i)
    std::copy_n(rows.data() + i * from, to, shorter.data() + i * to);
  shorter.swap(rows);
}

}  // namespace

size_t sh_bytes(Storage storage, int degree) {
  return packs_sh(storage, degree)
             ? sh_row_bytes(degree)
             : 3 * sizeof(float) * static_cast<size_t>(sh_coefficients(degree));
}

void make_sh_room(size_t gaussians, size_t groups, Scene& scene) {
  const bool packs = packs_sh(scene);
  fit(scene.sh, 0), fit(scene.sh_rows, 0), fit(scene.sh_scales, 0);
  fit(scene.sh, packs ? 0 : gaussians * floats_of(scene));
  fit(scene.sh_rows, packs ? gaussians * sh_row_bytes(scene.sh_degree) : 0);
  fit(scene.sh_scales, packs ? groups : 0);
}

void set_sh_scales(size_t group, const ShScales& scales, Scene& scene) {
  if (!scene.sh_scales.empty()) scene.sh_scales[group] = scales;
}

void set_sh(size_t index, size_t group, const float* sh, Scene& scene) {
  if (!packs_sh(scene)) {
    std::copy_n(sh, floats_of(scene), scene.sh.data() + index * floats_of(scene));
    return;
  }
  pack_sh(sh, scene.sh_degree, static_cast<uint32_t>(group), scene.sh_scales[group],
          scene.sh_rows.data() + index * sh_row_bytes(scene.sh_degree));
}

void copy_sh(const Scene& scene, size_t index, float* sh) {
  if (packs_sh(scene))
    unpack_sh(scene.sh_rows.data() + index * sh_row_bytes(scene.sh_degree), scene.sh_degree,
              scene.sh_scales.data(), sh);
  else
    std::copy_n(scene.sh.data() + index * floats_of(scene), floats_of(scene), sh);
}

void lower_sh_degree(int degree, Scene& scene) {
  if (degree >= scene.sh_degree) return;
  if (!packs_sh(scene)) {
    change_sh_degree(scene.sh, scene.sh_degree, degree);
    scene.sh_degree = degree;
    return;
  }
  const size_t row = sh_row_bytes(scene.sh_degree), count = scene.sh_rows.size() / row;
  if (degree > 0) {
    shorten_rows(row, sh_row_bytes(degree), scene.sh_rows);
    scene.sh_degree = degree;
    return;
  }
  std::pmr::vector<float> constants(3 * count, scene.sh.get_allocator());
  for (size_t i = 0; i < count; ++i)
    unpack_sh(scene.sh_rows.data() + i * row, 0, scene.sh_scales.data(), &constants[3 * i]);
  scene.sh.swap(constants);
  fit(scene.sh_rows, 0), fit(scene.sh_scales, 0);
  scene.sh_degree = 0;
}

}  // namespace voyager
