#pragma once
// Small LCC scenes for tests: their files by name.
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/sample_files.h"

namespace voyager::test {

using LccFiles = std::map<std::string, Bytes>;

// One Gaussian of data.bin.
struct LccRow {
  std::array<float, 3> position{};
  std::array<uint8_t, 4> rgba{};
  std::array<uint16_t, 3> scale{};
  uint32_t rotation = 3u << 30;  // w left out
};

inline void put(Bytes& bytes, const LccRow& row) {
  for (const float v : row.position) put(bytes, v);
  for (const uint8_t v : row.rgba) put(bytes, v);
  for (const uint16_t v : row.scale) put(bytes, v);
  put(bytes, row.rotation);
  for (int i = 0; i < 3; ++i) put(bytes, uint16_t{0});  // the normal, which scenes leave out
}

// Row i of a sound scene: all codes differ, and the three components of a rotation are small.
inline LccRow lcc_row(uint32_t i) {
  const auto byte = [&](uint32_t k) { return static_cast<uint8_t>(37 * i + 91 * k + 11); };
  const auto code = [&](uint32_t k) { return static_cast<uint16_t>(9973 * i + 20011 * k + 77); };
  LccRow row;
  row.position = {static_cast<float>(i) + 0.5f, -2.0f * static_cast<float>(i),
                  3.0f + static_cast<float>(i) / 4};
  row.rgba = {byte(0), byte(1), byte(2), static_cast<uint8_t>(1 + (53 * i + 20) % 254)};
  row.scale = {code(0), code(1), code(2)};
  row.rotation = i << 30;
  for (uint32_t k = 0; k < 3; ++k) row.rotation |= (300 + (97 * i + 131 * k) % 424) << (10 * k);
  return row;
}

inline void put_lcc_sh(Bytes& bytes, uint32_t i) {
  for (uint32_t k = 0; k < 15; ++k) put(bytes, 2654435761u * (16 * i + k + 1));
  put(bytes, uint32_t{0});
}

inline nlohmann::json lcc_attribute(const char* name, std::array<double, 3> min,
                                    std::array<double, 3> max) {
  return {{"name", name}, {"min", min}, {"max", max}};
}

inline nlohmann::json lcc_meta(uint64_t levels, bool has_sh) {
  return {{"version", "5.0"},
          {"totalLevel", levels},
          {"indexDataSize", 4 + 16 * levels},
          {"offset", {0, 0, 0}},
          {"shift", {0, 0, 0}},
          {"scale", {1, 1, 1}},
          {"encoding", "COMPRESS"},
          {"fileType", has_sh ? "Quality" : "Portable"},
          {"attributes",
           {lcc_attribute("scale", {0.5, 1, 2}, {1, 3, 4}),
            lcc_attribute("shcoef", {-1, -2, -4}, {1, 2, 3}),
            lcc_attribute("envscale", {10, 10, 10}, {20, 30, 40}),
            lcc_attribute("envshcoef", {-0.5, -0.5, -0.5}, {0.5, 0.25, 0.125})}}};
}

// The rows of a cell at one level: `count` from row `first` on.
struct LccLevel {
  uint64_t first = 0;
  uint32_t count = 0;
};

inline void put_lcc_cell(Bytes& index, const std::vector<LccLevel>& levels) {
  put(index, uint32_t{0});
  for (const LccLevel& level : levels) {
    put(index, level.count);
    put(index, 32 * level.first);
    put(index, 32 * level.count);
  }
}

// Two cells of 3 and 2 Gaussians, and one coarse Gaussian of each, which are rows 3 and 6.
inline LccFiles lcc_files(bool has_sh) {
  LccFiles files;
  put_lcc_cell(files["index.bin"], {{0, 3}, {3, 1}});
  put_lcc_cell(files["index.bin"], {{4, 2}, {6, 1}});
  for (uint32_t i = 0; i < 7; ++i) {
    put(files["data.bin"], lcc_row(i));
    if (has_sh) put_lcc_sh(files["shcoef.bin"], i);
  }
  files["scene.lcc"] = bytes_of(lcc_meta(2, has_sh).dump());
  return files;
}

// Of `count` Gaussians, from row `first` on.
inline Bytes lcc_environment(uint32_t first, uint32_t count, bool has_sh) {
  Bytes bytes;
  for (uint32_t i = first; i < first + count; ++i) {
    put(bytes, lcc_row(i));
    if (has_sh) put_lcc_sh(bytes, i);
  }
  return bytes;
}

}  // namespace voyager::test
