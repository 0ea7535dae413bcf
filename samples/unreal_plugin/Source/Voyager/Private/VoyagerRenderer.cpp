#include "VoyagerRenderer.h"

#include "VoyagerAxes.h"

TSharedPtr<FVoyagerRenderer> FVoyagerRenderer::Create(FString& Error) {
  FVoyagerDeviceHandle Made;
  if (!CreateVoyagerDevice(Made.Receive(), Error)) return nullptr;
  TSharedPtr<FVoyagerRenderer> Renderer = MakeShared<FVoyagerRenderer>();
  Renderer->Device.Swap(Made);
  return Renderer;
}

FVoyagerRenderer::~FVoyagerRenderer() {
  Functions.WaitIdle(Functions.Device);
}

bool FVoyagerRenderer::OpenScene(const FString& Path, const FVector& InOrigin, FString& Error) {
  const auto Utf8 = StringCast<UTF8CHAR>(*Path);
  VoySceneDesc Desc = VOY_SCENE_DESC_INIT;
  Desc.path = reinterpret_cast<const char*>(Utf8.Get());
  FVoyagerSceneHandle Opened;
  if (!VoyagerSucceeded(voyOpenScene(Device.Get(), &Desc, Opened.Receive()), Error)) return false;
  FScopeLock Lock(&Mutex);
  View.Reset();
  ViewSize = FIntPoint(0, 0);
  Scene.Swap(Opened);
  Origin = InOrigin;
  return true;
}

void FVoyagerRenderer::CloseScene() {
  FScopeLock Lock(&Mutex);
  View.Reset();
  ViewSize = FIntPoint(0, 0);
  Scene.Reset();
}

bool FVoyagerRenderer::Draw(VkCommandBuffer Commands, const FVoyagerViewFrame& Frame,
                            const FVulkanRHIImageViewInfo& Color,
                            const FVulkanRHIImageViewInfo& Depth, const FGPUFenceRHIRef& Fence,
                            FString& Error) {
  FScopeLock Lock(&Mutex);
  if (!Scene.Get()) return true;
  if (Frame.Projection.M[2][3] != 1) {
    Error = TEXT("found an orthographic view, expected a perspective");
    return false;
  }
  FreeRetired();
  const FIntPoint Size = Frame.Area.Size();
  bool bNew = false;
  if (!FitComposite(Color.Format, Depth.Format, Error) || !FitView(Size, Error) ||
      !FitImages(Commands, Size, Fence, bNew, Error))
    return false;
  LastFence = Fence;
  if (bNew) return true;
  const FVoyagerCamera Camera =
      MakeVoyagerCamera(Frame.Eye, Frame.ViewToWorld, Frame.Projection, Origin);
  VoyFrameEye Eye = VOY_FRAME_EYE_INIT;
  Eye.pose = Camera.Pose;
  Eye.frustum = Camera.Frustum;
  Eye.target = Images->GetTarget();
  const int32 Image = Images->Acquire(Commands, View.Get(), Eye, Camera.NearZ, Error);
  if (Image == INDEX_NONE) return Error.IsEmpty();
  VoyVulkanCompositeDraw Draw = VOY_VULKAN_COMPOSITE_DRAW_INIT;
  Draw.target = Images->GetTarget();
  Draw.imageIndex = static_cast<uint32_t>(Image);
  Draw.area = {{Frame.Area.Min.X, Frame.Area.Min.Y},
               {static_cast<uint32_t>(Size.X), static_cast<uint32_t>(Size.Y)}};
  Draw.depthUse = VOY_VULKAN_DEPTH_USE_TEST;
  Draw.depthEncoding = VOY_DEPTH_ENCODING_REVERSED;
  Draw.nearZ = Camera.NearZ;
  Draw.farZ = Camera.FarZ;
  Retired.Add({Fence, Composite->Record(Commands, Color, Depth, Draw, Error), nullptr, nullptr});
  return Images->Release(Commands, Image, Fence, Error) && Error.IsEmpty();
}

bool FVoyagerRenderer::FitComposite(VkFormat Color, VkFormat Depth, FString& Error) {
  if (Composite && Composite->Fits(Color, Depth)) return true;
  if (Composite) Retired.Add({LastFence, nullptr, nullptr, Composite});
  Composite = FVoyagerComposite::Create(Functions, Device.Get(), Color, Depth, Error);
  return Composite.IsValid();
}

// A view keeps its cut: another is made only where the image outgrows it.
bool FVoyagerRenderer::FitView(const FIntPoint& Size, FString& Error) {
  if (Size.X <= ViewSize.X && Size.Y <= ViewSize.Y) return true;
  const FIntPoint Larger(FMath::Max(Size.X, ViewSize.X), FMath::Max(Size.Y, ViewSize.Y));
  const VoyScene Scenes[] = {Scene.Get()};
  VoyViewDesc Desc = VOY_VIEW_DESC_INIT;
  Desc.instanceCount = 1;
  Desc.scenes = Scenes;
  Desc.maxWidth = static_cast<uint32_t>(Larger.X);
  Desc.maxHeight = static_cast<uint32_t>(Larger.Y);
  ViewSize = FIntPoint(0, 0);  // also if the view cannot be made
  if (!VoyagerSucceeded(voyCreateView(Device.Get(), &Desc, View.Receive()), Error)) return false;
  ViewSize = Larger;
  return true;
}

// bNew: Voyager has all images now, and nothing can be drawn in this frame.
bool FVoyagerRenderer::FitImages(VkCommandBuffer Commands, const FIntPoint& Size,
                                 const FGPUFenceRHIRef& Fence, bool& bNew, FString& Error) {
  if (Images && Images->GetSize() == Size) return true;
  if (Images) Retired.Add({LastFence, nullptr, Images, nullptr});
  Images = FVoyagerImages::Create(Device.Get(), Size,
                                  GetIVulkanDynamicRHI()->RHIGetGraphicsQueueFamilyIndex(), Error);
  bNew = true;
  if (!Images) return false;
  if (Images->ReleaseAll(Commands, Fence, Error)) return true;
  Retired.Add({Fence, nullptr, Images, nullptr});
  Images.Reset();
  return false;
}

void FVoyagerRenderer::FreeRetired() {
  Retired.RemoveAll(
      [](const FRetired& Each) { return !Each.Fence.IsValid() || Each.Fence->Poll(); });
}
