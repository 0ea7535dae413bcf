#pragma once
// Checks of what the host passes. They never load an enumerator that may be
// out of range as its enum, which would be undefined.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "plugin/result.h"

namespace voyager {

template <class Enum>
int32_t number(const Enum& value) {
  int32_t bits;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

// An in- or out-structure: not NULL, its own type, and nothing chained to it
// (no extension is known yet).
template <class Struct>
void check_structure(const Struct* s, VoyStructureType expected, const char* name) {
  if (s == nullptr) refuse(std::string(name) + ": found NULL, expected a structure");
  if (number(s->type) != expected)
    throw ApiError(VOY_ERROR_INVALID_STRUCTURE, std::string(name) + ".type: found " +
                                                    std::to_string(number(s->type)) +
                                                    ", expected " + std::to_string(expected));
  if (s->next != nullptr)
    throw ApiError(
        VOY_ERROR_INVALID_STRUCTURE,
        std::string(name) + ".next: found a pointer, expected NULL: no extension of it is known");
}

inline void check_pointer(const void* pointer, const char* name) {
  if (pointer == nullptr) refuse(std::string(name) + ": found NULL, expected a pointer");
}

// An enumerant from 0 to last.
template <class Enum>
void check_enum(const Enum& value, Enum last, const char* name) {
  if (number(value) < 0 || number(value) > static_cast<int32_t>(last))
    refuse(std::string(name) + ": found " + std::to_string(number(value)) + ", expected 0 to " +
           std::to_string(static_cast<int32_t>(last)));
}

inline void check_count(uint64_t found, uint64_t least, uint64_t most, const char* name) {
  if (found < least || found > most)
    refuse(std::string(name) + ": found " + std::to_string(found) + ", expected " +
           std::to_string(least) + " to " + std::to_string(most));
}

[[noreturn]] inline void refuse_number(const std::string& field, double found,
                                       const std::string& expected) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", found);
  refuse(field + ": found " + text + ", expected " + expected);
}

inline void check_tau(double tau) {
  if (!std::isfinite(tau) || tau < 0) refuse_number("tau", tau, "a finite number of pixels, >= 0");
}

}  // namespace voyager
