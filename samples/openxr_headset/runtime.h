#pragma once
// The OpenXR instance, its headset, and which of the optional extensions there are.
#include <string>

#include "xr.h"
#include "xr_validation.h"

namespace host {

inline constexpr XrViewConfigurationType kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
// Two pictures an eye, in the order left, right, left inner, right inner: the outer ones show all
// that the eye sees, the inner ones its middle with finer pixels. OpenXR 1.1 calls the same number
// PRIMARY_STEREO_WITH_FOVEATED_INSET.
inline constexpr XrViewConfigurationType kQuadViews = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;
inline constexpr uint32_t kEyes = 2, kMostViews = 2 * kEyes;

class Runtime {
 public:
  // quad_views: with kQuadViews, else with kStereo; throws Failure where there is no such
  // configuration. validation may be NULL. Waits for a headset that is not there yet, 30 s at
  // most; throws Lost where that is interrupted.
  Runtime(bool quad_views, XrValidation* validation);

  XrInstance get() const { return instance_.get(); }
  XrSystemId system() const { return system_; }
  const std::string& name() const { return name_; }  // of the runtime, with its version
  XrEnvironmentBlendMode blend_mode() const { return blend_mode_; }
  XrViewConfigurationType view_configuration() const { return view_configuration_; }
  uint32_t view_count() const { return view_configuration_ == kQuadViews ? kMostViews : kEyes; }
  bool has_depth_layer() const { return depth_layer_; }
  bool has_visibility_mask() const { return visibility_mask_; }

  // Asks for the headset anew, as a session that was lost wants it. False where it is another
  // than before: then what was made for that one is of no use.
  bool find_headset_again();
  // False: no more events for now.
  bool poll(XrEventDataBuffer& event) const;
  // The recommended ones, view_count() of them.
  std::vector<XrViewConfigurationView> views() const;

  template <class Function>
  Function function(const char* name) const {
    PFN_xrVoidFunction found = nullptr;
    check(xrGetInstanceProcAddr(instance_.get(), name, &found), name);
    return reinterpret_cast<Function>(found);
  }

 private:
  void create(XrValidation* validation);
  void find_headset();

  const XrViewConfigurationType view_configuration_;
  UniqueXrInstance instance_;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  std::string name_;
  XrEnvironmentBlendMode blend_mode_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  bool depth_layer_ = false, visibility_mask_ = false;
};

}  // namespace host
