#include "VoyagerModule.h"

#include "Misc/CoreDelegates.h"
#include "RenderingThread.h"
#include "VoyagerErrors.h"
#include "VoyagerRenderer.h"
#include "VoyagerViewExtension.h"
#include "VoyagerVulkan.h"

class FVoyagerModule : public IVoyagerModule {
 public:
  void StartupModule() override {
    RequestVoyagerVulkanExtensions();
    // Unreal destroys its device before it unloads modules that were loaded before the device.
    FCoreDelegates::OnEnginePreExit.AddRaw(this, &FVoyagerModule::Stop);
  }
  void ShutdownModule() override {
    FCoreDelegates::OnEnginePreExit.RemoveAll(this);
    Stop();
  }

  bool OpenScene(const FString& Path, const FVector& Origin) override {
    FString Error;
    if (Start(Error) && Renderer->OpenScene(Path, Origin, Error)) return true;
    Errors->Report(Error);
    return false;
  }
  void CloseScene() override {
    if (Renderer) Renderer->CloseScene();
  }
  FString GetLastError() const override { return Errors->GetLast(); }

 private:
  bool Start(FString& Error) {
    if (Renderer) return true;
    Renderer = FVoyagerRenderer::Create(Error);
    if (!Renderer) return false;
    Extension = FSceneViewExtensions::NewExtension<FVoyagerViewExtension>(Renderer, Errors);
    return true;
  }
  void Stop() {
    Extension.Reset();
    FlushRenderingCommands();  // frames in flight hold the renderer
    Renderer.Reset();
  }

  TSharedPtr<FVoyagerErrors> Errors = MakeShared<FVoyagerErrors>();
  TSharedPtr<FVoyagerRenderer> Renderer;
  TSharedPtr<FVoyagerViewExtension, ESPMode::ThreadSafe> Extension;
};

IMPLEMENT_MODULE(FVoyagerModule, Voyager)
