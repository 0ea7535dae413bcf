#include "session.h"

namespace host {
namespace {

UniqueXrSession make_session(const Runtime& runtime, const Graphics& graphics) {
  const XrGraphicsBindingVulkan2KHR binding = graphics.binding();
  XrSessionCreateInfo info = xr_struct<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
  info.next = &binding;
  info.systemId = runtime.system();
  XrSession session = XR_NULL_HANDLE;
  check(xrCreateSession(runtime.get(), &info, &session), "xrCreateSession");
  return UniqueXrSession(session);
}

// Where the head was when the session began, level: every runtime has it.
UniqueXrSpace make_local_space(XrSession session) {
  auto info = xr_struct<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
  info.poseInReferenceSpace.orientation.w = 1;
  XrSpace space = XR_NULL_HANDLE;
  check(xrCreateReferenceSpace(session, &info, &space), "xrCreateReferenceSpace");
  return UniqueXrSpace(space);
}

}  // namespace

Session::Session(const Runtime& runtime, const Graphics& graphics, const Input& input)
    : runtime_(runtime),
      session_(make_session(runtime, graphics)),
      local_(make_local_space(session_.get())) {
  input.attach(session_.get());
}

std::vector<int64_t> Session::swapchain_formats() const {
  return xr_list("xrEnumerateSwapchainFormats", int64_t{0},
                 [&](uint32_t capacity, uint32_t* size, int64_t* into) {
                   return xrEnumerateSwapchainFormats(get(), capacity, size, into);
                 });
}

void Session::handle(const XrEventDataSessionStateChanged& event) {
  if (event.session != get()) return;  // of one that was destroyed
  state_ = event.state;
  switch (state_) {
    case XR_SESSION_STATE_READY: {
      XrSessionBeginInfo info = xr_struct<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
      info.primaryViewConfigurationType = runtime_.view_configuration();
      check(xrBeginSession(get(), &info), "xrBeginSession");
      running_ = true;
      ++begun_;
      break;
    }
    case XR_SESSION_STATE_STOPPING:
      check(xrEndSession(get()), "xrEndSession");
      running_ = false;
      break;
    case XR_SESSION_STATE_LOSS_PENDING:
      throw Lost(Lost::session, "the runtime says that the session will be lost");
    default:  // also states of later versions
      break;
  }
}

void Session::request_exit() {
  check(xrRequestExitSession(get()), "xrRequestExitSession");
}

XrFrameState Session::wait_frame() const {
  const XrFrameWaitInfo info = xr_struct<XrFrameWaitInfo>(XR_TYPE_FRAME_WAIT_INFO);
  XrFrameState state = xr_struct<XrFrameState>(XR_TYPE_FRAME_STATE);
  check(xrWaitFrame(get(), &info, &state), "xrWaitFrame");
  return state;
}

void Session::begin_frame() const {
  const XrFrameBeginInfo info = xr_struct<XrFrameBeginInfo>(XR_TYPE_FRAME_BEGIN_INFO);
  check(xrBeginFrame(get(), &info), "xrBeginFrame");  // XR_FRAME_DISCARDED has begun this one too
}

void Session::end_frame(XrTime display_time, const XrCompositionLayerProjection* layer) const {
  const auto* header = reinterpret_cast<const XrCompositionLayerBaseHeader*>(layer);
  XrFrameEndInfo info = xr_struct<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
  info.displayTime = display_time;
  info.environmentBlendMode = runtime_.blend_mode();
  info.layerCount = layer ? 1 : 0;
  info.layers = layer ? &header : nullptr;
  check(xrEndFrame(get(), &info), "xrEndFrame");
}

std::optional<Located> Session::locate(XrTime display_time) const {
  XrViewLocateInfo info = xr_struct<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
  info.viewConfigurationType = runtime_.view_configuration();
  info.displayTime = display_time;
  info.space = local();
  XrViewState state = xr_struct<XrViewState>(XR_TYPE_VIEW_STATE);
  Views views(runtime_.view_count(), xr_struct<XrView>(XR_TYPE_VIEW));
  uint32_t count = 0;
  check(xrLocateViews(get(), &info, &state, runtime_.view_count(), &count, views.data()),
        "xrLocateViews");
  if (count != runtime_.view_count() ||
      !(state.viewStateFlags & XR_VIEW_STATE_ORIENTATION_VALID_BIT))
    return std::nullopt;
  return Located{views, (state.viewStateFlags & XR_VIEW_STATE_POSITION_VALID_BIT) != 0};
}

const char* state_name(XrSessionState state) {
  switch (state) {
    case XR_SESSION_STATE_IDLE:
      return "IDLE";
    case XR_SESSION_STATE_READY:
      return "READY";
    case XR_SESSION_STATE_SYNCHRONIZED:
      return "SYNCHRONIZED";
    case XR_SESSION_STATE_VISIBLE:
      return "VISIBLE";
    case XR_SESSION_STATE_FOCUSED:
      return "FOCUSED";
    case XR_SESSION_STATE_STOPPING:
      return "STOPPING";
    case XR_SESSION_STATE_EXITING:
      return "EXITING";
    default:
      return "UNKNOWN";
  }
}

}  // namespace host
