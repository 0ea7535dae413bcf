#include "godot.h"

namespace voyager_godot {

Godot godot;

bool Godot::load(GDGetProcAddress get) {
  bool found = true;
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(get(name));
    found = found && function;
  };
  find(string_name_new, "string_name_new_with_utf8_chars");
  find(string_new, "string_new_with_utf8_chars");
  find(string_to_utf8, "string_to_utf8_chars");
  find(register_class, "classdb_register_extension_class3");
  find(register_method, "classdb_register_extension_class_method");
  find(unregister_class, "classdb_unregister_extension_class");
  find(construct_object, "classdb_construct_object");
  find(object_set_instance, "object_set_instance");
  find(class_tag, "classdb_get_class_tag");
  find(object_cast_to, "object_cast_to");
  find(get_method_bind, "classdb_get_method_bind");
  find(ptrcall, "object_method_bind_ptrcall");
  find(variant_type, "variant_get_type");
  find(variant_from_type, "get_variant_from_type_constructor");
  find(type_from_variant, "get_variant_to_type_constructor");
  find(destructor, "variant_get_ptr_destructor");
  return found;
}

std::string utf8_of(const void* string) {
  std::string text(static_cast<size_t>(godot.string_to_utf8(string, nullptr, 0)), '\0');
  godot.string_to_utf8(string, text.data(), static_cast<int64_t>(text.size()));
  return text;
}

}  // namespace voyager_godot
