#pragma once
// When an open subtree has to be visited again. A verdict that was found at centre
// c₀ and target size τ₀* holds at c and τ* while
//     |c − c₀| + extent · |1/τ* − 1/τ₀*| < slack,
// (docs/lod-selection.md has the proof, rounding included). (c₀, τ₀*) is one of the
// last kReferences that frames were drawn at; a subtree notes which.
#include <cmath>
#include <cstdint>
#include <cstring>

#include "runtime/math/host_device.h"

namespace voyager {

inline constexpr uint32_t kReferences = 256;

// 1/τ*. A quotient from 2^128 on rounds to +inf, so that τ* = +inf acts as 2^128.
inline double inverse_target_size(float target_size) {
  return std::isinf(target_size) ? 0x1p-128 : 1.0 / static_cast<double>(target_size);
}

// How far a frame is from each reference; rounded up. +inf: no longer known.
struct Travel {
  float way;   // metres
  float turn;  // |1/τ* − 1/τ₀*|
};

// All frames up to one.
struct Journey {
  double way = 0;      // metres; rounded up
  uint32_t moves = 0;  // frames with a reference of their own, modulo 2^32
  uint32_t turns = 0;  // changes of τ*, modulo 2^32
};

// 8 bytes. slack = +inf: never to be visited, because the subtree is closed or has
// nothing to decide.
struct Watch {
  float slack;
  uint32_t extent_and_reference;  // the extent's upper 20 bits after the sign, rounded up
};

VOYAGER_HD Watch make_watch(float slack, float extent, uint32_t reference) {
  uint32_t bits;
  std::memcpy(&bits, &extent, sizeof bits);
  return {slack, ((bits + 0x7ffu) >> 11 << 12) | reference};
}

VOYAGER_HD uint32_t watch_reference(const Watch& watch) {
  return watch.extent_and_reference & 0xfffu;
}

VOYAGER_HD float watch_extent(const Watch& watch) {
  const uint32_t bits = watch.extent_and_reference >> 12 << 11;
  float extent;
  std::memcpy(&extent, &bits, sizeof extent);
  return extent;
}

// What a frame that is `t` away leaves of the slack. Where it is positive, less than
// what is left in exact arithmetic: the last term is more than the roundings.
VOYAGER_HD float slack_left(const Watch& watch, const Travel& t) {
  return (watch.slack - (t.way + watch_extent(watch) * t.turn)) - 0x1p-21f * watch.slack;
}

// Written so that a NaN (no extent known, times no turn) means a visit.
VOYAGER_HD bool due(const Watch& watch, const Travel* travel) {
  if (watch.slack == INFINITY) return false;
  const Travel& t = travel[watch_reference(watch)];
  return !(t.way + watch_extent(watch) * t.turn < watch.slack);
}

}  // namespace voyager
