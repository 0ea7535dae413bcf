#include "tools/frame_files.h"

#include <fmt/core.h>

#include <bit>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "tools/image_file.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

void create_folder(const std::string& path) {
  if (path.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!std::filesystem::is_directory(path))
    throw Error(ErrorCode::io, fmt::format("{}: found something else, expected a folder ({})", path,
                                           error.message()));
}

std::string binary32_hex(float value) {
  return fmt::format("0x{:08x}", std::bit_cast<uint32_t>(value));
}

Json to_json(const VoyFrameStats& s) {
  Json ms;
  for (int stage = 0; stage < VOY_STAGE_COUNT; ++stage)
    ms[voyStageName(static_cast<VoyStage>(stage))] = s.milliseconds[stage];
  ms["total"] = s.millisecondsTotal;
  return {
      {"search", s.search == VOY_SEARCH_EXHAUSTIVE ? "exhaustive" : "none"},
      {"nodes_total", s.nodesTotal},
      {"nodes_tested", s.nodesTested},
      {"subtrees_visited", s.subtreesVisited},
      {"chunks_read", s.chunksRead},
      {"bytes_read", s.bytesRead},
      {"cut", s.cutSize},
      {"cut_centre",
       {binary32_hex(s.cutCentre[0]), binary32_hex(s.cutCentre[1]), binary32_hex(s.cutCentre[2])}},
      {"tau_star", binary32_hex(s.tauStar)},
      {"entered", s.entered},
      {"left", s.left},
      {"splats", s.splats},
      {"pairs_before", s.pairsBefore},
      {"pairs_after", s.pairsAfter},
      {"bytes_streamed", s.bytesStreamed},
      {"bytes_needed", s.bytesNeeded},
      {"missing", s.missing},
      {"ms", ms}};
}

}  // namespace

FrameFiles::FrameFiles(OutputPaths paths) : paths_(std::move(paths)) {
  if (!paths_.walk) return;
  create_folder(paths_.image);
  create_folder(paths_.depth);
  create_folder(paths_.cut);
}

std::string FrameFiles::place(const std::string& path, size_t index, const char* extension) const {
  return paths_.walk
             ? (std::filesystem::path(path) / fmt::format("{:04}{}", index, extension)).string()
             : path;
}

void FrameFiles::write(size_t index, const Camera& camera, const Renderer& renderer) {
  if (paths_.floats)
    write_pfm_rgb(place(paths_.image, index, ".pfm"), camera.width, camera.height,
                  renderer.rgba32f());
  else
    write_png(place(paths_.image, index, ".png"), camera.width, camera.height, renderer.rgba8());
  if (!paths_.depth.empty())
    write_pfm_grey(place(paths_.depth, index, ".pfm"), camera.width, camera.height,
                   renderer.depth());
  if (!paths_.cut.empty()) {
    std::string text;
    for (const uint32_t node : renderer.cut()) text += fmt::format("{}\n", node);
    write_text(place(paths_.cut, index, ".txt"), text);
  }
  if (!paths_.stats.empty()) frames_.push_back(to_json(renderer.stats()));
}

void FrameFiles::write_stats(const std::vector<VoySceneNote>& notes) {
  if (paths_.stats.empty()) return;
  Json omitted = Json::array();
  for (const VoySceneNote& note : notes)
    if (note.kind == VOY_SCENE_NOTE_OMITTED)
      omitted.push_back({{"what", note.what}, {"why", note.why}, {"bytes", note.bytes}});
  write_text(paths_.stats, Json{{"frames", frames_}, {"omitted", omitted}}.dump(2) + "\n");
}

}  // namespace voyager::tools
