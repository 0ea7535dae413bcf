#include "tools/frame_files.h"

#include <fmt/core.h>

#include <bit>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/base/output_path.h"
#include "tools/image_file.h"
#include "tools/output_paths.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

std::string frame_name(size_t index, const char* extension) {
  return fmt::format("{:04}{}", index, extension);
}

std::string binary32_hex(float value) {
  return fmt::format("0x{:08x}", std::bit_cast<uint32_t>(value));
}

const char* name_of(VoySearch search) {
  switch (search) {
    case VOY_SEARCH_EXHAUSTIVE:
      return "exhaustive";
    case VOY_SEARCH_STREAMING:
      return "streaming";
    case VOY_SEARCH_TEMPORAL:
    case VOY_SEARCH_TEMPORAL_VISIT:
      return "temporal";
    case VOY_SEARCH_SWEEP:
      return "sweep";
    default:
      return "none";
  }
}

const char* name_of(VoyTimeBudgetState state) {
  switch (state) {
    case VOY_TIME_BUDGET_STATE_HELD:
      return "held";
    case VOY_TIME_BUDGET_STATE_LATE:
      return "late";
    case VOY_TIME_BUDGET_STATE_UNREACHABLE:
      return "unreachable";
    default:
      return "none";
  }
}

Json to_json(const VoyFrameStats& s, VoySearch search) {
  Json ms;
  for (uint32_t stage = 0; stage < s.stageCount; ++stage)
    ms[voyStageName(static_cast<VoyStage>(stage))] = s.milliseconds[stage];
  ms["total"] = s.millisecondsTotal;
  return {
      {"search", name_of(search)},
      {"nodes_total", s.nodesTotal},
      {"nodes_tested", s.nodesTested},
      {"subtrees_visited", s.subtreesVisited},
      {"chunks_read", s.chunksRead},
      {"bytes_read", s.bytesRead},
      {"cut", s.cutSize},
      {"cut_centre",
       {binary32_hex(s.cutCenter[0]), binary32_hex(s.cutCenter[1]), binary32_hex(s.cutCenter[2])}},
      {"tau_star", binary32_hex(s.tauStar)},
      {"tau", s.tau},
      {"time_budget", s.millisecondsBudget > 0 ? Json(s.millisecondsBudget) : Json()},
      {"budget", name_of(s.timeBudgetState)},
      {"entered", s.nodesEntered},
      {"left", s.nodesExited},
      {"splats", s.splats},
      {"pairs_before", s.pairsBeforeFilter},
      {"pairs_after", s.pairsAfterFilter},
      {"pairs_dropped", s.pairsDropped},
      {"bytes_streamed", s.bytesStreamed},
      {"bytes_needed", s.bytesNeeded},
      {"missing", s.nodesUnrefined},
      {"ms", ms}};
}

}  // namespace

FrameFiles::Output FrameFiles::open(const std::string& path, bool folder,
                                    const OtherFiles& others) {
  if (!path.empty() && !folder) require_writable(path);
  if (path.empty() || !folder) return {path, nullptr};
  return {"", std::make_unique<OutputFolder>(path, others.inputs, others.outputs)};
}

FrameFiles::FrameFiles(OutputPaths paths, std::vector<std::string> inputs)
    : floats_(paths.floats), stats_(std::move(paths.stats)) {
  OtherFiles others = {std::move(inputs), {stats_}};
  if (!paths.cuts_in) others.outputs.push_back(paths.cut);
  image_ = open(paths.image, paths.images_in, others);
  depth_ = open(paths.depth, paths.images_in, others);
  cut_ = open(paths.cut, paths.cuts_in, others);
  open(stats_, false, {});
}

std::string FrameFiles::Output::place(size_t index, const char* extension) const {
  return folder ? folder->place(frame_name(index, extension)) : file;
}

void FrameFiles::Output::expect(size_t index, const char* extension) const {
  if (folder) folder->require_place(frame_name(index, extension));
}

std::vector<Room> FrameFiles::Output::room(uint64_t bytes, const char* what) const {
  if (!wanted()) return {};
  return {{folder ? (folder->path() / "").string() : file, bytes, what}};
}

void FrameFiles::expect(size_t first, std::span<const Camera> cameras, size_t eyes) const {
  uint64_t pixels = 0;
  for (size_t i = 0; i < cameras.size(); ++i) {
    image_.expect(first + i, image_extension());
    depth_.expect(first + i, ".pfm");
    if (i % eyes == 0) cut_.expect((first + i) / eyes, ".txt");
    pixels += uint64_t{cameras[i].width} * cameras[i].height;
  }
  std::vector<Room> files = depth_.room(pixels * sizeof(float), "depths");
  if (floats_)  // how small a .png is nobody knows
    for (Room& images : image_.room(pixels * 3 * sizeof(float), "images"))
      files.push_back(std::move(images));
  require_room(files);
}

void FrameFiles::write_image(size_t index, const Camera& camera, const RenderedImage& image) {
  const uint32_t width = camera.width, height = camera.height;
  const std::string path = image_.place(index, image_extension());
  if (floats_)
    write_pfm_rgb(path, width, height, image.rgba32f);
  else
    write_png(path, width, height, image.rgba8);
  if (depth_.wanted()) write_pfm_grey(depth_.place(index, ".pfm"), width, height, image.depth);
}

void FrameFiles::write(size_t first, std::span<const Camera> cameras, const Renderer& renderer) {
  for (size_t eye = 0; eye < cameras.size(); ++eye)
    write_image(first + eye, cameras[eye], renderer.image(eye));
  if (cut_.wanted()) {
    std::string text;
    for (const uint32_t node : renderer.cut()) text += fmt::format("{}\n", node);
    write_text(cut_.place(first / cameras.size(), ".txt"), text);
  }
  if (!stats_.empty()) frames_.push_back(to_json(renderer.stats(), renderer.search()));
}

void FrameFiles::finish(const Renderer& renderer) {
  for (const Output* output : {&image_, &depth_, &cut_})
    if (output->folder) output->folder->commit();
  if (!stats_.empty()) write_stats(renderer);
}

void FrameFiles::write_stats(const Renderer& renderer) const {
  Json omitted = Json::array();
  for (const VoyOmission& o : renderer.omissions())
    omitted.push_back({{"what", o.what},
                       {"why", o.why},
                       {"bytes", o.bytes},
                       {"ms", o.milliseconds > 0 ? Json(o.milliseconds) : Json()}});
  const Json stats = {
      {"device", renderer.device_name()}, {"frames", frames_}, {"omitted", omitted}};
  write_text(stats_, stats.dump(2) + "\n");
}

}  // namespace voyager::tools
