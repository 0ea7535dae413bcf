#include "runtime/scene/export/flat_file.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/error.h"
#include "runtime/base/output_path.h"
#include "runtime/scene/append.h"

namespace voyager {
namespace {

struct Ending {
  const char* text;
  FlatFormat format;
};
constexpr Ending kEndings[] = {
    {".ply", FlatFormat::ply},
    {".spz", FlatFormat::spz},
};

FlatFormat required_format(const std::string& path) {
  if (const auto format = flat_format_of(path)) return *format;
  std::string known;
  for (const Ending& ending : kEndings)
    known += std::string(known.empty() ? "" : " or ") + ending.text;
  throw Error(ErrorCode::invalid_argument,
              "output: found " + path + ", expected a name that ends in " + known);
}

bool is_moved(const FlatContents& contents) {
  return contents.origin != std::array<double, 3>{0, 0, 0};
}

uint64_t least_bytes(FlatFormat format, const FlatContents& contents) {
  switch (format) {
    case FlatFormat::ply:
      return ply_bytes(contents.count, contents.sh_degree, is_moved(contents));
    case FlatFormat::spz:
      break;
  }
  return 0;
}

std::unique_ptr<GaussianWriter> write_flat(PlacedSink& sink, FlatFormat format,
                                           const FlatContents& contents) {
  switch (format) {
    case FlatFormat::ply:
      return write_ply(sink, contents.count, contents.sh_degree, is_moved(contents),
                       contents.native);
    case FlatFormat::spz:
      break;
  }
  return write_spz(sink, contents.count, contents.sh_degree,
                   static_cast<float>(contents.largest_coordinate));
}

}  // namespace

std::optional<FlatFormat> flat_format_of(const std::string& path) {
  for (const Ending& ending : kEndings)
    if (path.ends_with(ending.text)) return ending.format;
  return std::nullopt;
}

std::vector<std::string> flat_format_endings() {
  std::vector<std::string> endings;
  for (const Ending& ending : kEndings) endings.push_back(ending.text);
  return endings;
}

void FlatContents::add(const GaussianCloud& batch) {
  voyager::add(report, batch.report);
  if (count == 0) origin = batch.origin;
  count += batch.size();
  for (size_t i = 0; i < batch.position.size(); ++i)
    largest_coordinate =
        std::max(largest_coordinate,
                 std::fabs(batch.origin[i % 3] + static_cast<double>(batch.position[i])));
}

std::vector<std::string> losses(FlatFormat format, const FlatContents& contents) {
  std::vector<std::string> lost;
  if (format == FlatFormat::spz && contents.native.antialiased() &&
      contents.native.low_pass == kMipSplattingLowPass)
    lost.push_back(
        "the filter of the training is read as 3DGS's: a .spz cannot tell Mip-Splatting's");
  return lost;
}

void require_flat_file(const std::string& path, const FlatContents& contents) {
  const FlatFormat format = required_format(path);
  const AtomicFile nothing(path);
  require_room(path, least_bytes(format, contents));
}

void write_flat_file(const std::string& path, const FlatContents& contents,
                     const std::function<void(GaussianWriter&)>& fill) {
  const FlatFormat format = required_format(path);
  AtomicFile file(path);
  require_room(path, least_bytes(format, contents));
  const std::unique_ptr<PlacedSink> sink = sink_to(file);
  const std::unique_ptr<GaussianWriter> writer = write_flat(*sink, format, contents);
  fill(*writer);
  writer->finish();
  file.commit();
}

}  // namespace voyager
