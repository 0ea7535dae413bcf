#include "tests/unreal/imitated_unreal.h"

#include <algorithm>
#include <codecvt>
#include <locale>
#include <thread>

#include "IVulkanDynamicRHI.h"
#include "Misc/CoreDelegates.h"
#include "PostProcess/PostProcessMaterialInputs.h"
#include "RenderingThread.h"
#include "SceneViewExtension.h"

IModuleInterface* StubInitializeVoyager();

namespace voyager::test {
namespace {

ImitatedUnreal* self = nullptr;

struct ImitatedFence : FRHIGPUFence {
  VkDevice device = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;  // of the submission that it was written in
  bool passed = false;
  bool Poll() const override {
    return passed || (fence != VK_NULL_HANDLE && vkGetFenceStatus(device, fence) == VK_SUCCESS);
  }
};

}  // namespace

class ImitatedRhi : public IVulkanDynamicRHI {
 public:
  explicit ImitatedRhi(const ImitatedUnreal& unreal) : unreal_(unreal) {}
  ERHIInterfaceType GetInterfaceType() const override {
    return unreal_.habits_.draws_with_vulkan ? ERHIInterfaceType::Vulkan : ERHIInterfaceType::D3D12;
  }
  uint32 RHIGetVulkanVersion() const override { return host().creation.api_version; }
  VkInstance RHIGetVkInstance() const override { return host().instance; }
  VkDevice RHIGetVkDevice() const override { return host().device; }
  VkPhysicalDevice RHIGetVkPhysicalDevice() const override { return host().physical; }
  uint32 RHIGetGraphicsQueueFamilyIndex() const override { return host().family; }
  VkCommandBuffer RHIGetActiveVkCommandBuffer() override { return unreal_.commands_; }
  VkCommandBuffer RHIGetVkCommandBuffer(FRHICommandListBase&) const override {
    return unreal_.commands_;
  }
  void* RHIGetVkDeviceProcAddr(const char* name) const override {
    return reinterpret_cast<void*>(vkGetDeviceProcAddr(host().device, name));
  }
  void* RHIGetVkInstanceProcAddr(const char* name) const override {
    return reinterpret_cast<void*>(vkGetInstanceProcAddr(host().instance, name));
  }
  TArray<FAnsiString> RHIGetLoadedDeviceExtensions() const override {
    TArray<FAnsiString> names;
    for (const char* name : host().extensions) names.Add(name);
    return names;
  }
  FVulkanRHIImageViewInfo RHIGetImageViewInfo(FRHITexture* texture) const override {
    const ImageDesc& desc = texture->image.desc;
    return {VK_NULL_HANDLE,
            texture->image.image,
            {desc.aspect, 0, 1, 0, 1},
            desc.format,
            desc.width,
            desc.height,
            1};
  }
  void RHIFinishExternalComputeWork(VkCommandBuffer commands) override {
    EXPECT_EQ(commands, unreal_.commands_);
  }

 private:
  const VulkanHost& host() const { return *unreal_.host_; }
  const ImitatedUnreal& unreal_;
};

// The functions of the stub, which know no object.
struct StubAccess {
  static void request(TArrayView<const ANSICHAR* const> names) {
    EXPECT_EQ(self->host_, nullptr) << "too late";
    for (int32 i = 0; i < names.Num(); ++i) self->requested_.emplace_back(names[i]);
  }
  static void log(const std::string& line) { self->log_.push_back(line); }
  // Of a picture of the same size and format.
  static void copy(FRHITexture& from, FRHITexture& to) {
    self->use(from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const ImageDesc& desc = from.image.desc;
    const VkImageSubresourceLayers layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageCopy whole = {layers, {}, layers, {}, {desc.width, desc.height, 1}};
    vkCmdCopyImage(self->commands_, from.image.image, from.layout, to.image.image, to.layout, 1,
                   &whole);
  }
  static IModuleInterface* module() { return self->module_.get(); }
};

ImitatedUnreal::ImitatedUnreal(const UnrealHabits& habits) : habits_(habits) {
  self = this;
  module_.reset(StubInitializeVoyager());
  module_->StartupModule();
  VulkanCreation how;
  how.asks_voyager = false;
  // Unreal leaves out what the device does not have.
  const VulkanHost probe;
  for (const std::string& name : requested_)
    if (habits.enables_requested &&
        std::find(probe.extensions.begin(), probe.extensions.end(), name) != probe.extensions.end())
      how.extensions.push_back(name.c_str());
  host_ = std::make_unique<VulkanHost>(how);
  rhi_ = std::make_unique<ImitatedRhi>(*this);
  GDynamicRHI = rhi_.get();
}

ImitatedUnreal::~ImitatedUnreal() {
  if (has_device()) {
    FCoreDelegates::OnEnginePreExit.Broadcast();
    EXPECT_TRUE(std::all_of(FSceneViewExtensions::StubExtensions.begin(),
                            FSceneViewExtensions::StubExtensions.end(),
                            [](const auto& extension) { return extension.expired(); }));
    finish(0);
  }
  host_.reset();
  GDynamicRHI = nullptr;
  module_->ShutdownModule();
  module_.reset();
  FSceneViewExtensions::StubExtensions.clear();
  self = nullptr;
}

std::string ImitatedUnreal::last_error() const {
  return Narrow(*module().GetLastError());
}

std::unique_ptr<FRHITexture> ImitatedUnreal::make_texture(VkFormat format, uint32_t width,
                                                          uint32_t height) const {
  return std::unique_ptr<FRHITexture>(
      new FRHITexture{{*host_, attachment(format, width, height)}, VK_IMAGE_LAYOUT_UNDEFINED});
}

void ImitatedUnreal::use(FRHITexture& texture, VkImageLayout layout) const {
  texture.image.barrier(commands_, texture.layout, layout);
  texture.layout = layout;
}

void ImitatedUnreal::clear(const UnrealView& view) const {
  FRHITexture& colour = *view.colour->GetRHI();
  use(colour, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkClearColorValue black = {};
  const VkImageSubresourceRange all = {colour.image.desc.aspect, 0, 1, 0, 1};
  vkCmdClearColorImage(commands_, colour.image.image, colour.layout, &black, 1, &all);
  FRHITexture& depth = *view.depth->GetRHI();
  use(depth, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkClearDepthStencilValue value = {view.cleared_depth, 0};
  const VkImageSubresourceRange both = {depth.image.desc.aspect, 0, 1, 0, 1};
  vkCmdClearDepthStencilImage(commands_, depth.image.image, depth.layout, &value, 1, &both);
}

void ImitatedUnreal::frame(const UnrealView& view) {
  finish(2);
  commands_ = host_->begin();
  clear(view);
  FRDGBuilder builder;
  FStubSceneTextureBuffer scene{{view.depth}};
  FPostProcessMaterialInputs inputs;
  inputs.StubColor = {view.colour, view.rect};
  inputs.SceneTextures.SceneTextures = &scene;
  if (view.override_output) inputs.OverrideOutput = {view.override_output, view.rect};
  for (const auto& weak : FSceneViewExtensions::StubExtensions) {
    const std::shared_ptr<ISceneViewExtension> extension = weak.lock();
    if (!extension) continue;
    using Pass = ISceneViewExtension::EPostProcessingPass;
    for (const Pass pass : {Pass::MotionBlur, Pass::Tonemap, Pass::FXAA}) {
      FAfterPassCallbackDelegateArray callbacks;
      extension->SubscribeToPostProcessingPass(pass, view.view, callbacks, true);
      for (const FAfterPassCallbackDelegate& callback : callbacks)
        EXPECT_EQ(callback.Execute(builder, view.view, inputs).Texture,
                  view.override_output ? view.override_output : view.colour);
    }
  }
  InFlight flight{host_->make_fence(), commands_, {}};
  in_flight_.push_back(flight);
  execute(builder, flight.fence);
  host_->submit(commands_, {}, {}, flight.fence);
  commands_ = VK_NULL_HANDLE;
}

// The passes run on the rendering thread, their commands on another.
void ImitatedUnreal::execute(FRDGBuilder& builder, VkFence fence) {
  FRHICommandListImmediate list;
  for (auto& pass : builder.StubPasses) {
    list.EnqueueLambda([this, &pass](FRHICommandListImmediate&) {
      for (const FStubTextureAccess& each : pass.Textures)
        use(*each.Texture->GetRHI(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);  // CopyDest
    });
    pass.Execute(list);
  }
  std::thread([&] { list.StubExecute(); }).join();
  for (const FGPUFenceRHIRef& each : list.Fences) {
    auto& written = static_cast<ImitatedFence&>(*each.GetReference());
    written.device = host_->device;
    written.fence = fence;
    in_flight_.back().written.push_back(std::make_shared<FGPUFenceRHIRef>(each));
  }
}

// Waits until at most so many frames are in flight.
void ImitatedUnreal::finish(size_t in_flight) {
  while (in_flight_.size() > in_flight) {
    InFlight& oldest = in_flight_.front();
    host_->wait_for(oldest.fence);
    for (const auto& each : oldest.written) {
      const auto& fence = *static_cast<FGPUFenceRHIRef*>(each.get());
      static_cast<ImitatedFence&>(*fence.GetReference()).passed = true;
    }
    vkDestroyFence(host_->device, oldest.fence, nullptr);
    vkFreeCommandBuffers(host_->device, host_->pool, 1, &oldest.commands);
    in_flight_.erase(in_flight_.begin());
  }
}

std::vector<uint8_t> ImitatedUnreal::read(FRHITexture& texture) {
  finish(0);
  const ImageDesc& desc = texture.image.desc;
  const size_t bytes = size_t{4} * desc.width * desc.height;
  const MappedBuffer into(*host_, bytes);
  commands_ = host_->begin();
  use(texture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  const VkImageAspectFlags aspect = desc.aspect & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT};
  copy_to_buffer(commands_, texture.image.image, texture.layout, {desc.width, desc.height}, 0,
                 aspect, into);
  host_->finish(commands_);
  commands_ = VK_NULL_HANDLE;
  return into.read<uint8_t>(bytes);
}

}  // namespace voyager::test

using voyager::test::StubAccess;

FDynamicRHI* GDynamicRHI = nullptr;
FSimpleMulticastDelegate FCoreDelegates::OnEnginePreExit;

std::string Narrow(const TCHAR* text) {
  return std::wstring_convert<std::codecvt_utf8_utf16<char16_t>, char16_t>().to_bytes(text);
}
std::u16string Widen(const std::string& text) {
  return std::wstring_convert<std::codecvt_utf8_utf16<char16_t>, char16_t>().from_bytes(text);
}
void StubLog(const char*, const FString& line) {
  StubAccess::log(Narrow(*line));
}
IModuleInterface* FModuleManager::FindModule(const TCHAR*) {
  return StubAccess::module();
}
FGPUFenceRHIRef RHICreateGPUFence(const TCHAR*) {
  return FGPUFenceRHIRef(std::make_shared<voyager::test::ImitatedFence>());
}
void FlushRenderingCommands() {}
void IVulkanDynamicRHI::AddEnabledInstanceExtensionsAndLayers(TArrayView<const ANSICHAR* const>,
                                                              TArrayView<const ANSICHAR* const>) {}
void IVulkanDynamicRHI::AddEnabledDeviceExtensionsAndLayers(TArrayView<const ANSICHAR* const> names,
                                                            TArrayView<const ANSICHAR* const>) {
  StubAccess::request(names);
}
void AddDrawTexturePass(FRDGBuilder& builder, const FSceneView&, FScreenPassTexture input,
                        FScreenPassRenderTarget output) {
  builder.StubPasses.push_back({"DrawTexture",
                                {{ERHIAccess::CopyDest, output.Texture}},
                                [input, output](FRHICommandListImmediate& list) {
                                  list.EnqueueLambda([input, output](FRHICommandListImmediate&) {
                                    StubAccess::copy(*input.Texture->GetRHI(),
                                                     *output.Texture->GetRHI());
                                  });
                                }});
}
