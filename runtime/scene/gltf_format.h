#pragma once
// What readers and writers of KHR_gaussian_splatting agree on. glTF's axes are left-up-front,
// INRIA's right-down-front: half a turn about z, the same in both directions.
#include <array>

namespace voyager::gltf {

// Sign that SH coefficient k takes when x and y are mirrored: that of basis k at (-x, -y, z) over
// basis k at (x, y, z).
inline constexpr std::array<int, 16> kShSign = {1, -1, 1, -1, 1, -1, 1, -1,
                                                1, -1, 1, -1, 1, -1, 1, -1};

}  // namespace voyager::gltf
