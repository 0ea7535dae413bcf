#include "runtime/scene/sh_bands.h"

#include <algorithm>
#include <bit>

namespace voyager {
namespace {

size_t floats_of(int degree) {
  return 3 * static_cast<size_t>(sh_coefficients(degree));
}

// One band, of any Gaussian.
template <class Uses>
bool uses_band(std::span<const float> sh, size_t floats, int band, const Uses& uses) {
  const size_t first = floats_of(band - 1), end = floats_of(band);
  for (size_t at = 0; at < sh.size(); at += floats)
    for (size_t i = first; i < end; ++i)
      if (uses(sh[at + i])) return true;
  return false;
}

template <class Uses>
int highest_band(std::span<const float> sh, int degree, const Uses& uses) {
  int used = degree;
  while (used > 0 && !uses_band(sh, floats_of(degree), used, uses)) --used;
  return used;
}

template <class Floats>
void change_degree(Floats& sh, int from, int to) {
  if (from == to) return;
  const size_t before = floats_of(from), after = floats_of(to), common = std::min(before, after);
  const size_t count = sh.size() / before;
  Floats changed(count * after, 0.0f, sh.get_allocator());
  for (size_t i = 0; i < count; ++i)
    std::copy_n(sh.data() + i * before, common, changed.data() + i * after);
  sh = std::move(changed);
}

}  // namespace

int used_sh_degree(std::span<const float> sh, int degree) {
  return highest_band(sh, degree, [](float x) { return x != 0.0f; });
}

int stored_sh_degree(std::span<const float> sh, int degree) {
  return highest_band(sh, degree, [](float x) { return std::bit_cast<uint32_t>(x) != 0; });
}

void change_sh_degree(std::vector<float>& sh, int from, int to) {
  change_degree(sh, from, to);
}

void change_sh_degree(std::pmr::vector<float>& sh, int from, int to) {
  change_degree(sh, from, to);
}

void leave_out_zero_bands(GaussianCloud& cloud) {
  const int used = used_sh_degree(cloud.sh, cloud.sh_degree);
  change_sh_degree(cloud.sh, cloud.sh_degree, used);
  cloud.left_out_bands += cloud.sh_degree - used;
  cloud.sh_degree = used;
}

void put_back_zero_bands(GaussianCloud& cloud) {
  const int degree = cloud.input_sh_degree();
  change_sh_degree(cloud.sh, cloud.sh_degree, degree);
  cloud.sh_degree = degree;
  cloud.left_out_bands = 0;
}

}  // namespace voyager
