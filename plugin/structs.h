#pragma once
// Checks of what the host passes. They never load an enumerator that may be
// out of range as its enum, which would be undefined.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "plugin/field_name.h"
#include "plugin/result.h"

namespace voyager {

template <class Enum>
int32_t number(const Enum& value) {
  int32_t bits;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

// A structure that a call knows in another's chain, and where it is found.
template <class T>
struct Extension {
  VoyStructureType type;
  T*& found;  // NULL before the chain is read
};
template <class T>
Extension(VoyStructureType, T*&) -> Extension<T>;

// What all structures begin with.
struct ChainLink {
  VoyStructureType type;
  const void* next;
};
static_assert(offsetof(ChainLink, type) == offsetof(VoyFrame, type) &&
              offsetof(ChainLink, next) == offsetof(VoyFrame, next));

// Whether it is this one. Found a second time, it is refused.
template <class T>
bool take_extension(const Extension<T>& known, int32_t type, const void* link,
                    const FieldName& name) {
  if (type != known.type) return false;
  if (known.found != nullptr)
    throw ApiError(VOY_ERROR_INVALID_STRUCTURE, name.str() +
                                                    ".next: found two structures of type " +
                                                    std::to_string(type) + ", expected one");
  known.found = static_cast<T*>(const_cast<void*>(link));
  return true;
}

// Finds the known structures of a chain. Each is taken once, so a ring of them ends
// too. Where none is known nothing behind `next` is read.
template <class... T>
void find_extensions(const void* next, const FieldName& name, const Extension<T>&... known) {
  if (next != nullptr && sizeof...(known) == 0)
    throw ApiError(
        VOY_ERROR_INVALID_STRUCTURE,
        name.str() + ".next: found a pointer, expected NULL: no extension of it is known");
  while (next != nullptr) {
    ChainLink link;
    std::memcpy(&link, next, sizeof link);
    const int32_t type = number(link.type);
    if (!(take_extension(known, type, next, name) || ...))
      throw ApiError(VOY_ERROR_INVALID_STRUCTURE,
                     name.str() + ".next: found a structure of type " + std::to_string(type) +
                         ", expected" +
                         (std::string() + ... + (" " + std::to_string(int{known.type}))));
    next = link.next;
  }
}

// An in- or out-structure: not NULL, its own type, and nothing chained to it but what is
// known. Example: check_structure(frame, VOY_STRUCTURE_TYPE_FRAME, "VoyFrame",
// Extension{VOY_STRUCTURE_TYPE_X, x}), where x is a const VoyX* that is NULL.
template <class Struct, class... T>
void check_structure(const Struct* s, VoyStructureType expected, const FieldName& name,
                     const Extension<T>&... known) {
  if (s == nullptr) refuse(name.str() + ": found NULL, expected a structure");
  if (number(s->type) != expected)
    throw ApiError(VOY_ERROR_INVALID_STRUCTURE, name.str() + ".type: found " +
                                                    std::to_string(number(s->type)) +
                                                    ", expected " + std::to_string(expected));
  find_extensions(s->next, name, known...);
}

inline void check_pointer(const void* pointer, const FieldName& name) {
  if (pointer == nullptr) refuse(name.str() + ": found NULL, expected a pointer");
}

// An enumerant from 0 to last.
template <class Enum>
void check_enum(const Enum& value, Enum last, const FieldName& name) {
  if (number(value) < 0 || number(value) > static_cast<int32_t>(last))
    refuse(name.str() + ": found " + std::to_string(number(value)) + ", expected 0 to " +
           std::to_string(static_cast<int32_t>(last)));
}

inline void check_count(uint64_t found, uint64_t least, uint64_t most, const FieldName& name) {
  if (found < least || found > most)
    refuse(name.str() + ": found " + std::to_string(found) + ", expected " + std::to_string(least) +
           " to " + std::to_string(most));
}

[[noreturn]] inline void refuse_number(const std::string& field, double found,
                                       const std::string& expected) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", found);
  refuse(field + ": found " + text + ", expected " + expected);
}

// METHOD §3: below 1e18, squared distances stay finite in binary32.
inline void check_coordinate(double x, const FieldName& field) {
  if (!(std::fabs(x) < 1e18)) refuse_number(field, x, "metres below 1e18 in magnitude");
}

inline void check_tau(double tau, const FieldName& field) {
  if (!std::isfinite(tau) || tau < 0) refuse_number(field, tau, "a finite number of pixels, >= 0");
}

}  // namespace voyager
