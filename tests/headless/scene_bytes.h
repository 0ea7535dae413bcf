#pragma once
// A small scene as a host has it in memory: the bytes of a .ply.
#include <voyager/voyager.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

// Gaussians spread over a slab 40 m wide, 10 m high and 10 m deep around the
// origin, SH degree 1.
inline std::string ply_bytes(int count) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) + "\n";
  std::vector<std::string> names = {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2"};
  for (int i = 0; i < 9; ++i) names.push_back("f_rest_" + std::to_string(i));
  for (const char* name :
       {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    names.emplace_back(name);
  for (const std::string& name : names) bytes += "property float " + name + "\n";
  bytes += "end_header\n";

  std::mt19937 random(7);
  const auto put = [&](float low, float high) {
    const float unit = static_cast<float>(random() >> 8) / 16777216.0f;
    const float value = low + (high - low) * unit;
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof raw);
  };
  for (int i = 0; i < count; ++i) {
    put(-20, 20), put(-5, 5), put(-5, 5);
    for (int k = 0; k < 3; ++k) put(-1.5f, 1.5f);
    for (int k = 0; k < 9; ++k) put(-0.2f, 0.2f);
    put(-1, 4);
    for (int k = 0; k < 3; ++k) put(-3, -1);
    for (int k = 0; k < 4; ++k) put(0.1f, 1);
  }
  return bytes;
}

// Serves the bytes; fails at the read with the number `failing`, counted from 0.
struct BytesHost {
  std::string bytes;
  int failing = -1;
  std::atomic<int> reads{0};

  static VoyResult read(void* user, uint64_t offset, uint64_t size, void* into) {
    auto* self = static_cast<BytesHost*>(user);
    if (self->reads++ == self->failing) return VOY_ERROR_IO;
    if (offset > self->bytes.size() || size > self->bytes.size() - offset) return VOY_ERROR_IO;
    std::memcpy(into, self->bytes.data() + offset, size);
    return VOY_SUCCESS;
  }
  VoyByteSource source() {
    VoyByteSource source = VOY_BYTE_SOURCE_INIT;
    source.name = "memory.ply";
    source.size = bytes.size();
    source.user = this;
    source.read = read;
    return source;
  }
};
