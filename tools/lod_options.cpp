#include "tools/lod_options.h"

#include "runtime/base/error.h"
#include "tools/options.h"

namespace voyager::tools {

Lod LodChoice::value() const {
  if (!on) return select.value_or(Lod::cut);
  const Lod chosen = select.value_or(*on ? Lod::cut : Lod::all_leaves);
  if (*on != draws_cut(chosen))
    throw Error(ErrorCode::invalid_argument,
                std::string("--select: found ") + select_name(chosen) + " with --lod " +
                    (*on ? "on, expected cut, blocks or levels" : "off, expected flat"));
  return chosen;
}

void LodChoice::refuse_without_tree(const std::string& scene) const {
  if (!given() || !draws_cut(value())) return;
  throw Error(ErrorCode::invalid_argument,
              std::string(select ? "--select: found " : "--lod: found ") +
                  (select ? select_name(*select) : "on") + " for " + scene +
                  ", which has no tree, expected " + (select ? "flat" : "off") + " or a .voy");
}

void add_lod_options(CLI::App& command, LodChoice& choice) {
  add_choice<std::optional<bool>>(command, "--lod", choice.on, {{"on", true}, {"off", false}},
                                  "off draws every leaf, the finest detail");
  add_choice<std::optional<Lod>>(command, "--select", choice.select,
                                 {{"cut", Lod::cut},
                                  {"flat", Lod::all_leaves},
                                  {"blocks", Lod::blocks},
                                  {"levels", Lod::levels}},
                                 "How the level of detail is chosen. cut: by each node's size on "
                                 "the screen. flat: every leaf, as 3DGS. blocks: by the distance "
                                 "of a block, as CityGaussian. levels: by the distance of a level, "
                                 "as Octree-GS. All but cut are for comparison");
}

const char* select_name(Lod lod) {
  switch (lod) {
    case Lod::all_leaves:
      return "flat";
    case Lod::blocks:
      return "blocks";
    case Lod::levels:
      return "levels";
    case Lod::cut:
      break;
  }
  return "cut";
}

}  // namespace voyager::tools
