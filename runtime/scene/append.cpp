#include "runtime/scene/append.h"

#include <algorithm>

#include "runtime/base/error.h"

namespace voyager {
namespace {

void require_alike(const GaussianCloud& cloud, const GaussianCloud& more, const std::string& name) {
  const auto text = [](const std::array<double, 3>& origin) {
    return "(" + std::to_string(origin[0]) + ", " + std::to_string(origin[1]) + ", " +
           std::to_string(origin[2]) + ")";
  };
  if (cloud.origin != more.origin)
    throw Error(ErrorCode::refused_input, name + ": origin: found " + text(more.origin) +
                                              ", expected the first input's " + text(cloud.origin));
  if (cloud.antialiased != more.antialiased)
    throw Error(ErrorCode::refused_input, name + ": antialiased: found " +
                                              (more.antialiased ? "yes" : "no") +
                                              ", expected what the first input has");
}

// [k][rgb] with more bands, the new ones zero.
void raise_degree(GaussianCloud& cloud, int degree) {
  if (cloud.sh_degree >= degree) return;
  const size_t from = 3 * static_cast<size_t>(cloud.coefficients());
  const size_t to = 3 * static_cast<size_t>(sh_coefficients(degree));
  std::pmr::vector<float> sh(cloud.size() * to, 0.0f, cloud.sh.get_allocator());
  for (size_t i = 0; i < cloud.size(); ++i)
    std::copy_n(cloud.sh.data() + i * from, from, sh.data() + i * to);
  cloud.sh = std::move(sh);
  cloud.sh_degree = degree;
}

void append(std::pmr::vector<float>& to, std::pmr::vector<float>& from) {
  to.reserve(to.size() + from.size());
  to.insert(to.end(), from.begin(), from.end());
  from = std::pmr::vector<float>(from.get_allocator());
}

}  // namespace

void append(GaussianCloud& cloud, GaussianCloud&& more, const std::string& more_name) {
  require_alike(cloud, more, more_name);
  raise_degree(cloud, more.sh_degree);
  raise_degree(more, cloud.sh_degree);
  append(cloud.position, more.position);
  append(cloud.log_scale, more.log_scale);
  append(cloud.rotation, more.rotation);
  append(cloud.opacity, more.opacity);
  append(cloud.sh, more.sh);
  ImportReport& sum = cloud.report;
  sum.read += more.report.read;
  sum.dropped_position += more.report.dropped_position;
  sum.dropped_scale += more.report.dropped_scale;
  sum.repaired_scale += more.report.repaired_scale;
  sum.repaired_rotation += more.report.repaired_rotation;
  sum.repaired_opacity += more.report.repaired_opacity;
  sum.dropped_opacity += more.report.dropped_opacity;
  sum.repaired_sh += more.report.repaired_sh;
}

}  // namespace voyager
