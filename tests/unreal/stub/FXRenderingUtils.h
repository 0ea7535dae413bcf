#pragma once
#include "SceneView.h"

namespace UE::FXRenderingUtils {
inline FIntRect GetRawViewRectUnsafe(const FSceneView& View) {
  return View.StubRawRect;
}
}  // namespace UE::FXRenderingUtils
