#pragma once
// What the sample uses of GDExtension's C interface, which Godot 4.3 and later offer. Written from
// Godot's documentation; the layouts are Godot's. Pointers to Godot's values are void*: a String, a
// StringName and a RID have 8 bytes, a Variant has 24.
#include <cstdint>

using GDBool = uint8_t;

enum GDInitializationLevel { kGDLevelCore, kGDLevelServers, kGDLevelScene, kGDLevelEditor };

struct GDInitialization {
  GDInitializationLevel minimum_initialization_level;
  void* userdata;
  void (*initialize)(void* userdata, GDInitializationLevel level);
  void (*deinitialize)(void* userdata, GDInitializationLevel level);
};

using GDFunction = void (*)();
using GDGetProcAddress = GDFunction (*)(const char* name);

// Those that the methods of the sample take and return.
enum GDVariantType {
  kGDNil = 0,
  kGDBool = 1,
  kGDString = 4,
  kGDVector2i = 6,
  kGDTransform3D = 18,
  kGDProjection = 19,
  kGDStringName = 21,
  kGDRid = 23,
  kGDObject = 24
};

struct GDPropertyInfo {
  GDVariantType type;
  void* name;        // StringName
  void* class_name;  // StringName
  uint32_t hint;
  void* hint_string;  // String
  uint32_t usage;
};
inline constexpr uint32_t kGDUsageDefault = 6;

struct GDCallError {
  int error;  // 0: none
  int32_t argument, expected;
};
enum GDCallErrorType { kGDInvalidArgument = 2, kGDTooManyArguments = 3, kGDTooFewArguments = 4 };

using GDMethodCall = void (*)(void* userdata, void* instance, const void* const* arguments,
                              int64_t count, void* result, GDCallError* error);
using GDMethodPtrCall = void (*)(void* userdata, void* instance, const void* const* arguments,
                                 void* result);

struct GDMethodInfo {
  void* name;  // StringName
  void* userdata;
  GDMethodCall call;
  GDMethodPtrCall ptrcall;
  uint32_t flags;  // 1: normal
  GDBool has_return_value;
  GDPropertyInfo* return_value_info;
  int return_value_metadata;  // 0: none
  uint32_t argument_count;
  GDPropertyInfo* arguments_info;
  int* arguments_metadata;
  uint32_t default_argument_count;
  void** default_arguments;
};

using GDUnusedFunction = void (*)();  // keeps its place in the structure

// GDExtensionClassCreationInfo3.
struct GDClassInfo {
  GDBool is_virtual, is_abstract, is_exposed, is_runtime;
  GDUnusedFunction before_create[11];  // from set_func to unreference_func
  void* (*create_instance)(void* userdata);
  void (*free_instance)(void* userdata, void* instance);
  GDUnusedFunction after_free[5];  // from recreate_instance_func to get_rid_func
  void* userdata;
};

// Functions that Godot hands out by name.
using GDStringNameNew = void (*)(void* uninitialized, const char* utf8);
using GDStringNew = void (*)(void* uninitialized, const char* utf8);
using GDStringToUtf8 = int64_t (*)(const void* string, char* text, int64_t capacity);
using GDRegisterClass = void (*)(void* library, const void* name, const void* parent,
                                 const GDClassInfo* info);
using GDRegisterMethod = void (*)(void* library, const void* class_name, const GDMethodInfo* info);
using GDUnregisterClass = void (*)(void* library, const void* name);
using GDConstructObject = void* (*)(const void* class_name);
using GDObjectSetInstance = void (*)(void* object, const void* class_name, void* instance);
using GDGetClassTag = void* (*)(const void* class_name);
using GDObjectCastTo = void* (*)(const void* object, void* class_tag);
using GDGetMethodBind = void* (*)(const void* class_name, const void* method, int64_t hash);
using GDMethodBindPtrCall = void (*)(void* bind, void* object, const void* const* arguments,
                                     void* result);
using GDVariantGetType = GDVariantType (*)(const void* variant);
using GDVariantFromType = void (*)(void* uninitialized, void* value);
using GDTypeFromVariant = void (*)(void* uninitialized, void* variant);
using GDGetVariantFromType = GDVariantFromType (*)(GDVariantType type);
using GDGetTypeFromVariant = GDTypeFromVariant (*)(GDVariantType type);
using GDDestructor = void (*)(void* value);
using GDGetDestructor = GDDestructor (*)(GDVariantType type);
