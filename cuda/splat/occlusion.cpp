#include "cuda/splat/occlusion.h"

#include <cmath>

namespace voyager::cuda {
namespace {

TileLimits limit_layout(const FrameTiles& tiles, size_t& all) {
  TileLimits limits{};
  all = 0;
  for (int level = 0; level < kLimitLevels; ++level)
    for (uint32_t eye = 0; eye < tiles.eyes; ++eye) {
      limits.first[level][eye] = static_cast<uint32_t>(all);
      all += static_cast<size_t>(limit_side(tiles.grids[eye].columns, level)) *
             static_cast<size_t>(limit_side(tiles.grids[eye].rows, level));
    }
  return limits;
}

size_t limit_cell_count(const FrameTiles& tiles) {
  size_t all = 0;
  limit_layout(tiles, all);
  return all;
}

// Linear, of homogeneous coordinates of tiles: the direction with that image, its z the third.
Vec3d direction_of(const Camera& camera, const Vec3d& tile) {
  return {(kTile * tile.x - camera.cx * tile.z) / camera.fx,
          (kTile * tile.y - camera.cy * tile.z) / camera.fy, tile.z};
}
Vec3d tile_of(const Camera& camera, const Vec3d& direction) {
  return {(camera.fx * direction.x + camera.cx * direction.z) / kTile,
          (camera.fy * direction.y + camera.cy * direction.z) / kTile, direction.z};
}
Vec3d to_world(const Camera& camera, const Vec3d& view) {
  const Mat3d& rows = camera.world_to_view;
  return view.x * rows.row[0] + view.y * rows.row[1] + view.z * rows.row[2];
}

}  // namespace

EyeMotion eye_motion(const Camera& now, const Camera& before) {
  EyeMotion motion{};
  const Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int column = 0; column < 3; ++column) {
    const Vec3d direction = to_world(now, direction_of(now, axes[column]));
    const Vec3d image = tile_of(before, before.world_to_view * direction);
    for (int row = 0; row < 3; ++row)
      motion.to_before[3 * row + column] = static_cast<float>(image[row]);
  }
  const double focal = std::fmax(before.fx, before.fy);
  const double zoom = std::fmax(before.fx / now.fx, before.fy / now.fy);
  const Vec3d step = now.eye - before.eye;
  motion.moved = static_cast<float>(std::sqrt(dot(step, step)));
  // A tile's own half, and half a tile more.
  motion.around = static_cast<float>(0.5 * std::fmax(zoom, 1.0) + 0.5);
  motion.parallax = static_cast<float>(focal / kTile) * motion.moved;
  return motion;
}

bool OcclusionChoice::next() {
  if (setting_ == Occlusion::on) return true;
  // Fewer are sorted and blended faster than a second pass finds that it has nothing to do.
  constexpr uint64_t kLeastPairs = uint64_t{1} << 19;
  // Frames until the other way is tried again: seldom enough that its cost is lost in the mean.
  constexpr unsigned kPlainAgain = 256, kTryAgain = 64;
  if (setting_ == Occlusion::off || plain_pairs_ < kLeastPairs) return false;
  return pays_ ? ++since_other_ % kPlainAgain != 0 : since_other_++ % kTryAgain == 0;
}

void OcclusionChoice::learn(bool limited, uint64_t pairs) {
  if (!limited) {
    plain_pairs_ = pairs;
    return;
  }
  const bool pays = pairs + pairs / 4 < plain_pairs_;  // a fifth is saved
  if (pays != pays_) since_other_ = pays ? 0 : 1;
  pays_ = pays;
}

bool OcclusionState::fits(const FrameTiles& tiles) const {
  return 2 * limit_cell_count(tiles) <= bits_.size();
}

void OcclusionState::fit(const FrameTiles& tiles) {
  if (fits(tiles)) return;
  bits_ = {};
  bits_ = Buffer<uint32_t>(2 * limit_cell_count(tiles));
  forget();
}

OcclusionFrame OcclusionState::work(const FrameTiles& tiles, uint32_t* ends, bool second) const {
  OcclusionFrame frame{tiles, ends, {}, {}, bits_.data()};
  size_t all = 0;
  frame.limits = limit_layout(tiles, all);
  if (second) frame.bits += all;
  frame.limits.bits = frame.bits;
  return frame;
}

void OcclusionState::begin(bool wanted, const FrameInput& frame, const FrameTiles& tiles,
                           uint32_t* ends, cudaStream_t stream) {
  const auto same_size = [](const Camera& a, const Camera& b) {
    return a.width == b.width && a.height == b.height;
  };
  bool known = wanted && before_.size() == frame.eyes.size();
  for (size_t eye = 0; known && eye < before_.size(); ++eye)
    known = same_size(before_[eye], frame.eyes[eye].camera);
  first_ = {};
  if (known) {
    OcclusionFrame guess = work(tiles, ends, false);
    for (size_t eye = 0; eye < before_.size(); ++eye)
      guess.motion[eye] = eye_motion(frame.eyes[eye].camera, before_[eye]);
    launch_occlusion_guess(guess, stream);
    first_ = guess.limits;
  }
  before_.clear();
  for (const FrameEye& eye : frame.eyes) before_.push_back(eye.camera);
}

TileLimits OcclusionState::second(const SplatView& splats, cudaStream_t stream) const {
  const OcclusionFrame rest = work(splats.frame, splats.ends, true);
  launch_occlusion_rest(rest, bits_.data(), splats, stream);
  return rest.limits;
}

}  // namespace voyager::cuda
