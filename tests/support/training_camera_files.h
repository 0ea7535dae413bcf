#pragma once
// The same cameras as each of the tools around 3DGS writes them.
#include <fmt/core.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "runtime/scene/training_camera.h"

namespace voyager::test {

// What COLMAP says of a camera: world to view.
struct Posed {
  Quatd q;
  Vec3d t;
  double fx, fy, cx, cy;
  uint32_t width, height;

  TrainingCamera camera() const {
    const Mat3d m = rotation(normalise(q));
    Vec3d position{0, 0, 0};
    for (int i = 0; i < 3; ++i) position = position - t[i] * m.row[i];
    return {position, m, fx, fy, cx, cy, width, height};
  }
};

inline std::vector<Posed> three_cameras() {
  return {{{0.9, 0.1, -0.3, 0.2}, {1.5, -2.25, 7}, 2560.56, 2559.5, 1536.25, 1150, 3072, 2304},
          {{1, 0, 0, 0}, {0, 0, 0}, 800, 800, 400, 300, 800, 600},
          {{-0.1, 2, 0.7, -1}, {1000, 20, -3}, 1200.125, 1200.125, 960, 540, 1920, 1080}};
}

inline void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string numbers(const Vec3d& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z);
}

inline std::string inria_json(const std::vector<Posed>& all) {
  std::string text = "[";
  for (const Posed& p : all) {
    const TrainingCamera c = p.camera();
    text += text.size() > 1 ? ",\n" : "";
    text += fmt::format(
        R"({{"id": 0, "img_name": "a", "width": {}, "height": {}, "fx": {:.17g}, "fy": {:.17g}, )"
        R"("cx": {:.17g}, "cy": {:.17g}, "position": {}, "rotation": [)",
        c.width, c.height, c.fx, c.fy, c.cx, c.cy, numbers(c.position));
    const Vec3d* row = c.world_to_view.row;
    for (int i = 0; i < 3; ++i)
      text += (i ? ", " : "") + numbers({row[0][i], row[1][i], row[2][i]});
    text += "]}";
  }
  return text + "]";
}

inline std::string transform_matrix(const TrainingCamera& c) {
  const Vec3d* row = c.world_to_view.row;
  std::string text = "[";
  for (int i = 0; i < 3; ++i)
    text += fmt::format("[{:.17g}, {:.17g}, {:.17g}, {:.17g}], ", row[0][i], -row[1][i], -row[2][i],
                        c.position[i]);
  return text + "[0, 0, 0, 1]]";
}

// `top` goes before the frames: "\"applied_scale\": 2, ", say.
inline std::string transforms_json(const std::vector<Posed>& all, const std::string& top = "") {
  std::string text;
  for (const Posed& p : all) {
    const TrainingCamera c = p.camera();
    text += text.empty() ? "" : ",\n";
    text += fmt::format(
        R"({{"file_path": "images/a.jpg", "w": {}, "h": {}, "fl_x": {:.17g}, "fl_y": {:.17g}, )"
        R"("cx": {:.17g}, "cy": {:.17g}, "k1": 0.01, "transform_matrix": {}}})",
        c.width, c.height, c.fx, c.fy, c.cx, c.cy, transform_matrix(c));
  }
  return "{" + top + "\"frames\": [" + text + "]}";
}

inline std::string colmap_cameras_txt(const std::vector<Posed>& all) {
  std::string text = "# Camera list with one line of data per camera:\n";
  for (size_t i = 0; i < all.size(); ++i) {
    const Posed& p = all[i];
    text += fmt::format("{} OPENCV {} {} {:.17g} {:.17g} {:.17g} {:.17g} 0.1 -0.02 0 0\n", 7 + i,
                        p.width, p.height, p.fx, p.fy, p.cx, p.cy);
  }
  return text;
}

inline std::string colmap_images_txt(const std::vector<Posed>& all) {
  std::string text = "# Image list with two lines of data per image:\n#   IMAGE_ID, QW, ...\n";
  for (size_t i = 0; i < all.size(); ++i) {
    const Posed& p = all[i];
    text += fmt::format(
        "{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {} a picture {}.jpg\n{}\n",
        3 * i + 1, p.q.w, p.q.x, p.q.y, p.q.z, p.t.x, p.t.y, p.t.z, 7 + i, i,
        i == 1 ? "" : "2362.39 248.498 58396 1784.7 268.254 -1");  // the second has no points
  }
  return text;
}

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline std::string colmap_cameras_bin(const std::vector<Posed>& all) {
  std::string bytes;
  put<uint64_t>(bytes, all.size());
  for (size_t i = 0; i < all.size(); ++i) {
    const Posed& p = all[i];
    put(bytes, static_cast<uint32_t>(7 + i));
    put<int32_t>(bytes, 1);  // PINHOLE
    put<uint64_t>(bytes, p.width), put<uint64_t>(bytes, p.height);
    for (const double x : {p.fx, p.fy, p.cx, p.cy}) put(bytes, x);
  }
  return bytes;
}

inline std::string colmap_images_bin(const std::vector<Posed>& all) {
  std::string bytes;
  put<uint64_t>(bytes, all.size());
  for (size_t i = 0; i < all.size(); ++i) {
    const Posed& p = all[i];
    put(bytes, static_cast<uint32_t>(3 * i + 1));
    for (const double x : {p.q.w, p.q.x, p.q.y, p.q.z, p.t.x, p.t.y, p.t.z}) put(bytes, x);
    put(bytes, static_cast<uint32_t>(7 + i));
    bytes += "picture.jpg";
    bytes += '\0';
    put<uint64_t>(bytes, 5000 * i);  // points: more than are read at once
    bytes.append(5000 * i * 24, 'x');
  }
  return bytes;
}

}  // namespace voyager::test
