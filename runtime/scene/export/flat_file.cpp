#include "runtime/scene/export/flat_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "runtime/base/error.h"
#include "runtime/base/output_path.h"
#include "runtime/scene/append.h"

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
    case FlatFormat::compressed_ply:
      return compressed_ply_bytes(contents.count, contents.sh_degree);
    case FlatFormat::splat:
      return contents.count * kSplatBytes;
    case FlatFormat::glb:
      return glb_bytes(contents.count, contents.sh_degree);
    case FlatFormat::spz:
      break;
  }
  return 0;
}

// Never below the coordinate.
float rounded_up(double coordinate) {
  const auto nearest = static_cast<float>(coordinate);
  return static_cast<double>(nearest) < coordinate
             ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
             : nearest;
}

std::unique_ptr<GaussianWriter> write_flat(PlacedSink& sink, FlatFormat format,
                                           const FlatOptions& options,
                                           const FlatContents& contents) {
  const uint64_t count = contents.count;
  const int degree = contents.sh_degree;
  switch (format) {
    case FlatFormat::ply:
      return write_ply(sink, count, degree, is_moved(contents), contents.native);
    case FlatFormat::compressed_ply:
      return write_compressed_ply(sink, count, degree, contents.native);
    case FlatFormat::splat:
      return write_splat(sink, count, degree);
    case FlatFormat::glb:
      return write_glb(sink, count, degree);
    case FlatFormat::spz:
      break;
  }
  return write_spz(sink, count, degree, rounded_up(contents.largest_coordinate),
                   options.spz_version);
}

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", value);
  return text;
}

// Of a coordinate in binary32.
double step_at(double coordinate) {
  const float at = rounded_up(coordinate);
  return double{std::nextafter(at, std::numeric_limits<float>::infinity())} - double{at};
}

// Positions of the world, where the scene is far from the world's origin.
std::string coarse_positions(FlatFormat format, const FlatContents& contents) {
  const double coordinate = contents.largest_coordinate;
  const bool in_binary32 = format == FlatFormat::splat || format == FlatFormat::compressed_ply;
  if (in_binary32 && is_moved(contents))
    return "positions are in steps of " + metres(step_at(coordinate)) + ": they are " +
           metres(coordinate) + " from the world's origin";
  const int bits = spz_fractional_bits(rounded_up(coordinate));
  if (format == FlatFormat::spz && bits < spz_fractional_bits(0))
    return "positions are in steps of " + metres(std::ldexp(1.0, -bits)) + ": one is " +
           metres(coordinate) + " from the world's origin";
  return "";
}

std::string lost_filter(FlatFormat format, const NativeScale& native) {
  if (!native.antialiased()) return "";
  if (format == FlatFormat::splat || format == FlatFormat::glb)
    return "the format cannot say that the scene was trained with a compensated (antialiasing) "
           "filter: left out";
  if (format == FlatFormat::spz && native.low_pass == kMipSplattingLowPass)
    return "the format cannot say that the filter of the training is Mip-Splatting's: it is read "
           "as 3DGS's";
  return "";
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
  if (format == FlatFormat::splat && contents.sh_degree > 0)
    lost.push_back("the format has no spherical harmonics of degree 1 and more: left out");
  for (const std::string& text :
       {lost_filter(format, contents.native), coarse_positions(format, contents)})
    if (!text.empty()) lost.push_back(text);
  return lost;
}

void require_flat_file(const std::string& path, const FlatContents& contents) {
  const FlatFormat format = required_format(path);
  const AtomicFile nothing(path);
  require_room(path, least_bytes(format, contents));
}

void write_flat_file(const std::string& path, const FlatOptions& options,
                     const FlatContents& contents,
                     const std::function<void(GaussianWriter&)>& fill) {
  const FlatFormat format = required_format(path);
  AtomicFile file(path);
  require_room(path, least_bytes(format, contents));
  const std::unique_ptr<PlacedSink> sink = sink_to(file);
  const std::unique_ptr<GaussianWriter> writer = write_flat(*sink, format, options, contents);
  fill(*writer);
  writer->finish();
  file.commit();
}

}  // namespace voyager
