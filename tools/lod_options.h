#pragma once
#include <optional>
#include <string>

#include "runtime/select/detail.h"

namespace CLI {
class App;
}

namespace voyager::tools {

// "--lod on|off" and "--select cut|flat|blocks|levels": what is drawn of a tree. off and flat are
// the same.
struct LodChoice {
  std::optional<bool> on;
  std::optional<Lod> select;

  bool given() const { return on || select; }
  // Throws Error(invalid_argument) where the two contradict one another.
  Lod value() const;
  // Throws Error(invalid_argument) where one asks for detail of a scene that has no tree to
  // choose it from. That it is drawn flat where none is given needs no asking.
  void refuse_without_tree(const std::string& scene) const;
};

void add_lod_options(CLI::App& command, LodChoice& choice);

const char* select_name(Lod lod);

}  // namespace voyager::tools
