#include "runtime/scene/append.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

void raise_degree(GaussianCloud& cloud, int degree) {
  if (cloud.sh_degree >= degree) return;
  change_sh_degree(cloud.sh, cloud.sh_degree, degree);
  cloud.sh_degree = degree;
}

void append(std::pmr::vector<float>& to, std::pmr::vector<float>& from) {
  to.reserve(to.size() + from.size());
  to.insert(to.end(), from.begin(), from.end());
  from = std::pmr::vector<float>(from.get_allocator());
}

}  // namespace

void require_alike(const std::array<double, 3>& origin, const NativeScale& native,
                   const std::array<double, 3>& more_origin, const NativeScale& more_native,
                   const std::string& more_name) {
  const auto text = [](const std::array<double, 3>& o) {
    return "(" + std::to_string(o[0]) + ", " + std::to_string(o[1]) + ", " + std::to_string(o[2]) +
           ")";
  };
  if (origin != more_origin)
    throw Error(ErrorCode::refused_input, more_name + ": origin: found " + text(more_origin) +
                                              ", expected the first input's " + text(origin) +
                                              ": with --transform inputs are joined wherever they "
                                              "are (\"scale 1\" leaves them in place)");
  const auto filter = [](const NativeScale& scale) {
    return scale.antialiased()
               ? "a compensated filter of " + std::to_string(scale.low_pass) + " square pixels"
               : std::string("3DGS's filter");
  };
  if (native != more_native)
    throw Error(ErrorCode::refused_input, more_name + ": trained with: found " +
                                              filter(more_native) + ", expected " + filter(native) +
                                              " as in the first input: convert each that has a "
                                              "compensated filter to a .glb, which leaves it out");
}

void add(ImportReport& sum, const ImportReport& more) {
  sum.read += more.read;
  sum.dropped_position += more.dropped_position;
  sum.dropped_scale += more.dropped_scale;
  sum.repaired_scale += more.repaired_scale;
  sum.repaired_rotation += more.repaired_rotation;
  sum.repaired_opacity += more.repaired_opacity;
  sum.dropped_opacity += more.dropped_opacity;
  sum.repaired_sh += more.repaired_sh;
}

void append(GaussianCloud& cloud, GaussianCloud&& more, const std::string& more_name) {
  require_alike(cloud.origin, cloud.native, more.origin, more.native, more_name);
  const int input_degree = std::max(cloud.input_sh_degree(), more.input_sh_degree());
  raise_degree(cloud, more.sh_degree);
  raise_degree(more, cloud.sh_degree);
  cloud.left_out_bands = input_degree - cloud.sh_degree;
  append(cloud.position, more.position);
  append(cloud.log_scale, more.log_scale);
  append(cloud.rotation, more.rotation);
  append(cloud.opacity, more.opacity);
  append(cloud.sh, more.sh);
  add(cloud.report, more.report);
}

}  // namespace voyager
