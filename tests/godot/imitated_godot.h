#pragma once
// Godot as a GDExtension meets it, on a real Vulkan device: the interface by get_proc_address, the
// class list, RenderingDevice's native handles, and frames that are submitted after the callback.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "../interop/vulkan_memory.h"
#include "godot_interface.h"
#include "tests/godot/godot_camera.h"
#include "tests/godot/godot_values.h"

namespace voyager::test {

struct GodotHabits {
  bool enables_extensions = false;  // those that Voyager can use; Godot 4.3 enables none of them
  std::string lacks;                // a function that get_proc_address does not know
};

struct GodotObject {
  std::string class_name;
  void* instance = nullptr;
};

// A texture that was created with data: it is in SHADER_READ_ONLY_OPTIMAL whenever Godot records.
struct GodotTexture {
  HostImage image;
  uint64_t rid;
};

// One at a time.
class ImitatedGodot {
 public:
  explicit ImitatedGodot(const GodotHabits& habits = {});
  // Frees the splats and unloads the extension. Expects no validation message and no value left.
  ~ImitatedGodot();
  ImitatedGodot(const ImitatedGodot&) = delete;
  ImitatedGodot& operator=(const ImitatedGodot&) = delete;

  bool has_device() const { return host_ && host_->exists(); }
  bool initialized() const { return initialized_; }
  bool has_class(const std::string& name) const { return classes_.count(name) == 1; }
  bool has_method(const std::string& name) const { return methods_.count(name) == 1; }
  // Of a method that there is.
  size_t argument_count(const std::string& name) const { return methods_.at(name).argument_count; }
  GodotObject* rendering_device() { return &rendering_device_; }

  std::unique_ptr<GodotTexture> make_texture(VkFormat format, uint32_t width, uint32_t height);

  // Methods of a VoyagerSplats, by ptrcall, as typed scripts call them.
  void open_scene(const std::string& path);
  void close_scene() { ptrcall("close_scene", {}, nullptr); }
  bool draw(GodotObject* device, uint64_t colour, uint64_t depth, std::array<int32_t, 2> size,
            const std::array<float, 12>& camera, const std::array<float, 16>& projection);
  std::string last_error() { return text("last_error"); }
  std::string mode() { return text("mode"); }
  // The same with Variants, as untyped scripts call them.
  GodotVariant call(const std::string& method, const std::vector<GodotVariant>& arguments,
                    GDCallError* error);

  // Frames until the scene is open and the textures hold this camera's picture, or an error.
  bool shoot(const GodotCamera& camera, GodotTexture& colour, GodotTexture& depth);
  // A frame of Godot's, which samples the texture: its bytes, four a pixel.
  std::vector<uint8_t> read(const GodotTexture& texture);

 private:
  friend struct GodotTables;
  void ptrcall(const std::string& method, std::vector<const void*> arguments, void* result);
  std::string text(const std::string& method);

  GodotHabits habits_;
  void* library_ = nullptr;
  GDInitialization initialization_ = {};
  bool initialized_ = false;
  std::unique_ptr<VulkanHost> host_;
  std::map<std::string, GDClassInfo> classes_;
  std::map<std::string, GDMethodInfo> methods_;  // of VoyagerSplats
  std::map<uint64_t, VkImage> textures_;
  uint64_t next_rid_ = 1000;
  GodotObject rendering_device_ = {"RenderingDevice"};
  GodotObject* splats_ = nullptr;
};

}  // namespace voyager::test
