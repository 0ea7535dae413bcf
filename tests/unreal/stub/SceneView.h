#pragma once
#include "CoreMinimal.h"

struct FViewMatrices {
  const FVector& GetViewOrigin() const { return StubOrigin; }
  const FMatrix& GetInvViewMatrix() const { return StubViewToWorld; }
  const FMatrix& GetProjectionNoAAMatrix() const { return StubProjection; }

  FVector StubOrigin;
  FMatrix StubViewToWorld, StubProjection;
};

class FSceneView {
 public:
  FViewMatrices ViewMatrices;
  FIntRect StubRawRect;
};
