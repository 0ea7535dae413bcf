#pragma once
// Small .rad files of Spark's for tests, with the encodings that Spark's writer chooses by default
// and any others.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/math/gaussian.h"
#include "runtime/math/half.h"
#include "tests/support/sample_files.h"

namespace voyager::test {

inline Bytes raw_deflate(const Bytes& plain) {
  return deflated(plain, -MAX_WBITS);
}

// A property as a chunk's JSON has it, and its plain bytes.
struct RadProperty {
  std::string name, encoding;
  Bytes plain;
  std::optional<float> min, max;
  bool is_deflated = true;
};

inline void pad_to_8(Bytes& bytes) {
  bytes.resize((bytes.size() + 7) / 8 * 8);
}

// A mark, the length of the JSON, the JSON, and zeros.
inline Bytes rad_opening(const std::string& mark, const nlohmann::json& json) {
  Bytes bytes = bytes_of(mark);
  const std::string text = json.dump();
  put(bytes, static_cast<uint32_t>(text.size()));
  const Bytes body = bytes_of(text);
  bytes.insert(bytes.end(), body.begin(), body.end());
  pad_to_8(bytes);
  return bytes;
}

inline Bytes rad_chunk(uint64_t base, uint64_t count, const std::vector<RadProperty>& properties) {
  Bytes payload;
  nlohmann::json list = nlohmann::json::array();
  for (const RadProperty& property : properties) {
    const Bytes stored = property.is_deflated ? raw_deflate(property.plain) : property.plain;
    nlohmann::json row = {{"offset", payload.size()},
                          {"bytes", stored.size()},
                          {"property", property.name},
                          {"encoding", property.encoding}};
    if (property.is_deflated) row["compression"] = "gz";
    if (property.min) row["min"] = *property.min;
    if (property.max) row["max"] = *property.max;
    list.push_back(row);
    payload.insert(payload.end(), stored.begin(), stored.end());
    pad_to_8(payload);
  }
  Bytes bytes = rad_opening("RADC", {{"version", 1},
                                     {"base", base},
                                     {"count", count},
                                     {"payloadBytes", payload.size()},
                                     {"properties", list}});
  put(bytes, static_cast<uint64_t>(payload.size()));
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

inline nlohmann::json rad_meta(uint64_t count, int sh_degree, uint64_t chunk_size, bool is_tree) {
  nlohmann::json meta = {{"version", 1},       {"type", "gsplat"},        {"count", count},
                         {"maxSh", sh_degree}, {"chunkSize", chunk_size}, {"allChunkBytes", 0}};
  if (is_tree) meta["lodTree"] = true;
  return meta;
}

inline Bytes rad_file(nlohmann::json meta, const std::vector<Bytes>& chunks) {
  Bytes all;
  meta["chunks"] = nlohmann::json::array();
  for (const Bytes& chunk : chunks) {
    meta["chunks"].push_back({{"offset", all.size()}, {"bytes", chunk.size()}});
    all.insert(all.end(), chunk.begin(), chunk.end());
  }
  meta["allChunkBytes"] = all.size();
  Bytes bytes = rad_opening("RAD0", meta);
  bytes.insert(bytes.end(), all.begin(), all.end());
  return bytes;
}

// The numbers of some Gaussians, one array of `numbers` for each.
struct RadNumbers {
  size_t numbers = 0;
  std::vector<float> values;

  size_t count() const { return values.size() / numbers; }
  // Calls f(number) of all first numbers, then of all second ones.
  template <class F>
  void by_component(const F& f) const {
    for (size_t k = 0; k < numbers; ++k)
      for (size_t i = 0; i < count(); ++i) f(values[i * numbers + k]);
  }
};

inline RadProperty rad_f32(const std::string& name, const RadNumbers& numbers) {
  RadProperty property{name, "f32", {}, {}, {}};
  numbers.by_component([&](float v) { put(property.plain, v); });
  return property;
}

inline RadProperty rad_f16(const std::string& name, const RadNumbers& numbers) {
  RadProperty property{name, "f16", {}, {}, {}};
  numbers.by_component([&](float v) { put(property.plain, float_to_half(v)); });
  return property;
}

// Byte by byte of the numbers of another.
inline RadProperty rad_lebytes(RadProperty property) {
  const size_t width = property.encoding == "f32" ? 4 : 2;
  const Bytes numbers = std::exchange(property.plain, {});
  for (size_t b = 0; b < width; ++b)
    for (size_t at = b; at < numbers.size(); at += width) property.plain.push_back(numbers[at]);
  property.encoding += "_lebytes";
  return property;
}

inline uint8_t rad_code(float value, float min, float max, float most) {
  return static_cast<uint8_t>(
      std::round(std::clamp((value - min) / (max - min), 0.0f, 1.0f) * most));
}

inline RadProperty rad_r8(const std::string& name, const RadNumbers& numbers, float min,
                          float max) {
  RadProperty property{name, "r8", {}, min, max};
  numbers.by_component([&](float v) { put(property.plain, rad_code(v, min, max, 255)); });
  return property;
}

inline RadProperty rad_s8(const std::string& name, const RadNumbers& numbers, float max) {
  RadProperty property{name, "s8", {}, -max, max};
  numbers.by_component([&](float v) {
    put(property.plain, static_cast<int8_t>(std::round(std::clamp(v / max, -1.0f, 1.0f) * 127)));
  });
  return property;
}

// Codes as differences from the Gaussian before.
inline RadProperty rad_delta(RadProperty property, size_t count) {
  for (size_t i = property.plain.size(); i-- > 0;)
    if (i % count != 0)
      property.plain[i] = static_cast<std::byte>(std::to_integer<int>(property.plain[i]) -
                                                 std::to_integer<int>(property.plain[i - 1]));
  property.encoding += "_delta";
  return property;
}

inline RadProperty rad_ln_0r8(const RadNumbers& log_scales, float min, float max) {
  RadProperty property{"scales", "ln_0r8", {}, min, max};
  log_scales.by_component(
      [&](float v) { put(property.plain, static_cast<uint8_t>(1 + rad_code(v, min, max, 254))); });
  return property;
}

// Of unit quaternions w, x, y, z.
inline RadProperty rad_oct88r8(const RadNumbers& rotations) {
  RadProperty property{"orientation", "oct88r8", {}, {}, {}};
  for (size_t i = 0; i < rotations.count(); ++i) {
    const float* q = &rotations.values[4 * i];
    const float sign = q[0] < 0 ? -1.0f : 1.0f;
    float axis[3] = {sign * q[1], sign * q[2], sign * q[3]};
    const float sum = std::fabs(axis[0]) + std::fabs(axis[1]) + std::fabs(axis[2]);
    float u = sum > 0 ? axis[0] / sum : 1, v = sum > 0 ? axis[1] / sum : 0;
    if (axis[2] < 0) {
      const float x = u;
      u = std::copysign(1 - std::fabs(v), x);
      v = std::copysign(1 - std::fabs(x), v);
    }
    const float angle = 2 * std::acos(std::min(sign * q[0], 1.0f));
    for (const uint8_t code :
         {rad_code(u, -1, 1, 255), rad_code(v, -1, 1, 255), rad_code(angle, 0, 3.14159265f, 255)})
      put(property.plain, code);
  }
  return property;
}

inline RadProperty rad_children(const std::vector<uint16_t>& counts) {
  RadProperty property{"child_count", "u16", {}, {}, {}};
  for (const uint16_t count : counts) put(property.plain, count);
  return property;
}

inline RadProperty rad_child_starts(const std::vector<uint32_t>& starts) {
  RadProperty property{"child_start", "u32", {}, {}, {}};
  for (const uint32_t start : starts) put(property.plain, start);
  return property;
}

// Some Gaussians of a cloud, whose rotations have length 1, as Spark's writer has them by default.
inline std::vector<RadProperty> rad_properties(const GaussianCloud& cloud, size_t first,
                                               size_t count) {
  const auto part = [&](const auto& from, size_t width, size_t begin, size_t numbers) {
    RadNumbers some{numbers, {}};
    for (size_t i = first; i < first + count; ++i)
      for (size_t k = begin; k < begin + numbers; ++k) some.values.push_back(from[i * width + k]);
    return some;
  };
  const auto width = static_cast<size_t>(cloud.coefficients()) * 3;
  RadNumbers alpha = part(cloud.opacity, 1, 0, 1), rgb = part(cloud.sh, width, 0, 3);
  for (float& v : alpha.values) v = sigmoid(v);
  for (float& v : rgb.values) v = 0.5f + 0.28209479f * v;
  std::vector<RadProperty> properties{rad_lebytes(rad_f32("center", part(cloud.position, 3, 0, 3))),
                                      rad_r8("alpha", alpha, 0, 1),
                                      rad_delta(rad_r8("rgb", rgb, -1, 2), count),
                                      rad_ln_0r8(part(cloud.log_scale, 3, 0, 3), -12, 9),
                                      rad_oct88r8(part(cloud.rotation, 4, 0, 4))};
  const size_t begins[] = {3, 12, 27}, numbers[] = {9, 15, 21};
  for (size_t band = 0; band < static_cast<size_t>(cloud.sh_degree); ++band)
    properties.push_back(rad_s8("sh" + std::to_string(band + 1),
                                part(cloud.sh, width, begins[band], numbers[band]), 1));
  return properties;
}

inline Bytes rad_of(const GaussianCloud& cloud, size_t chunk_size) {
  std::vector<Bytes> chunks;
  for (size_t base = 0; base < cloud.size(); base += chunk_size) {
    const size_t count = std::min(chunk_size, cloud.size() - base);
    chunks.push_back(rad_chunk(base, count, rad_properties(cloud, base, count)));
  }
  return rad_file(rad_meta(cloud.size(), cloud.sh_degree, chunk_size, false), chunks);
}

}  // namespace voyager::test
