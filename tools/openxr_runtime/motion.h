#pragma once
// Where each eye is and what it sees, a pair a display period, repeated from the start.
#include <array>
#include <string>
#include <vector>

#include "pose.h"

namespace test_runtime {

struct Eye {
  Pose pose;
  double left, right, up, down;  // tangents; left and down normally negative

  XrFovf fov() const;
};

inline constexpr double kInner = 0.375;

struct Head {
  std::array<Eye, 2> eyes;
  Pose centre() const;  // what VIEW is: between the eyes, turned as the left one
  // Of left, right, left inner, right inner: an inner view is its eye, and sees kInner of each
  // tangent.
  Eye view(size_t index) const;
};

using Motion = std::vector<Head>;

// A head that sways and turns, with frusta that breathe: 240 pairs in LOCAL, the first at its
// origin.
Motion built_in_motion();

// An INRIA cameras.json (fx, fy, cx, cy in pixels), left and right in turn: poses in the file's
// world. Throws std::runtime_error that names file, camera, field, found, expected.
Motion read_motion(const std::string& path);

}  // namespace test_runtime
