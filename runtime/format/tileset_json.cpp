#include "runtime/format/tileset_json.h"

#include <charconv>
#include <cmath>

#include "runtime/scene/tileset_format.h"

namespace voyager {
namespace {

// The shortest that is read as the same number, whatever the locale.
std::string json_number(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

std::string json_list(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() == 1 ? "" : ",") + json_number(value);
  return text + "]";
}

// Of INRIA's axes; without -0.
Vec3d to_tiles(const Vec3d& v) {
  return tileset::kToInria * v + Vec3d{0, 0, 0};
}

// A centre and three half axes.
std::string volume(const TileBox& box) {
  const Vec3d centre = to_tiles(0.5 * (box.least + box.most));
  const Vec3d half = 0.5 * (box.most - box.least);
  // What the rounding of both may lose.
  const auto wide = [](double h, double c) { return h + 1e-12 * (h + std::fabs(c)); };
  const double x = wide(half.x, centre.x), y = wide(half.z, centre.y), z = wide(half.y, centre.z);
  return R"({"box":)" + json_list({centre.x, centre.y, centre.z, x, 0, 0, 0, y, 0, 0, 0, z}) + "}";
}

// A tile has an eighth of its parent's leaves or shows all of them: they are few in one another.
std::string tile_json(const std::vector<TileEntry>& tiles, size_t index, const std::string& more) {
  const TileEntry& tile = tiles[index];
  std::string text = "{" + more + R"("boundingVolume":)" + volume(tile.volume) +
                     R"(,"geometricError":)" + json_number(tile.error) + R"(,"content":{"uri":")" +
                     tile.uri + R"(","boundingVolume":)" + volume(tile.own) + "}";
  if (!tile.children.empty()) {
    text += R"(,"children":[)";
    for (size_t i = 0; i < tile.children.size(); ++i)
      text += (i == 0 ? "" : ",\n") + tile_json(tiles, tile.children[i], "");
    text += "]";
  }
  return text + "}";
}

}  // namespace

std::string tileset_json(const std::vector<TileEntry>& tiles, const std::array<double, 3>& origin,
                         bool spz_inside) {
  const std::string splats = R"("KHR_gaussian_splatting")";
  const std::string spz = splats + R"(,"KHR_gaussian_splatting_compression_spz_2")";
  const Vec3d at = to_tiles({origin[0], origin[1], origin[2]});
  std::string root = R"("refine":"REPLACE",)";
  if (at.x != 0 || at.y != 0 || at.z != 0)
    root += R"("transform":)" +
            json_list({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, at.x, at.y, at.z, 1}) + ",";
  const TileEntry& first = tiles.front();
  const Vec3d side = first.volume.most - first.volume.least;
  const double whole = std::hypot(side.x, side.y, side.z);
  const std::string content =
      R"("extensionsUsed":[)" + (spz_inside ? spz + R"(],"extensionsRequired":[)" + spz : splats);
  return R"({"asset":{"version":"1.1","generator":"Voyager"},"geometricError":)" +
         json_number(std::max(whole, 2 * first.error)) +
         R"(,"extensionsUsed":["3DTILES_content_gltf"],)"
         R"("extensionsRequired":["3DTILES_content_gltf"],)"
         R"("extensions":{"3DTILES_content_gltf":{)" +
         content + R"(]}},"root":)" + tile_json(tiles, 0, root) + "}\n";
}

}  // namespace voyager
