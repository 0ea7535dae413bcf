#pragma once
// The JSON of a .glb with one primitive of KHR_gaussian_splatting.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace voyager::glb {

// An array of binary32 in the file, `count` times `components`.
struct Attribute {
  std::string semantic;
  size_t components;  // 1, 3 or 4
};
// In the order of the file: position, rotation, scale, opacity, then SH from coefficient 0 on.
std::vector<Attribute> attributes(int sh_degree);

// In glTF's axes.
struct Document {
  uint64_t count = 0;
  int sh_degree = 0;
  std::array<float, 3> least{}, most{};  // of positions
  // Of the node: its `translation`, or compressed its `matrix`, without which CesiumJS draws
  // nothing.
  std::array<double, 3> translation{};
  // Compressed: bytes of the .spz that is all of the binary chunk, in place of the arrays. Then
  // accessors have no views, and the first attribute with alpha is COLOR_0.
  std::optional<uint64_t> spz_bytes;
};
std::string json(const Document& document);

// Bytes by which texts of documents of the same count and degree may differ.
inline constexpr size_t kJsonSlack = 256;

}  // namespace voyager::glb
