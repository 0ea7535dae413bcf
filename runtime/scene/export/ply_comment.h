#pragma once
#include "runtime/scene/native_scale.h"

namespace voyager {

// A line of a .ply's header that says what compensated filter a scene was trained with, as trainers
// write it: Brush's and Mip-Splatting's, or 3DGS's. "" for another scene.
inline const char* filter_comment(const NativeScale& native) {
  if (!native.antialiased()) return "";
  return native.low_pass == kMipSplattingLowPass ? "comment SplatRenderMode: mip\n"
                                                 : "comment antialiased 1\n";
}

}  // namespace voyager
