#include "runtime/frame/load.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager {
namespace {

constexpr uint32_t kLeastCoefficientBytes = 2;  // a device's binary16

// Of the bands above `kept` up to `stored`.
void add_sh_note(Scene& scene, int kept, int stored, const char* why) {
  if (kept >= stored) return;
  const auto missing = static_cast<uint32_t>(sh_coefficients(stored) - sh_coefficients(kept));
  const uint32_t of_splat = is_coded(scene) ? sh_row_bytes(stored) - sh_row_bytes(kept)
                                            : missing * 3 * kLeastCoefficientBytes;
  const uint64_t gaussians = std::max<uint64_t>(gaussian_count(scene), scene.node_count);
  const uint64_t each = gaussian_bytes(scene.storage, stored) - gaussian_bytes(scene.storage, kept);
  scene.notes.push_back({SceneNote::Kind::omitted, 0, gaussians * each,
                         "SH bands above degree " + std::to_string(kept), why, of_splat});
}

}  // namespace

void add_notes(Scene& scene) {
  using Kind = SceneNote::Kind;
  const auto note = [&](Kind kind, uint64_t count, const char* what, const char* why) {
    if (count != 0) scene.notes.push_back({kind, count, 0, what, why});
  };
  const ImportReport& r = scene.import;
  note(Kind::dropped, r.dropped_position, "Gaussians", "position not finite, or 1e18 m and beyond");
  note(Kind::dropped, r.dropped_scale, "Gaussians", "scale not a number or infinite");
  note(Kind::dropped, r.dropped_opacity, "Gaussians", "opacity not a number");
  note(Kind::repaired, r.repaired_scale, "scales", "outside 1e-9 m to 1e6 m: clamped");
  note(Kind::repaired, r.repaired_rotation, "rotations",
       "zero or not finite: replaced by the identity");
  note(Kind::repaired, r.repaired_opacity, "opacities", "infinite logit: clamped");
  note(Kind::repaired, r.repaired_sh, "SH coefficients", "not finite: set to 0");
  const int input = scene.profile.input_sh_degree;
  add_sh_note(scene, scene.sh_degree, input, "zero in every Gaussian; bytes are against the input");
  add_sh_note(scene, input, kMaxShDegree, "the input has none; bytes are against degree 3");
}

}  // namespace voyager
