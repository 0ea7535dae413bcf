#pragma once
// A primitive with KHR_gaussian_splatting: where its numbers are.
#include <optional>

#include "runtime/math/half_turn.h"
#include "runtime/scene/import/gltf/accessor.h"
#include "runtime/scene/import/gltf/spz_views.h"
#include "runtime/scene/native_scale.h"

namespace voyager::gltf {

enum class Parameter { position, rotation, scale, opacity, sh, colour, colour_opacity };

struct Attribute {
  Parameter parameter;
  size_t k;  // sh: the coefficient
  Accessor accessor;
};

struct Primitive {
  std::string place;  // as a message names it
  uint64_t count = 0;
  int sh_degree = 0;
  NativeScale native;
  bool linear_colours = false;        // lin_rec709_display; any other colour space is taken as sRGB
  bool log_scales = false;            // as drafts of the extension had them
  std::vector<Attribute> attributes;  // without SPZ
  std::shared_ptr<const ByteSource> spz;  // a whole file, or null
  std::optional<HalfTurn> spz_to_inria;   // of its numbers; else it says its axes itself
};

// Nothing where the primitive has no splats. Throws Error(refused_input) for an attribute that is
// missing or of a type that the extension does not allow, and where counts differ.
std::optional<Primitive> read_primitive(File& file, SpzViews& views, const JsonValue& json);

// Scales of the ratified extension are linear and not negative; those of its drafts were
// logarithms. True where one of the first Gaussians of the primitives has a negative scale, or all
// scales are 0: no length, but the logarithm of one.
bool have_log_scales(const std::vector<Primitive>& primitives);

}  // namespace voyager::gltf
