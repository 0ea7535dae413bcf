#pragma once
// What a game calls: IVoyagerModule::Get().OpenScene(TEXT("/data/city.voy"), FVector(0, 0, 0)).
#include "CoreMinimal.h"
#include "Modules/ModuleManager.h"

class IVoyagerModule : public IModuleInterface {
 public:
  static IVoyagerModule& Get() {
    return FModuleManager::LoadModuleChecked<IVoyagerModule>(TEXT("Voyager"));
  }

  // Opens a scene in place of the one before: a file or a URL. Blocks until it is open. Origin is
  // where the scene's origin stands in the world, in centimetres. On the game thread, after the
  // engine has started. Returns false with an error.
  virtual bool OpenScene(const FString& Path, const FVector& Origin) = 0;
  virtual void CloseScene() = 0;

  // The last error of any call or frame; empty if there was none. On any thread. Errors never stop
  // the engine: the frame lacks the splats, and the log has the message once.
  virtual FString GetLastError() const = 0;
};
