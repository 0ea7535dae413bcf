#include "tests/godot/imitated_godot.h"

#include <dlfcn.h>

#include <chrono>
#include <thread>

namespace voyager::test {
namespace {

ImitatedGodot* self = nullptr;

}  // namespace

// The functions of the interface, which know no object.
struct GodotTables {
  static void new_text(void* at, const char* utf8) { GodotText::make(at, utf8); }
  static int64_t to_utf8(const void* string, char* text, int64_t capacity) {
    const std::string& value = GodotText::at(string);
    if (text) value.copy(text, static_cast<size_t>(capacity));
    return static_cast<int64_t>(value.size());
  }
  static void register_class(void* library, const void* name, const void* parent,
                             const GDClassInfo* info) {
    EXPECT_EQ(library, self);
    EXPECT_EQ(GodotText::at(parent), "RefCounted");
    self->classes_[GodotText::at(name)] = *info;
  }
  static void register_method(void*, const void* class_name, const GDMethodInfo* info) {
    EXPECT_EQ(GodotText::at(class_name), "VoyagerSplats");
    for (uint32_t i = 0; i < info->argument_count; ++i)
      EXPECT_FALSE(GodotText::at(info->arguments_info[i].name).empty());
    self->methods_[GodotText::at(info->name)] = *info;
  }
  static void unregister_class(void*, const void* name) {
    EXPECT_EQ(self->classes_.erase(GodotText::at(name)), 1u);
  }
  static void* construct_object(const void* name) { return new GodotObject{GodotText::at(name)}; }
  static void set_instance(void* object, const void* name, void* instance) {
    *static_cast<GodotObject*>(object) = {GodotText::at(name), instance};
  }
  // A tag is the name's text, kept for good.
  static void* class_tag(const void* name) {
    static std::map<std::string, int> tags;
    return const_cast<std::string*>(&tags.emplace(GodotText::at(name), 0).first->first);
  }
  static void* cast_to(const void* object, void* tag) {
    auto* found = static_cast<const GodotObject*>(object);
    return found->class_name == *static_cast<std::string*>(tag) ? const_cast<GodotObject*>(found)
                                                                : nullptr;
  }
  static void* method_bind(const void* class_name, const void* method, int64_t hash) {
    const bool known = GodotText::at(class_name) == "RenderingDevice" &&
                       GodotText::at(method) == "get_driver_resource" && hash == 501815484;
    return known ? self : nullptr;
  }
  static void ptrcall(void* bind, void* object, const void* const* arguments, void* result) {
    ASSERT_EQ(bind, self);
    ASSERT_EQ(object, &self->rendering_device_);
    int64_t resource;
    uint64_t rid;
    std::memcpy(&resource, arguments[0], sizeof resource);
    std::memcpy(&rid, arguments[1], sizeof rid);
    const uint64_t found = driver_resource(resource, rid);
    std::memcpy(result, &found, sizeof found);
  }
  static uint64_t driver_resource(int64_t resource, uint64_t rid) {
    const VulkanHost& host = *self->host_;
    switch (resource) {
      case 0:
        return reinterpret_cast<uint64_t>(host.device);
      case 1:
        return reinterpret_cast<uint64_t>(host.physical);
      case 2:
        return reinterpret_cast<uint64_t>(host.instance);
      case 3:
        return reinterpret_cast<uint64_t>(host.queue);
      case 4:
        return host.family;
      case 5:
        return self->textures_.count(rid) ? reinterpret_cast<uint64_t>(self->textures_.at(rid)) : 0;
      default:
        ADD_FAILURE() << resource;
        return 0;
    }
  }
  static GDVariantType variant_type(const void* variant) {
    return static_cast<GDVariantType>(static_cast<const GodotVariant*>(variant)->type);
  }
  template <GDVariantType type>
  static void from_type(void* variant, void* value) {
    *static_cast<GodotVariant*>(variant) = GodotVariant::of(type, value);
  }
  template <GDVariantType type>
  static void to_type(void* value, void* variant) {
    const auto& from = *static_cast<GodotVariant*>(variant);
    if (from.type == kGDNil) {
      std::memset(value, 0, 8);
    } else if (type == kGDString) {
      GodotText::make(value, GodotText::at(from.value));
    } else {
      std::memcpy(value, from.value, GodotVariant::size_of(type));
    }
  }
  static GDVariantFromType variant_from(GDVariantType type) {
    return type == kGDString ? from_type<kGDString> : from_type<kGDBool>;
  }
  static GDTypeFromVariant variant_to(GDVariantType type) {
    static const std::map<GDVariantType, GDTypeFromVariant> table = {
        {kGDString, to_type<kGDString>},
        {kGDVector2i, to_type<kGDVector2i>},
        {kGDTransform3D, to_type<kGDTransform3D>},
        {kGDProjection, to_type<kGDProjection>},
        {kGDRid, to_type<kGDRid>},
        {kGDObject, to_type<kGDObject>}};
    return table.at(type);
  }
  static GDDestructor destructor(GDVariantType type) {
    EXPECT_TRUE(type == kGDString || type == kGDStringName);
    return GodotText::destroy;
  }

  static GDFunction get_proc_address(const char* name) {
    if (self->habits_.lacks == name) return nullptr;
    static const std::map<std::string, GDFunction> table = {
        {"string_name_new_with_utf8_chars", reinterpret_cast<GDFunction>(new_text)},
        {"string_new_with_utf8_chars", reinterpret_cast<GDFunction>(new_text)},
        {"string_to_utf8_chars", reinterpret_cast<GDFunction>(to_utf8)},
        {"classdb_register_extension_class3", reinterpret_cast<GDFunction>(register_class)},
        {"classdb_register_extension_class_method", reinterpret_cast<GDFunction>(register_method)},
        {"classdb_unregister_extension_class", reinterpret_cast<GDFunction>(unregister_class)},
        {"classdb_construct_object", reinterpret_cast<GDFunction>(construct_object)},
        {"object_set_instance", reinterpret_cast<GDFunction>(set_instance)},
        {"classdb_get_class_tag", reinterpret_cast<GDFunction>(class_tag)},
        {"object_cast_to", reinterpret_cast<GDFunction>(cast_to)},
        {"classdb_get_method_bind", reinterpret_cast<GDFunction>(method_bind)},
        {"object_method_bind_ptrcall", reinterpret_cast<GDFunction>(ptrcall)},
        {"variant_get_type", reinterpret_cast<GDFunction>(variant_type)},
        {"get_variant_from_type_constructor", reinterpret_cast<GDFunction>(variant_from)},
        {"get_variant_to_type_constructor", reinterpret_cast<GDFunction>(variant_to)},
        {"variant_get_ptr_destructor", reinterpret_cast<GDFunction>(destructor)}};
    const auto found = table.find(name);
    return found == table.end() ? nullptr : found->second;
  }
};

ImitatedGodot::ImitatedGodot(const GodotHabits& habits) : habits_(habits) {
  self = this;
  live_values = 0;
  VulkanCreation how;
  how.asks_voyager = habits.enables_extensions;
  host_ = std::make_unique<VulkanHost>(how);
  library_ = ::dlopen(VOYAGER_GODOT_EXTENSION, RTLD_NOW | RTLD_LOCAL);
  EXPECT_NE(library_, nullptr) << ::dlerror();
  using Init = GDBool (*)(GDGetProcAddress, void*, GDInitialization*);
  const auto init = reinterpret_cast<Init>(::dlsym(library_, "voyager_godot_init"));
  initialized_ = init(GodotTables::get_proc_address, this, &initialization_) == 1;
  if (!initialized_) return;
  for (const auto level : {kGDLevelCore, kGDLevelServers, kGDLevelScene})
    if (level >= initialization_.minimum_initialization_level)
      initialization_.initialize(initialization_.userdata, level);
  splats_ = static_cast<GodotObject*>(classes_.at("VoyagerSplats").create_instance(nullptr));
}

ImitatedGodot::~ImitatedGodot() {
  if (splats_) {
    classes_.at("VoyagerSplats").free_instance(nullptr, splats_->instance);
    delete splats_;
    initialization_.deinitialize(initialization_.userdata, kGDLevelScene);
  }
  EXPECT_TRUE(classes_.empty()) << "left behind";
  EXPECT_EQ(live_values, 0) << "left behind";
  EXPECT_EQ(::dlclose(library_), 0) << ::dlerror();
  host_.reset();
  self = nullptr;
}

std::unique_ptr<GodotTexture> ImitatedGodot::make_texture(VkFormat format, uint32_t width,
                                                          uint32_t height) {
  ImageDesc desc;
  desc.format = format;
  desc.width = width;
  desc.height = height;
  desc.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  std::unique_ptr<GodotTexture> made(new GodotTexture{{*host_, desc}, ++next_rid_});
  textures_[made->rid] = made->image.image;
  const VkCommandBuffer commands = host_->begin();
  const HostImage& image = made->image;
  image.barrier(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkClearColorValue black = {};
  const VkImageSubresourceRange all = {desc.aspect, 0, 1, 0, 1};
  vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1,
                       &all);
  image.barrier(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  host_->finish(commands);
  return made;
}

void ImitatedGodot::ptrcall(const std::string& method, std::vector<const void*> arguments,
                            void* result) {
  const GDMethodInfo& info = methods_.at(method);
  ASSERT_EQ(arguments.size(), info.argument_count);
  info.ptrcall(info.userdata, splats_->instance, arguments.data(), result);
}

std::string ImitatedGodot::text(const std::string& method) {
  uint64_t string;
  GodotText::make(&string, "");  // which the method assigns
  ptrcall(method, {}, &string);
  const std::string found = GodotText::at(&string);
  GodotText::destroy(&string);
  return found;
}

void ImitatedGodot::open_scene(const std::string& path) {
  uint64_t string;
  GodotText::make(&string, path);
  ptrcall("open_scene", {&string}, nullptr);
  GodotText::destroy(&string);
}

bool ImitatedGodot::draw(GodotObject* device, uint64_t colour, uint64_t depth,
                         std::array<int32_t, 2> size, const std::array<float, 12>& camera,
                         const std::array<float, 16>& projection) {
  GDBool drawn = 0;
  ptrcall("draw", {&device, &colour, &depth, size.data(), camera.data(), projection.data()},
          &drawn);
  return drawn == 1;
}

GodotVariant ImitatedGodot::call(const std::string& method,
                                 const std::vector<GodotVariant>& arguments, GDCallError* error) {
  std::vector<const void*> pointers;
  for (const GodotVariant& each : arguments) pointers.push_back(&each);
  GodotVariant result;
  const GDMethodInfo& info = methods_.at(method);
  info.call(info.userdata, splats_->instance, pointers.data(),
            static_cast<int64_t>(pointers.size()), &result, error);
  return result;
}

bool ImitatedGodot::shoot(const GodotCamera& camera, GodotTexture& colour, GodotTexture& depth) {
  const ImageDesc& desc = colour.image.desc;
  const std::array<int32_t, 2> size = {static_cast<int32_t>(desc.width),
                                       static_cast<int32_t>(desc.height)};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!draw(&rendering_device_, colour.rid, depth.rid, size, camera.transform(),
               camera.projection())) {
    if (!last_error().empty() || std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

std::vector<uint8_t> ImitatedGodot::read(const GodotTexture& texture) {
  const ImageDesc& desc = texture.image.desc;
  const size_t bytes = size_t{4} * desc.width * desc.height;
  const MappedBuffer into(*host_, bytes);
  const VkCommandBuffer commands = host_->begin();
  texture.image.barrier(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  copy_to_buffer(commands, texture.image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 {desc.width, desc.height}, 0, desc.aspect, into);
  texture.image.barrier(commands, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  host_->finish(commands);
  return into.read<uint8_t>(bytes);
}

}  // namespace voyager::test
