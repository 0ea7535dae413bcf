// Around the C++ of docs/unreal.md: what Unreal and the game's own header have before, against the
// stub of Unreal.
#include "CoreMinimal.h"

DEFINE_LOG_CATEGORY_STATIC(LogTemp, Log, All);

class AGameMode {
 public:
  virtual ~AGameMode() = default;
  virtual void BeginPlay() {}
};
class AMyGameMode : public AGameMode {
 public:
  using Super = AGameMode;
  void BeginPlay() override;
};
#include "snippet.h"
