#pragma once
// From Unreal's cameras to Voyager's. Unreal's world is left-handed: x forward, y right, z up,
// centimetres. A scene has x right, y down, z forward, metres. So (x, y, z) of the scene stands at
// 100·(z, x, -y) from the scene's origin.
#include <voyager/voyager.h>

#include "CoreMinimal.h"

struct FVoyagerCamera {
  VoyPose Pose;
  VoyFrustum Frustum;
  double NearZ, FarZ;  // metres; FarZ may be infinite
};

// Eye: FViewMatrices::GetViewOrigin. ViewToWorld: GetInvViewMatrix, of which the rotation is used;
// its rows are the view's right, up and forward. Projection: GetProjectionNoAAMatrix, a perspective
// with reversed Z. Origin: of the scene, as Eye in world centimetres. Differences are taken in
// double before anything is scaled.
FVoyagerCamera MakeVoyagerCamera(const FVector& Eye, const FMatrix& ViewToWorld,
                                 const FMatrix& Projection, const FVector& Origin);
