#include "runtime/scene/import/gltf/spz_views.h"

#include <algorithm>
#include <cmath>

#include "runtime/scene/gltf_format.h"

namespace voyager::gltf {
namespace {

// The first is taken where several fit as well.
constexpr HalfTurn kWays[] = {kToInria, spz::kToInria, kNoTurn};

// Of what the numbers are in glTF's axes, if they become INRIA's by `way`.
double difference(const spz::Bounds& numbers, const HalfTurn& way, const spz::Bounds& said) {
  double most = 0;
  for (size_t k = 0; k < 3; ++k) {
    const bool kept = way.sign[k] == kToInria.sign[k];
    const double low = kept ? numbers.least[k] : -numbers.most[k];
    const double high = kept ? numbers.most[k] : -numbers.least[k];
    most = std::max({most, std::fabs(low - said.least[k]), std::fabs(high - said.most[k])});
  }
  return most;
}

// Writers may have taken bounds before the numbers were rounded, or rounded the bounds.
double tolerance(const spz::Header& header, const spz::Bounds& numbers) {
  double largest = 0;
  for (size_t k = 0; k < 3; ++k)
    largest = std::max({largest, std::fabs(numbers.least[k]), std::fabs(numbers.most[k])});
  return 1e-3 * largest + 2 * std::ldexp(1.0, -header.fractional_bits);
}

}  // namespace

Spz& SpzViews::open(File& file, const JsonValue& view, const std::string& place) {
  const Slice bytes = file.view(view);
  const auto [at, is_new] = known_.try_emplace({bytes.source.get(), bytes.offset});
  Spz& spz = at->second;
  if (!is_new) {
    if (spz.source->size() != bytes.size)
      view.refuse(std::to_string(bytes.size) + " bytes",
                  std::to_string(spz.source->size()) + ", as another view of the same SPZ has");
    return spz;
  }
  spz.source = source_of(bytes, file.name() + ": SPZ of " + place);
  const spz::Announcement found = spz::read_announcement(*spz.source);
  spz.header = found.header;
  spz.says_axes = found.extensions.says_axes;
  left_out_.add(spz::left_out_of(found));
  return spz;
}

std::optional<HalfTurn> axes_of(Spz& spz, const JsonValue* position) {
  if (spz.says_axes) return std::nullopt;
  if (!position || !position->has("min") || !position->has("max") || spz.header.count == 0)
    return kToInria;
  spz::Bounds said;
  (*position)["min"].numbers(said.least);
  (*position)["max"].numbers(said.most);
  if (!spz.bounds) spz.bounds = spz::bounds_of_positions(*spz.source);
  const auto off = [&](const HalfTurn& way) { return difference(*spz.bounds, way, said); };
  const HalfTurn* best =
      std::min_element(std::begin(kWays), std::end(kWays),
                       [&](const HalfTurn& a, const HalfTurn& b) { return off(a) < off(b); });
  return off(*best) <= tolerance(spz.header, *spz.bounds) ? *best : kToInria;
}

}  // namespace voyager::gltf
