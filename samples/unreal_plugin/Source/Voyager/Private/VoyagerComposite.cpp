#include "VoyagerComposite.h"

namespace {

bool VulkanSucceeded(VkResult Result, const TCHAR* Call, FString& Error) {
  if (Result == VK_SUCCESS) return true;
  Error = FString::Printf(TEXT("%s: found VkResult %d, expected VK_SUCCESS"), Call,
                          static_cast<int32>(Result));
  return false;
}

VkSubpassDependency Dependency(bool bBefore) {
  const VkPipelineStageFlags Drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                       VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                       VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  const VkAccessFlags Access =
      VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
      VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  if (bBefore)
    return {VK_SUBPASS_EXTERNAL,
            0,
            VK_PIPELINE_STAGE_TRANSFER_BIT,
            Drawing,
            VK_ACCESS_TRANSFER_WRITE_BIT,
            Access,
            0};
  return {0,      VK_SUBPASS_EXTERNAL,          Drawing, VK_PIPELINE_STAGE_TRANSFER_BIT,
          Access, VK_ACCESS_TRANSFER_WRITE_BIT, 0};
}

VkAttachmentDescription Attachment(VkFormat Format) {
  return {0,
          Format,
          VK_SAMPLE_COUNT_1_BIT,
          VK_ATTACHMENT_LOAD_OP_LOAD,
          VK_ATTACHMENT_STORE_OP_STORE,
          VK_ATTACHMENT_LOAD_OP_LOAD,
          VK_ATTACHMENT_STORE_OP_STORE,
          VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
          VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
}

}  // namespace

FVoyagerAttachments::~FVoyagerAttachments() {
  Functions.DestroyFramebuffer(Functions.Device, Framebuffer, nullptr);
  for (const VkImageView View : Views) Functions.DestroyImageView(Functions.Device, View, nullptr);
}

TSharedPtr<FVoyagerComposite> FVoyagerComposite::Create(const FVoyagerVulkanFunctions& Functions,
                                                        VoyDevice Device, VkFormat Color,
                                                        VkFormat Depth, FString& Error) {
  TSharedPtr<FVoyagerComposite> Made = MakeShareable(new FVoyagerComposite(Functions));
  Made->ColorFormat = Color;
  Made->DepthFormat = Depth;
  if (!VulkanSucceeded(Made->CreateRenderPass(), TEXT("vkCreateRenderPass"), Error)) return nullptr;
  VoyVulkanCompositeDesc Desc = VOY_VULKAN_COMPOSITE_DESC_INIT;
  Desc.renderPass = Made->Pass;
  Desc.colorFormat = Color;
  Desc.depthFormat = Depth;
  if (!VoyagerSucceeded(voyCreateVulkanComposite(Device, &Desc, Made->Composite.Receive()), Error))
    return nullptr;
  return Made;
}

FVoyagerComposite::~FVoyagerComposite() {
  Composite.Reset();
  Functions.DestroyRenderPass(Functions.Device, Pass, nullptr);
}

VkResult FVoyagerComposite::CreateRenderPass() {
  const VkAttachmentDescription Attachments[] = {Attachment(ColorFormat), Attachment(DepthFormat)};
  const VkAttachmentReference Color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkAttachmentReference Depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  const VkSubpassDependency Dependencies[] = {Dependency(true), Dependency(false)};
  VkSubpassDescription Subpass = {};
  Subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  Subpass.colorAttachmentCount = 1;
  Subpass.pColorAttachments = &Color;
  Subpass.pDepthStencilAttachment = &Depth;
  VkRenderPassCreateInfo Info = {};
  Info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  Info.attachmentCount = 2;
  Info.pAttachments = Attachments;
  Info.subpassCount = 1;
  Info.pSubpasses = &Subpass;
  Info.dependencyCount = 2;
  Info.pDependencies = Dependencies;
  return Functions.CreateRenderPass(Functions.Device, &Info, nullptr, &Pass);
}

TSharedPtr<FVoyagerAttachments> FVoyagerComposite::Attach(const FVulkanRHIImageViewInfo& Color,
                                                          const FVulkanRHIImageViewInfo& Depth,
                                                          const VkExtent2D& Extent,
                                                          FString& Error) const {
  TSharedPtr<FVoyagerAttachments> Made = MakeShared<FVoyagerAttachments>(Functions);
  const FVulkanRHIImageViewInfo* Textures[] = {&Color, &Depth};
  for (int32 i = 0; i < 2; ++i) {
    VkImageViewCreateInfo Info = {};
    Info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    Info.image = Textures[i]->Image;
    Info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    Info.format = Textures[i]->Format;
    Info.subresourceRange = {Textures[i]->SubresourceRange.aspectMask, 0, 1, 0, 1};
    if (!VulkanSucceeded(
            Functions.CreateImageView(Functions.Device, &Info, nullptr, &Made->Views[i]),
            TEXT("vkCreateImageView"), Error))
      return nullptr;
  }
  VkFramebufferCreateInfo Info = {};
  Info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
  Info.renderPass = Pass;
  Info.attachmentCount = 2;
  Info.pAttachments = Made->Views;
  Info.width = Extent.width;
  Info.height = Extent.height;
  Info.layers = 1;
  if (!VulkanSucceeded(
          Functions.CreateFramebuffer(Functions.Device, &Info, nullptr, &Made->Framebuffer),
          TEXT("vkCreateFramebuffer"), Error))
    return nullptr;
  return Made;
}

TSharedPtr<FVoyagerAttachments> FVoyagerComposite::Record(VkCommandBuffer Commands,
                                                          const FVulkanRHIImageViewInfo& Color,
                                                          const FVulkanRHIImageViewInfo& Depth,
                                                          VoyVulkanCompositeDraw Draw,
                                                          FString& Error) const {
  const VkExtent2D Extent = {static_cast<uint32_t>(Draw.area.offset.x) + Draw.area.extent.width,
                             static_cast<uint32_t>(Draw.area.offset.y) + Draw.area.extent.height};
  TSharedPtr<FVoyagerAttachments> Made = Attach(Color, Depth, Extent, Error);
  if (!Made) return nullptr;
  VkRenderPassBeginInfo Begin = {};
  Begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  Begin.renderPass = Pass;
  Begin.framebuffer = Made->Framebuffer;
  Begin.renderArea = {{0, 0}, Extent};
  Draw.commandBuffer = Commands;
  Functions.BeginRenderPass(Commands, &Begin, VK_SUBPASS_CONTENTS_INLINE);
  VoyagerSucceeded(voyRecordVulkanComposite(Composite.Get(), &Draw), Error);
  Functions.EndRenderPass(Commands);
  return Made;  // also after an error: the pass is recorded
}
