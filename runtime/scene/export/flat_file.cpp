#include "runtime/scene/export/flat_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/error.h"
#include "runtime/base/name_ending.h"
#include "runtime/base/output_path.h"
#include "runtime/scene/append.h"
#include "runtime/scene/export/value_range.h"

namespace voyager {
namespace {

struct Ending {
  const char* text;
  FlatFormat format;
};
// The first that fits counts.
constexpr Ending kEndings[] = {
    {".compressed.ply", FlatFormat::compressed_ply},
    {".ply", FlatFormat::ply},
    {".spz", FlatFormat::spz},
    {".splat", FlatFormat::splat},
    {".glb", FlatFormat::glb},
    {".sog", FlatFormat::sog},
};

FlatFormat required_format(const std::string& path) {
  if (const auto format = flat_format_of(path)) return *format;
  std::string known;
  for (const Ending& ending : kEndings)
    known += std::string(known.empty() ? "" : " or ") + ending.text;
  throw Error(ErrorCode::invalid_argument,
              "output: found " + path + ", expected a name that ends in " + known);
}

// 0 where nobody knows. Throws as require_sog().
uint64_t least_bytes(FlatFormat format, const FlatOptions& options, const FlatContents& contents) {
  switch (format) {
    case FlatFormat::ply:
      return ply_bytes(contents.count, contents.sh_degree, contents.is_moved());
    case FlatFormat::compressed_ply:
      return compressed_ply_bytes(contents.count, contents.sh_degree);
    case FlatFormat::splat:
      return contents.count * kSplatBytes;
    case FlatFormat::glb:
      return options.spz_inside ? 0 : glb_bytes(contents.count, contents.sh_degree);
    case FlatFormat::sog:
      require_sog();
      break;
    case FlatFormat::spz:
      break;
  }
  return 0;
}

std::unique_ptr<GaussianWriter> write_flat(PlacedSink& sink, FlatFormat format,
                                           const FlatOptions& options,
                                           const FlatContents& contents) {
  const uint64_t count = contents.count;
  const int degree = contents.sh_degree;
  switch (format) {
    case FlatFormat::ply:
      return write_ply(sink, count, degree, contents.is_moved(), contents.native);
    case FlatFormat::compressed_ply:
      return write_compressed_ply(sink, count, degree, contents.native);
    case FlatFormat::splat:
      return write_splat(sink, count, degree);
    case FlatFormat::glb:
      if (options.spz_inside)
        return write_spz_glb(sink, count, degree, contents.reach_from_origin(),
                             options.spz_version);
      return write_glb(sink, count, degree);
    case FlatFormat::sog:
      return write_sog(sink, count, degree, contents.native);
    case FlatFormat::spz:
      break;
  }
  return write_spz(sink, count, degree, contents.reach(), options.spz_version);
}

float rounded_up(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) < value
             ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
             : nearest;
}

}  // namespace

std::optional<FlatFormat> flat_format_of(const std::string& path) {
  for (const Ending& ending : kEndings)
    if (has_ending(path, ending.text)) return ending.format;
  return std::nullopt;
}

std::vector<std::string> flat_format_endings() {
  std::vector<std::string> endings;
  for (const Ending& ending : kEndings) endings.push_back(ending.text);
  return endings;
}

void ClampedCounts::add(const ClampedCounts& more) {
  spz += more.spz;
  splat += more.splat;
  compressed_ply += more.compressed_ply;
}

void FlatContents::add(const GaussianCloud& batch) {
  voyager::add(report, batch.report);
  if (count == 0) origin = batch.origin;
  for (size_t i = 0; i < batch.position.size(); ++i) {
    const double coordinate = batch.origin[i % 3] + static_cast<double>(batch.position[i]);
    const bool first = count == 0 && i < 3;
    least[i % 3] = first ? coordinate : std::min(least[i % 3], coordinate);
    most[i % 3] = first ? coordinate : std::max(most[i % 3], coordinate);
    largest_coordinate = std::max(largest_coordinate, std::fabs(coordinate));
  }
  count += batch.size();
  const ValueRange ranges[] = {kSpzRange, kSplatRange, kCompressedPlyRange};
  const std::vector<uint64_t> outside = count_outside(ranges, batch);
  clamped.add({outside[0], outside[1], outside[2]});
}

float FlatContents::reach() const {
  return rounded_up(largest_coordinate);
}

float FlatContents::reach_from_origin() const {
  double reach = 0;
  for (size_t axis = 0; axis < 3; ++axis)
    reach = std::max({reach, most[axis] - origin[axis], origin[axis] - least[axis]});
  return rounded_up(reach);
}

void require_flat_file(const std::string& path, const FlatContents& contents,
                       const FlatOptions& options) {
  const FlatFormat format = required_format(path);
  const AtomicFile nothing(path);
  require_room(path, least_bytes(format, options, contents));
}

void write_flat_file(const std::string& path, const FlatOptions& options,
                     const FlatContents& contents,
                     const std::function<void(GaussianWriter&)>& fill) {
  const FlatFormat format = required_format(path);
  AtomicFile file(path);
  require_room(path, least_bytes(format, options, contents));
  const std::unique_ptr<PlacedSink> sink = sink_to(file);
  const std::unique_ptr<GaussianWriter> writer = write_flat(*sink, format, options, contents);
  fill(*writer);
  writer->finish();
  file.commit();
}

}  // namespace voyager
