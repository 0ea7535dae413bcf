#include <fmt/core.h>

#include <array>

#include "tools/training_cameras/colmap.h"

namespace voyager::tools {
namespace {

std::string place_of(const ByteWindow& bytes) {
  return fmt::format("{}: offset {}", bytes.name(), bytes.offset());
}

// How many items follow. Each takes at least `item_bytes`.
uint64_t take_count(ByteWindow& bytes, const char* what, uint64_t item_bytes) {
  const std::string place = place_of(bytes);
  const auto count = bytes.take<uint64_t>(what);
  if (count > bytes.left() / item_bytes)
    refuse_cameras(place, fmt::format("{}: {}", what, count),
                   fmt::format("at most the {} that {} bytes have room for",
                               bytes.left() / item_bytes, bytes.left()));
  return count;
}

void read_lens(ByteWindow& bytes, ColmapLenses& lenses) {
  const std::string place = place_of(bytes);
  const auto id = bytes.take<uint32_t>("a camera's number");
  const ColmapModel& model = colmap_model(place, bytes.take<int32_t>("a camera's model"));
  const auto width = bytes.take<uint64_t>("a width");
  const auto height = bytes.take<uint64_t>("a height");
  std::array<double, kMostColmapParameters> parameters{};
  for (size_t i = 0; i < model.parameters; ++i)
    parameters[i] = bytes.take<double>("a camera's parameter");
  add_lens(lenses, place, id, model, width, height, std::span(parameters).first(model.parameters));
}

TrainingCamera read_image(ByteWindow& bytes, const ColmapLenses& lenses) {
  const std::string place = place_of(bytes);
  bytes.take<uint32_t>("an image's number");
  const auto pose = bytes.take<std::array<double, 7>>("an image's pose");
  const auto lens = bytes.take<uint32_t>("an image's camera");
  const std::string name = place_of(bytes);
  if (!bytes.skip_past('\0'))
    refuse_cameras(name, "the end of the file", "an image's name that ends with a zero");
  constexpr uint64_t kPoint = 24;  // x, y, and the number of a point in space
  bytes.skip(kPoint * take_count(bytes, "points in an image", kPoint));
  return colmap_camera(lenses, place, lens, pose);
}

void require_end(const ByteWindow& bytes) {
  if (bytes.left() != 0)
    refuse_cameras(place_of(bytes), fmt::format("{} more bytes", bytes.left()),
                   "the end of the file");
}

}  // namespace

ColmapLenses read_lenses_binary(const ByteSource& file) {
  ByteWindow bytes(file);
  ColmapLenses lenses;
  for (uint64_t left = take_count(bytes, "cameras", 48); left > 0; --left) read_lens(bytes, lenses);
  require_end(bytes);
  return lenses;
}

std::vector<TrainingCamera> read_images_binary(const ByteSource& file, const ColmapLenses& lenses) {
  ByteWindow bytes(file);
  std::vector<TrainingCamera> cameras;
  for (uint64_t left = take_count(bytes, "images", 73); left > 0; --left)
    cameras.push_back(read_image(bytes, lenses));
  require_end(bytes);
  return cameras;
}

}  // namespace voyager::tools
