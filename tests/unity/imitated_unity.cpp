#include "tests/unity/imitated_unity.h"

#include <dlfcn.h>

#include <thread>

namespace voyager::test {
namespace {

ImitatedUnity* self = nullptr;
bool offers_extensions = true;

// A driver without extensions and timelines, as the loader would show it.
VKAPI_ATTR VkResult VKAPI_CALL no_extensions(VkPhysicalDevice, const char*, uint32_t* count,
                                             VkExtensionProperties*) {
  *count = 0;
  return VK_SUCCESS;
}
VKAPI_ATTR void VKAPI_CALL no_features(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* all) {
  vkGetPhysicalDeviceFeatures2(device, all);
  for (auto* next = static_cast<VkBaseOutStructure*>(all->pNext); next; next = next->pNext)
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES)
      reinterpret_cast<VkPhysicalDeviceTimelineSemaphoreFeatures*>(next)->timelineSemaphore =
          VK_FALSE;
}
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL loader(VkInstance instance, const char* name) {
  const std::string asked = name;
  if (!offers_extensions && asked == "vkEnumerateDeviceExtensionProperties")
    return reinterpret_cast<PFN_vkVoidFunction>(no_extensions);
  if (!offers_extensions && asked == "vkGetPhysicalDeviceFeatures2")
    return reinterpret_cast<PFN_vkVoidFunction>(no_features);
  return vkGetInstanceProcAddr(instance, name);
}

}  // namespace

// The functions in Unity's interfaces, which know no object.
struct UnityTables {
  static IUnityInterface* find(UnityInterfaceGUID guid) {
    const auto is = [&](UnityInterfaceGUID other) {
      return guid.m_GUIDHigh == other.m_GUIDHigh && guid.m_GUIDLow == other.m_GUIDLow;
    };
    if (is({0x7CBA0A9CA4DDB544ULL, 0x8C5AD4926EB17B11ULL})) return &graphics;
    if (is({0x95355348D4EF4E11ULL, 0x9789313DFCFFCC87ULL})) return &vulkan;
    if (is({0x329334C09DCA4787ULL, 0xB347DD92A0097FFCULL}) && self->habits_.has_v2) return &newer;
    return nullptr;
  }

  static UnityGfxRenderer renderer() {
    return self->host_ ? self->habits_.renderer : kUnityGfxRendererNull;
  }
  static void add_device_event(IUnityGraphicsDeviceEventCallback callback) {
    self->device_event_ = callback;
  }
  static void remove_device_event(IUnityGraphicsDeviceEventCallback callback) {
    if (self->device_event_ == callback) self->device_event_ = nullptr;
  }
  static int reserve_event_ids(int) { return 1000; }

  static bool intercept(UnityVulkanInitCallback callback, void*) {
    if (self->host_) return false;  // too late
    self->intercept_ = callback;
    return true;
  }
  static bool add_intercept(UnityVulkanInitCallback callback, void* user, int32_t) {
    return intercept(callback, user);
  }
  static void configure_event(int id, const UnityVulkanPluginEventConfig* config) {
    EXPECT_EQ(id, 1000);
    self->config_ = *config;
  }
  static UnityVulkanInstance instance() {
    UnityVulkanInstance out = {};
    out.instance = self->host_->instance;
    out.physicalDevice = self->host_->physical;
    out.device = self->host_->device;
    out.graphicsQueue = self->host_->queue;
    out.getInstanceProcAddr = loader;
    out.queueFamilyIndex = self->host_->family;
    return out;
  }
  static bool recording(UnityVulkanRecordingState* state, UnityVulkanGraphicsQueueAccess access) {
    EXPECT_EQ(access, kUnityVulkanGraphicsQueueAccess_DontCare);
    *state = {};
    state->commandBuffer = self->commands_;
    state->subPassIndex = -1;
    state->currentFrameNumber = self->frame_;
    state->safeFrameNumber = self->safe_;
    return self->commands_ != VK_NULL_HANDLE;
  }
  static bool access_texture(void* native, const VkImageSubresource*, VkImageLayout layout,
                             VkPipelineStageFlags, VkAccessFlags,
                             UnityVulkanResourceAccessMode mode, UnityVulkanImage* image) {
    auto& texture = *static_cast<UnityTexture*>(native);
    if (mode == kUnityVulkanResourceAccess_PipelineBarrier) self->use(texture, layout);
    *image = {};
    image->image = texture.image.image;
    image->layout = texture.layout;
    image->aspect = texture.image.desc.aspect;
    image->format = texture.image.desc.format;
    image->extent = {texture.image.desc.width, texture.image.desc.height, 1};
    image->samples = texture.samples;
    image->layers = image->mipCount = 1;
    return true;
  }
  static void access_queue(UnityRenderingEventAndData callback, int id, void* data, bool flush) {
    EXPECT_TRUE(flush) << "the signal is for commands of this frame";
    self->cut();
    self->queued_.emplace_back([callback, id, data] { callback(id, data); });
    if (!self->habits_.submits_on_thread) self->run_queued();
  }

  static inline IUnityInterfaces interfaces = {find, nullptr, nullptr, nullptr};
  static inline IUnityGraphics graphics = {
      {}, renderer, add_device_event, remove_device_event, reserve_event_ids};
  static inline IUnityGraphicsVulkan vulkan = {
      {},        intercept,      nullptr,      configure_event, instance,
      recording, access_texture, nullptr,      nullptr,         nullptr,
      nullptr,   nullptr,        access_queue, nullptr,         nullptr};
  static inline IUnityGraphicsVulkanV2 newer = {{}, {}, add_intercept, nullptr};
};

ImitatedUnity::ImitatedUnity(const UnityHabits& habits) : habits_(habits) {
  self = this;
  offers_extensions = habits.offers_extensions;
  if (habits.loads_at_startup) load_plugin();
  make_device();
  if (!has_device()) return;
  if (!habits.loads_at_startup) load_plugin();
  if (habits.loads_at_startup) device_event_(kUnityGfxDeviceEventInitialize);
}

ImitatedUnity::~ImitatedUnity() {
  if (has_device()) finish(frame_);
  if (device_event_) device_event_(kUnityGfxDeviceEventShutdown);
  if (library_) {
    unload_();
    EXPECT_EQ(device_event_, nullptr) << "left behind";
    EXPECT_EQ(::dlclose(library_), 0) << ::dlerror();
  }
  host_.reset();
  self = nullptr;
}

void ImitatedUnity::load_plugin() {
  library_ = ::dlopen(VOYAGER_UNITY_PLUGIN, RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(library_, nullptr) << ::dlerror();
  const auto find = [&](auto& function, const char* name) {
    function =
        reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(library_, name));
    ASSERT_NE(function, nullptr) << name;
  };
  find(open_scene, "voyUnityOpenScene");
  find(camera, "voyUnityCamera");
  find(render_event, "voyUnityRenderEvent");
  find(event_id, "voyUnityEventId");
  find(statistics, "voyUnityStatistics");
  find(unload_, "UnityPluginUnload");
  decltype(&UnityPluginLoad) load = nullptr;
  find(load, "UnityPluginLoad");
  load(&UnityTables::interfaces);
}

void ImitatedUnity::make_device() {
  VulkanCreation how;
  how.asks_voyager = false;
  how.api_version = habits_.api_version;
  how.loader = intercept_ ? intercept_(loader, nullptr) : loader;
  VkPhysicalDeviceVulkan12Features features = {};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features.hostQueryReset = VK_TRUE;
  if (habits_.chains_vulkan_1_2) how.features = &features;
  host_ = std::make_unique<VulkanHost>(how);
  host_->creation.features = nullptr;
}

std::string ImitatedUnity::last_error() const {
  const auto get =
      reinterpret_cast<decltype(&voyUnityLastError)>(::dlsym(library_, "voyUnityLastError"));
  char text[512];
  get(text, sizeof text);
  return text;
}

bool ImitatedUnity::has_depth(VkFormat format) const {
  VkFormatProperties properties = {};
  vkGetPhysicalDeviceFormatProperties(host_->physical, format, &properties);
  return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
}

std::unique_ptr<UnityTexture> ImitatedUnity::make_texture(VkFormat format, uint32_t width,
                                                          uint32_t height) {
  return std::unique_ptr<UnityTexture>(new UnityTexture{{*host_, attachment(format, width, height)},
                                                        VK_SAMPLE_COUNT_1_BIT,
                                                        VK_IMAGE_LAYOUT_UNDEFINED});
}

// As AccessTexture does: a barrier against all that came before.
void ImitatedUnity::use(UnityTexture& texture, VkImageLayout layout) {
  texture.image.barrier(commands_, texture.layout, layout);
  texture.layout = layout;
}

// Ends the command buffer, which is then submitted, and begins another.
void ImitatedUnity::cut() {
  queued_.emplace_back([this, ended = commands_] { host_->submit(ended, {}, {}); });
  commands_ = host_->begin();
  recorded_.push_back(commands_);
}

void ImitatedUnity::run_queued() {
  for (const std::function<void()>& each : queued_) each();
  queued_.clear();
}

void ImitatedUnity::clear(const UnityCameraEvent& event) {
  UnityTexture& colour = *event.colour;
  use(colour, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkClearColorValue black = {};
  const VkImageSubresourceRange all = {colour.image.desc.aspect, 0, 1, 0, 1};
  vkCmdClearColorImage(commands_, colour.image.image, colour.layout, &black, 1, &all);
  if (!event.depth) return;
  UnityTexture& depth = *event.depth;
  use(depth, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkClearDepthStencilValue value = {event.cleared_depth, 0};
  const VkImageSubresourceRange both = {depth.image.desc.aspect, 0, 1, 0, 1};
  vkCmdClearDepthStencilImage(commands_, depth.image.image, depth.layout, &value, 1, &both);
}

void ImitatedUnity::frame(const std::vector<UnityCameraEvent>& events) {
  ++frame_;
  if (frame_ > 2) finish(frame_ - 2);
  commands_ = host_->begin();
  recorded_ = {commands_};
  for (const UnityCameraEvent& event : events) {
    clear(event);
    render_event()(event_id(), event.data);
  }
  InFlight flight{frame_, host_->make_fence(), {}};
  queued_.emplace_back(
      [this, last = commands_, fence = flight.fence] { host_->submit(last, {}, {}, fence); });
  if (habits_.submits_on_thread)
    std::thread([this] { run_queued(); }).join();
  else
    run_queued();
  flight.commands = std::move(recorded_);
  in_flight_.push_back(std::move(flight));
  commands_ = VK_NULL_HANDLE;
}

// Waits until the GPU has finished all frames up to this one.
void ImitatedUnity::finish(uint64_t frame) {
  std::erase_if(in_flight_, [&](const InFlight& flight) {
    if (flight.frame > frame) return false;
    host_->wait_for(flight.fence);
    vkDestroyFence(host_->device, flight.fence, nullptr);
    vkFreeCommandBuffers(host_->device, host_->pool, static_cast<uint32_t>(flight.commands.size()),
                         flight.commands.data());
    return true;
  });
  safe_ = frame;
}

std::vector<uint8_t> ImitatedUnity::read(UnityTexture& texture) {
  finish(frame_);
  const size_t bytes = size_t{4} * texture.image.desc.width * texture.image.desc.height;
  const MappedBuffer into(*host_, bytes);
  commands_ = host_->begin();
  use(texture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  copy_to_buffer(commands_, texture.image.image, texture.layout,
                 {texture.image.desc.width, texture.image.desc.height}, 0,
                 VK_IMAGE_ASPECT_COLOR_BIT, into);
  host_->finish(commands_);
  commands_ = VK_NULL_HANDLE;
  const std::vector<uint8_t> upside_down = into.read<uint8_t>(bytes);
  std::vector<uint8_t> rows;
  const auto row = static_cast<std::ptrdiff_t>(size_t{4} * texture.image.desc.width);
  for (auto end = upside_down.end(); end != upside_down.begin(); end -= row)
    rows.insert(rows.end(), end - row, end);
  return rows;
}

}  // namespace voyager::test
