#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "runtime/base/open_source.h"
#include "runtime/base/url.h"
#include "runtime/format/reader.h"
#include "runtime/scene/import/format_name.h"
#include "tools/byte_size.h"
#include "tools/commands/commands.h"
#include "tools/options.h"
#include "tools/progress_bar.h"
#include "voyager/voyager.hpp"

namespace voyager::tools {
namespace {

constexpr const char* kStorageNames[] = {"flat", "lossless", "compact"};
constexpr const char* kNativeSources[] = {"unknown", "given", "training cameras", "file",
                                          "estimated"};
constexpr const char* kNoteKinds[] = {"omitted", "repaired", "dropped", "damaged"};

// What only the file says: how the tree was built (docs/lod-tree.md) and how it is cut up. Zeros
// and no rule for a flat scene, which has a format in its place.
struct TreeFacts {
  const char* rule = nullptr;
  std::string format;
  uint32_t subtrees = 0, tiers = 0, chunk_bytes = 0;
  double least_pixel = 0;  // the native one, metres
};

TreeFacts tree_facts(const std::string& path, const VoySceneInfo& info) {
  if (info.storage == VOY_SCENE_STORAGE_FLAT)
    return {.format = format_name(*open_source(path)), .least_pixel = info.nativePixel};
  const SceneFile file(open_source(path));
  const NativeScale& native = file.info().native;
  return {file.info().kept_tree                     ? "hier"
          : file.info().tree == TreeKind::clustered ? "clustered"
                                                    : "hierarchicalgs",
          {},
          file.info().subtree_count,
          file.tiers().tier_count(),
          file.info().chunk_bytes,
          native.pixel_of(native.levels - 1)};
}

void print_profile(const VoySceneInfo& info, const VoySceneProfile& profile) {
  fmt::print("  SH degree     {}{}\n", info.shDegree,
             profile.inputShDegree == info.shDegree
                 ? ""
                 : fmt::format(" of the input's {}: the bands above are zero everywhere",
                               profile.inputShDegree));
  if (profile.complete && info.chunkCount != 0)
    fmt::print("  SH in chunks  {} of degree 0, {} of 1, {} of 2, {} of 3\n",
               profile.chunksByShDegree[0], profile.chunksByShDegree[1],
               profile.chunksByShDegree[2], profile.chunksByShDegree[3]);
  fmt::print("  merged        {}; {}\n", profile.merged ? "yes" : "no",
             profile.interpolated ? "cuts are interpolated" : "nothing to interpolate");
  fmt::print("  opacities     {} above 1\n", profile.opacitiesAboveOne);
  fmt::print("  anisotropy    {:.4g} to {:.4g}\n", profile.minAnisotropy, profile.maxAnisotropy);
}

// METHOD §12: at what size the scene was seen in training, and where that is known from.
std::string native_text(const VoySceneInfo& info, double least_pixel) {
  switch (info.nativePixelSource) {
    case VOY_NATIVE_PIXEL_SOURCE_FILE:
      return fmt::format("none: trained with a compensated filter of {:.3g} square pixels",
                         info.pixelFilter);
    case VOY_NATIVE_PIXEL_SOURCE_UNKNOWN:
      return "unknown: drawn as 3DGS does. Bake the scene again";
    default:
      return fmt::format(
          "{}{:.4g} m, {}",
          least_pixel < info.nativePixel ? fmt::format("{:.4g} to ", least_pixel) : "",
          info.nativePixel, kNativeSources[info.nativePixelSource]);
  }
}

void print_text(const std::string& path, const VoySceneInfo& info, const VoySceneProfile& profile,
                const TreeFacts& tree, const std::vector<VoySceneNote>& notes) {
  fmt::print("{}: {} scene\n", path, kStorageNames[info.storage]);
  fmt::print("  Gaussians     {}\n", info.gaussianCount);
  if (!tree.format.empty()) fmt::print("  format        {}\n", tree.format);
  if (tree.rule != nullptr) fmt::print("  tree          {}\n", tree.rule);
  if (info.storage != VOY_SCENE_STORAGE_FLAT)
    fmt::print("  nodes         {} in {} levels, {} chunks ({} damaged)\n", info.nodeCount,
               info.treeDepth, info.chunkCount, info.damagedChunkCount);
  if (info.storage != VOY_SCENE_STORAGE_FLAT)
    fmt::print("  subtrees      {} in {} tiers, chunks of up to {} bytes of records\n",
               tree.subtrees, tree.tiers, tree.chunk_bytes);
  print_profile(info, profile);
  fmt::print("  native pixel  {}\n", native_text(info, tree.least_pixel));
  fmt::print("  origin        {} {} {} m\n", info.origin[0], info.origin[1], info.origin[2]);
  fmt::print("  bounds        {:.3f} {:.3f} {:.3f} to {:.3f} {:.3f} {:.3f} m\n", info.boundsMin[0],
             info.boundsMin[1], info.boundsMin[2], info.boundsMax[0], info.boundsMax[1],
             info.boundsMax[2]);
  if (info.storage == VOY_SCENE_STORAGE_COMPACT)
    fmt::print("  mean error    {:.3g} m at most\n", info.maxPositionError);
  fmt::print("  in memory     {}\n", size_text(info.residentBytes));
  fmt::print("  import        {} Gaussians dropped, {} repaired\n", info.droppedGaussianCount,
             info.repairCount);
  for (const VoySceneNote& note : notes)
    fmt::print("  {:<13} {}: {} ({})\n", kNoteKinds[note.kind], note.what, note.why,
               note.kind == VOY_SCENE_NOTE_KIND_OMITTED ? size_text(note.bytes)
                                                        : fmt::format("{}", note.count));
}

nlohmann::ordered_json to_json(const VoySceneProfile& profile) {
  return {{"input_sh_degree", profile.inputShDegree},
          {"chunks_by_sh_degree", profile.chunksByShDegree},
          {"merged", profile.merged != 0},
          {"interpolated", profile.interpolated != 0},
          {"streamed", profile.streamed != 0},
          {"opacities_above_one", profile.opacitiesAboveOne},
          {"anisotropy", {profile.minAnisotropy, profile.maxAnisotropy}}};
}

void print_json(const std::string& path, const VoySceneInfo& info, const VoySceneProfile& profile,
                const TreeFacts& tree, const std::vector<VoySceneNote>& notes) {
  nlohmann::ordered_json json = {
      {"file", path},
      {"storage", kStorageNames[info.storage]},
      {"format",
       tree.format.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(tree.format)},
      {"gaussians", info.gaussianCount},
      {"tree", tree.rule == nullptr ? nlohmann::ordered_json() : nlohmann::ordered_json(tree.rule)},
      {"nodes", info.nodeCount},
      {"tree_depth", info.treeDepth},
      {"chunks", info.chunkCount},
      {"damaged_chunks", info.damagedChunkCount},
      {"subtrees", tree.subtrees},
      {"tiers", tree.tiers},
      {"chunk_bytes", tree.chunk_bytes},
      {"sh_degree", info.shDegree},
      {"antialiased", info.trainedAntialiased != 0},
      {"native_pixel", info.nativePixel},
      {"least_native_pixel", tree.least_pixel},
      {"native_source", kNativeSources[info.nativePixelSource]},
      {"low_pass", info.pixelFilter},
      {"origin", info.origin},
      {"bounds_min", info.boundsMin},
      {"bounds_max", info.boundsMax},
      {"position_error", info.maxPositionError},
      {"resident_bytes", info.residentBytes},
      {"dropped", info.droppedGaussianCount},
      {"repaired", info.repairCount},
      {"profile", to_json(profile)},
      {"notes", nlohmann::json::array()}};
  for (const VoySceneNote& note : notes)
    json["notes"].push_back({{"kind", kNoteKinds[note.kind]},
                             {"what", note.what},
                             {"why", note.why},
                             {"count", note.count},
                             {"bytes", note.bytes}});
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

void add_info(CLI::App& app) {
  auto path = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("info", "Show what a scene holds, what was repaired and what is left out");
  command
      ->add_option("file", *path, "Scene to read, a .voy or a flat one of any format, or its URL")
      ->required();
  command->add_flag("--json", *json, "Print JSON, for programs; sizes are in bytes");
  name_group(*command, kCommonOptions);
  command->footer("Example: voyager info city.voy");
  command->callback([path, json] {
    const Progress progress = progress_bar();
    progress("opening", 0, 0);
    VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
    desc.backend = VOY_BACKEND_CPU;  // nothing is drawn
    const voy::Device device = voy::Device::create(desc);
    const voy::Scene scene = device.open_scene(*path);
    const VoySceneInfo info = scene.info();
    const TreeFacts facts = tree_facts(*path, info);
    progress("opening", 1, 1);
    (*json ? print_json : print_text)(shown_path(*path), info, scene.profile(), facts,
                                      scene.notes());
  });
}

}  // namespace voyager::tools
