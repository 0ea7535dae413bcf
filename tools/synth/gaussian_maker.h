#pragma once
// Turns surfaces into Gaussians. Two thirds tile a surface, a cell each, so
// that it is closed; the rest are the fainter, longer ones that training
// leaves over them. The light of one sun and a sky is baked in; mirrored sky
// and sun are in the higher bands of the spherical harmonics.
#include <functional>

#include "runtime/scene/gaussian_cloud.h"
#include "tools/synth/layout.h"
#include "tools/synth/random.h"
#include "tools/synth/surface.h"

namespace voyager::synth {

class GaussianMaker {
 public:
  using Emit = std::function<void(const GaussianCloud&)>;
  static constexpr size_t kBatch = 65536;

  // All three must outlive the maker.
  GaussianMaker(const Layout& layout, int sh_degree, const Emit& emit);

  // Exactly `count` Gaussians on the surface; a function of these arguments alone.
  void fill(const Surface& surface, uint64_t count, uint64_t seed);
  // Emits what is left.
  void flush();

 private:
  struct Mark;  // one Gaussian before it is lit

  void tile(const Surface& surface, uint64_t count, Random& random);
  void scatter(const Surface& surface, uint64_t count, uint64_t of, Random& random);
  void fill_crown(const Surface& crown, uint64_t count, Random& random);
  void append(const Surface& surface, const Mark& mark, Random& random);
  void append_colour(const Surface& surface, const Mark& mark, Random& random);

  const Layout& layout_;
  const Emit& emit_;
  GaussianCloud batch_;
};

}  // namespace voyager::synth
