#pragma once
// Godot's values as an extension sees them, opaque and counted: whatever it makes it must free.
#include <cstdint>
#include <cstring>
#include <string>

#include "godot_interface.h"

namespace voyager::test {

inline int64_t live_values = 0;

// Strings and StringNames: 8 bytes that point to a text.
struct GodotText {
  std::string* text;

  static void make(void* at, const std::string& value) {
    ++live_values;
    auto* made = new std::string(value);
    std::memcpy(at, &made, sizeof made);
  }
  static std::string*& of(void* at) { return static_cast<GodotText*>(at)->text; }
  static const std::string& at(const void* at) { return *static_cast<const GodotText*>(at)->text; }
  static void destroy(void* at) {
    --live_values;
    delete of(at);
    of(at) = nullptr;
  }
};

// A Variant: 24 bytes, here a type and a copy of the value.
struct GodotVariant {
  int64_t type = kGDNil;
  void* value = nullptr;
  int64_t unused = 0;

  static size_t size_of(int64_t type) {
    switch (type) {
      case kGDBool:
        return 1;
      case kGDTransform3D:
        return 48;
      case kGDProjection:
        return 64;
      default:
        return 8;
    }
  }
  static GodotVariant of(GDVariantType type, const void* from) {
    GodotVariant made;
    made.type = type;
    ++live_values;
    made.value = ::operator new(64);
    if (type == kGDString)
      GodotText::make(made.value, GodotText::at(from));
    else
      std::memcpy(made.value, from, size_of(type));
    return made;
  }
  void destroy() {
    if (type == kGDNil) return;
    if (type == kGDString) GodotText::destroy(value);
    --live_values;
    ::operator delete(value);
    *this = {};
  }
};
static_assert(sizeof(GodotVariant) == 24);

}  // namespace voyager::test
