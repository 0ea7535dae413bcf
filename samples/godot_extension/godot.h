#pragma once
// Godot's functions, loaded by name, and the values that go through them.
#include <string>

#include "godot_interface.h"

namespace voyager_godot {

struct Godot {
  // False if Godot lacks one of them: it is older than 4.3.
  bool load(GDGetProcAddress get);

  GDStringNameNew string_name_new;
  GDStringNew string_new;
  GDStringToUtf8 string_to_utf8;
  GDRegisterClass register_class;
  GDRegisterMethod register_method;
  GDUnregisterClass unregister_class;
  GDConstructObject construct_object;
  GDObjectSetInstance object_set_instance;
  GDGetClassTag class_tag;
  GDObjectCastTo object_cast_to;
  GDGetMethodBind get_method_bind;
  GDMethodBindPtrCall ptrcall;
  GDVariantGetType variant_type;
  GDGetVariantFromType variant_from_type;
  GDGetTypeFromVariant type_from_variant;
  GDGetDestructor destructor;
};
extern Godot godot;  // of the process, as the extension is

class StringName {
 public:
  explicit StringName(const char* utf8) { godot.string_name_new(&value_, utf8); }
  ~StringName() { godot.destructor(kGDStringName)(&value_); }
  StringName(const StringName&) = delete;
  StringName& operator=(const StringName&) = delete;
  void* get() { return &value_; }

 private:
  uint64_t value_ = 0;
};

class String {
 public:
  explicit String(const char* utf8) { godot.string_new(&value_, utf8); }
  ~String() { godot.destructor(kGDString)(&value_); }
  String(const String&) = delete;
  String& operator=(const String&) = delete;
  void* get() { return &value_; }

 private:
  uint64_t value_ = 0;
};

// Of a String of Godot's.
std::string utf8_of(const void* string);

}  // namespace voyager_godot
