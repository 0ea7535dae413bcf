#include "tools/default_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/format/reader.h"
#include "runtime/frame/scene.h"
#include "runtime/scene/import/block_reader.h"

namespace voyager::tools {
namespace {

constexpr size_t kChunks = 64;             // of a .voy that are looked at
constexpr size_t kBlock = 1 << 14;         // Gaussians
constexpr uint64_t kLookedAt = 1 << 22;    // of a flat file, about: all, if it has no more
constexpr double kStrayShare = 0.02;       // of the positions, at either end of an axis
constexpr double kBeside = 0.25;           // of the length that the others take, which still counts
constexpr double kMargin = 1.08;           // for how far Gaussians reach beyond their means
constexpr double kAway = 0.1;              // metres, so that a single point is before the eye
constexpr double kTanHalfWidth = 0.57735;  // 60 degrees from left to right
constexpr uint32_t kWidth = 1280, kHeight = 720;

// Without Gaussians where it is damaged: the frame says so, if it needs it.
Chunk read_whole(const SceneFile& file, size_t index) {
  try {
    return file.read_chunk(static_cast<uint32_t>(index));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::damaged_chunk) throw;
    return {};
  }
}

std::vector<Vec3d> positions_of_tree(const SceneFile& file) {
  std::vector<Vec3d> positions;
  const auto& origin = file.info().origin;
  const size_t count = file.chunks().size(), step = std::max<size_t>(1, count / kChunks);
  for (size_t index = 0; index < count; index += step) {
    const Chunk chunk = read_whole(file, index);
    for (size_t i = 0; i < chunk.words.size(); ++i) {
      const Vec3f& mean = chunk.words[i].mean;
      if (chunk.is_leaf(i))
        positions.push_back({origin[0] + mean.x, origin[1] + mean.y, origin[2] + mean.z});
    }
  }
  return positions;
}

// A part of all positions, which depends on nothing but them: not on their order.
class Sample {
 public:
  explicit Sample(uint64_t of) : apart_(std::max<uint64_t>(1, of / kLookedAt)) {}
  bool has(const float* position) const {
    return apart_ == 1 || checksum(std::as_bytes(std::span(position, 3))) % apart_ == 0;
  }

 private:
  uint64_t apart_;  // one in so many
};

std::vector<Vec3d> positions_of_flat(std::unique_ptr<ByteSource> source) {
  std::vector<Vec3d> positions;
  const auto reader = open_blocks(std::move(source));
  const Sample sample(reader->count());
  for (;;) {
    const RawBlock block = reader->next(kBlock);
    if (block.count == 0) return positions;
    const GaussianCloud cloud = reader->decode(block);
    for (size_t i = 0; i < cloud.size(); ++i) {
      const float* p = cloud.position.data() + 3 * i;
      if (sample.has(p))
        positions.push_back(
            {cloud.origin[0] + p[0], cloud.origin[1] + p[1], cloud.origin[2] + p[2]});
    }
  }
}

struct Range {
  double low, high;
};

// Where most of the finite values lie, and a part of that again on either side.
Range around_most(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return {0, 0};
  const auto cut = static_cast<std::ptrdiff_t>(kStrayShare * static_cast<double>(values.size()));
  const auto low = values.begin() + cut, high = values.end() - 1 - cut;
  std::nth_element(values.begin(), low, values.end());
  const double least = *low;
  std::nth_element(values.begin(), high, values.end());
  const double beside = kBeside * (*high - least);
  return {least - beside, *high + beside};
}

std::vector<Vec3d> without_strays(std::span<const Vec3d> positions) {
  std::vector<Vec3d> kept(positions.begin(), positions.end());
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values(positions.size());
    std::transform(positions.begin(), positions.end(), values.begin(),
                   [axis](const Vec3d& p) { return p[axis]; });
    const Range range = around_most(std::move(values));
    std::erase_if(kept, [&](const Vec3d& p) {
      return !(p[axis] >= range.low && p[axis] <= range.high);  // NaN goes, too
    });
  }
  return kept;
}

struct Axes {
  Vec3d right, down, forward;
};

// Ahead (z), turned aside, and down.
Axes view_axes() {
  const double aside = 0.6, below = 0.5;  // radians
  const double c = std::cos(aside), s = std::sin(aside), level = std::cos(below),
               fall = std::sin(below);
  return {{c, 0, -s}, {-fall * s, level, -fall * c}, {level * s, fall, level * c}};
}

}  // namespace

// The four sides of the view, moved in by the margin, touch what is seen. The eye is as near as
// they let it be, and in the middle between the two of them that leave room.
Camera camera_around(std::span<const Vec3d> positions) {
  const std::vector<Vec3d> seen = without_strays(positions);
  const Axes axes = view_axes();
  const double tan_x = kTanHalfWidth / kMargin, tan_y = tan_x * kHeight / kWidth;
  const auto reach = [&](const Vec3d& side, double tan) {
    double most = seen.empty() ? 0 : -std::numeric_limits<double>::infinity();
    for (const Vec3d& p : seen) most = std::max(most, dot(p, side) - tan * dot(p, axes.forward));
    return most;
  };
  const double right = reach(axes.right, tan_x), left = reach(-1.0 * axes.right, tan_x),
               below = reach(axes.down, tan_y), above = reach(-1.0 * axes.down, tan_y);
  const double back = std::max((right + left) / (2 * tan_x), (below + above) / (2 * tan_y));
  const Vec3d eye = (right - left) / 2 * axes.right + (below - above) / 2 * axes.down -
                    (back + kAway) * axes.forward;
  return looking(eye, axes.right, axes.forward, kWidth, kHeight, kWidth / (2 * kTanHalfWidth));
}

Camera default_camera(const std::string& scene) {
  auto source = open_source(scene);
  return camera_around(scene_format(*source) == SceneFormat::baked
                           ? positions_of_tree(SceneFile(std::move(source)))
                           : positions_of_flat(std::move(source)));
}

}  // namespace voyager::tools
