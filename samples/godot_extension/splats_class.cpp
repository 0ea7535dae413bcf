#include "splats_class.h"

#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "godot.h"
#include "splats.h"

namespace voyager_godot {
namespace {

constexpr const char* kClass = "VoyagerSplats";

// ------------------------------------------------------------------- methods
// With arguments as pointers to Godot's values.

template <class T>
T value_of(const void* argument) {
  T value;
  std::memcpy(&value, argument, sizeof value);
  return value;
}

void open_scene(Splats& splats, const void* const* arguments, void*) {
  splats.open_scene(utf8_of(arguments[0]));
}

void close_scene(Splats& splats, const void* const*, void*) {
  splats.close_scene();
}

void draw(Splats& splats, const void* const* arguments, void* result) {
  SplatFrame frame = {};
  frame.rendering_device = value_of<void*>(arguments[0]);
  frame.colour = value_of<uint64_t>(arguments[1]);
  frame.depth = value_of<uint64_t>(arguments[2]);
  const auto size = value_of<std::array<int32_t, 2>>(arguments[3]);
  frame.extent = {static_cast<uint32_t>(size[0]), static_cast<uint32_t>(size[1])};
  std::memcpy(frame.camera, arguments[4], sizeof frame.camera);
  std::memcpy(frame.projection, arguments[5], sizeof frame.projection);
  const GDBool drawn = splats.draw(frame);
  std::memcpy(result, &drawn, sizeof drawn);
}

// `result` is a String that Godot has made.
void assign(void* result, const std::string& text) {
  godot.destructor(kGDString)(result);
  godot.string_new(result, text.c_str());
}

void last_error(Splats& splats, const void* const*, void* result) {
  assign(result, splats.last_error());
}

void mode(Splats& splats, const void* const*, void* result) {
  assign(result, splats.mode());
}

struct Argument {
  const char* name;
  GDVariantType type;
};
struct Method {
  const char* name;
  void (*function)(Splats&, const void* const*, void*);
  GDVariantType result;
  std::vector<Argument> arguments;
};
const Method kMethods[] = {{"open_scene", open_scene, kGDNil, {{"path", kGDString}}},
                           {"close_scene", close_scene, kGDNil, {}},
                           {"draw",
                            draw,
                            kGDBool,
                            {{"rendering_device", kGDObject},
                             {"color", kGDRid},
                             {"depth", kGDRid},
                             {"size", kGDVector2i},
                             {"camera", kGDTransform3D},
                             {"projection", kGDProjection}}},
                           {"last_error", last_error, kGDString, {}},
                           {"mode", mode, kGDString, {}}};

// --------------------------------------------------------------------- calls

void ptrcall(void* userdata, void* instance, const void* const* arguments, void* result) {
  if (!instance) return;  // there was no memory for it
  static_cast<const Method*>(userdata)->function(*static_cast<Splats*>(instance), arguments,
                                                 result);
}

// A value of Godot's out of a Variant; the largest is a Projection.
class Unpacked {
 public:
  Unpacked(GDVariantType type, const void* variant) : type_(type) {
    godot.type_from_variant(type)(value_, const_cast<void*>(variant));
  }
  ~Unpacked() {
    if (type_ == kGDString) godot.destructor(kGDString)(value_);
  }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;
  const void* get() const { return value_; }

 private:
  GDVariantType type_;
  alignas(8) unsigned char value_[64] = {};
};

bool arguments_fit(const Method& method, const void* const* arguments, int64_t count,
                   GDCallError& error) {
  const auto expected = static_cast<int64_t>(method.arguments.size());
  if (count != expected) {
    error = {count < expected ? kGDTooFewArguments : kGDTooManyArguments, 0,
             static_cast<int32_t>(expected)};
    return false;
  }
  for (size_t i = 0; i < method.arguments.size(); ++i) {
    const GDVariantType found = godot.variant_type(arguments[i]), type = method.arguments[i].type;
    if (found == type || (type == kGDObject && found == kGDNil)) continue;
    error = {kGDInvalidArgument, static_cast<int32_t>(i), type};
    return false;
  }
  return true;
}

// With Variants, from scripts that do not know the type.
void call(void* userdata, void* instance, const void* const* arguments, int64_t count, void* result,
          GDCallError* error) {
  const Method& method = *static_cast<const Method*>(userdata);
  *error = {};
  if (!instance || !arguments_fit(method, arguments, count, *error)) return;
  std::vector<std::unique_ptr<Unpacked>> values;
  std::vector<const void*> pointers;
  for (size_t i = 0; i < method.arguments.size(); ++i) {
    const GDVariantType type = method.arguments[i].type;
    values.push_back(std::make_unique<Unpacked>(type, arguments[i]));
    pointers.push_back(values.back()->get());
  }
  Splats& splats = *static_cast<Splats*>(instance);
  if (method.result == kGDString) {
    String text("");
    method.function(splats, pointers.data(), text.get());
    godot.variant_from_type(kGDString)(result, text.get());
  } else if (method.result == kGDBool) {
    GDBool value = 0;
    method.function(splats, pointers.data(), &value);
    godot.variant_from_type(kGDBool)(result, &value);
  } else {
    method.function(splats, pointers.data(), nullptr);
  }
}

// -------------------------------------------------------------- registration

void* create_instance(void*) {
  StringName base("RefCounted"), name(kClass);
  void* object = godot.construct_object(base.get());
  godot.object_set_instance(object, name.get(), new (std::nothrow) Splats);
  return object;
}

void free_instance(void*, void* instance) {
  delete static_cast<Splats*>(instance);
}

void register_method(void* library, const Method& method) {
  StringName class_name(kClass), name(method.name), empty("");
  String no_hint("");
  const auto property = [&](GDVariantType type, StringName& of) {
    return GDPropertyInfo{type, of.get(), empty.get(), 0, no_hint.get(), kGDUsageDefault};
  };
  std::vector<std::unique_ptr<StringName>> names;
  std::vector<GDPropertyInfo> arguments;
  for (const Argument& argument : method.arguments) {
    names.push_back(std::make_unique<StringName>(argument.name));
    arguments.push_back(property(argument.type, *names.back()));
  }
  std::vector<int> metadata(arguments.size(), 0);
  GDPropertyInfo result = property(method.result, empty);
  GDMethodInfo info = {};
  info.name = name.get();
  info.userdata = const_cast<Method*>(&method);
  info.call = call;
  info.ptrcall = ptrcall;
  info.flags = 1;
  info.has_return_value = method.result != kGDNil;
  info.return_value_info = &result;
  info.argument_count = static_cast<uint32_t>(arguments.size());
  info.arguments_info = arguments.data();
  info.arguments_metadata = metadata.data();
  godot.register_method(library, class_name.get(), &info);
}

}  // namespace

void register_splats_class(void* library) {
  StringName name(kClass), base("RefCounted");
  GDClassInfo info = {};
  info.is_exposed = 1;
  info.create_instance = create_instance;
  info.free_instance = free_instance;
  godot.register_class(library, name.get(), base.get(), &info);
  for (const Method& method : kMethods) register_method(library, method);
}

void unregister_splats_class(void* library) {
  StringName name(kClass);
  godot.unregister_class(library, name.get());
}

}  // namespace voyager_godot
