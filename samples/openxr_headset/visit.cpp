#include "visit.h"

#include <cmath>
#include <thread>

#include "interrupted.h"
#include "warn_once.h"

namespace host {

namespace {

constexpr XrDuration kImagePatience = 100'000'000;       // nanoseconds
constexpr std::chrono::milliseconds kBetweenEvents(10);  // while no frame is waited for

// Metres, and what the compositor is told of its depth: 0 at near_z, 1 at far_z.
constexpr DepthConvention kDepth = {VOY_DEPTH_ENCODING_STANDARD, 0.2, 10000};

template <class Event>
const Event& as(const XrEventDataBuffer& event) {
  return reinterpret_cast<const Event&>(event);
}

bool finite(const XrPosef& p) {
  const double size = std::hypot(std::hypot(p.orientation.x, p.orientation.y),
                                 std::hypot(p.orientation.z, p.orientation.w));
  return std::abs(size - 1) < 0.01 && std::isfinite(p.position.x) && std::isfinite(p.position.y) &&
         std::isfinite(p.position.z);
}

// As `to` looks, about the head's middle of `from`.
Views turned(const Views& from, Views to) {
  const Pose before = middle(from_xr(from[0].pose), from_xr(from[1].pose));
  const Pose head = {before.position, middle(from_xr(to[0].pose), from_xr(to[1].pose)).orientation};
  for (size_t i = 0; i < to.size(); ++i)
    to[i].pose.position = to_xr((head * inverse(before) * from_xr(from[i].pose)).position);
  return to;
}

}  // namespace

Visit::Visit(const Runtime& runtime, const Graphics& graphics, const Input& input,
             VoyagerLayer& voyager, Journey& journey)
    : runtime_(runtime),
      graphics_(graphics),
      input_(input),
      voyager_(voyager),
      journey_(journey),
      session_(runtime, graphics, input),
      images_(session_, runtime, graphics, voyager.largest(), journey.recorder.has_value()),
      renderer_(graphics, voyager, images_, kDepth,
                journey.recorder ? &*journey.recorder : nullptr) {
  for (uint32_t view = 0; view < runtime.view_count(); ++view) read_visible_area(view);
}

// Pictures that are compared are whole.
void Visit::read_visible_area(uint32_t view) {
  if (runtime_.has_visibility_mask() && !journey_.recorder)
    renderer_.set_visible_area(view, VisibleArea(graphics_, runtime_, session_.get(), view));
}

void Visit::run() try {
  for (;;) {
    handle_events();
    if (session_.exiting()) break;
    leave_when_finished();
    if (session_.running()) {
      frame();
    } else if (interrupted || journey_.finished()) {
      break;  // there is nothing to leave
    } else {
      std::this_thread::sleep_for(kBetweenEvents);
    }
    if (journey_.options.frames == 0)
      journey_.patience.renew();  // a headset may lie on the table for hours
    else
      journey_.patience.check(std::string("nothing to show, the session ") +
                              state_name(session_.state()));
  }
  renderer_.finish();
} catch (const Lost&) {
  renderer_.finish();
  throw;
} catch (...) {
  save_pictures();
  throw;
}

// Of what was drawn before a failure, which is the one to be told.
void Visit::save_pictures() noexcept try { renderer_.finish(); } catch (const std::exception&) {
}

void Visit::handle_events() {
  XrEventDataBuffer event;
  while (runtime_.poll(event)) handle(event);
}

void Visit::handle(const XrEventDataBuffer& event) {
  switch (event.type) {
    case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED: {
      const uint64_t begun = session_.begun();
      session_.handle(as<XrEventDataSessionStateChanged>(event));
      if (session_.begun() != begun) journey_.statistics.begun();
      if (session_.begun() != begun) leaving_ = false;  // this one was not asked to exit
      if (session_.begun() != begun && begun > 0) journey_.statistics.restarted();
      break;
    }
    case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
      throw Lost(Lost::instance, "the runtime says that the instance will be lost");
    case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING: {
      const auto& change = as<XrEventDataReferenceSpaceChangePending>(event);
      if (change.session == session_.get() &&
          change.referenceSpaceType == XR_REFERENCE_SPACE_TYPE_LOCAL)
        recentre_at_ = change.changeTime;
      break;
    }
    case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR: {
      const auto& change = as<XrEventDataVisibilityMaskChangedKHR>(event);
      if (change.session == session_.get() &&
          change.viewConfigurationType == runtime_.view_configuration() &&
          change.viewIndex < runtime_.view_count())
        read_visible_area(change.viewIndex);
      break;
    }
    default:  // of no use here, or of a later version
      break;
  }
}

void Visit::leave_when_finished() {
  if (leaving_ || !session_.running() || !(journey_.finished() || interrupted)) return;
  session_.request_exit();
  leaving_ = true;
  journey_.patience.renew();
}

void Visit::frame() {
  const XrFrameState state = session_.wait_frame();
  const auto began = std::chrono::steady_clock::now();
  journey_.statistics.waited(state);
  session_.begin_frame();
  if (recentre_at_ && state.predictedDisplayTime >= *recentre_at_) {
    journey_.traveller->recentred();
    views_.reset();  // they were in the old space
    recentre_at_.reset();
  }
  look(state.predictedDisplayTime);
  const std::optional<Views> views = views_;
  hold_frame_time(state.predictedDisplayPeriod);
  if (views) steer(state, *views);
  if (!leaving_ && state.shouldRender && views && draw(*views)) {
    submit(state, *views);
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - began;
    journey_.statistics.shown(taken.count());
    journey_.patience.renew();
  } else {
    session_.end_frame(state.predictedDisplayTime, nullptr);
    journey_.statistics.empty();
  }
}

// Of a display's period three quarters are Voyager's; the eye pass and the compositor have the
// rest. A runtime that shows a late application's frames twice tells twice the period: the shortest
// counts.
void Visit::hold_frame_time(XrDuration display_period) {
  constexpr double kShare = 0.75, kMilliseconds = 1e-6;
  if (!journey_.options.follows_display || !voyager_.has_tree() || display_period <= 0) return;
  if (shortest_period_ && *shortest_period_ <= display_period) return;
  shortest_period_ = display_period;
  voyager_.hold_frame_time(kShare * kMilliseconds * static_cast<double>(display_period));
}

// Where the head is lost, the last that was known of it stays.
void Visit::look(XrTime display_time) {
  std::optional<Located> found = session_.locate(display_time);
  if (!found) return;
  if (!found->position_known) {
    if (!views_) return;
    found->views = turned(*views_, found->views);
  }
  for (const XrView& view : found->views)
    if (!finite(view.pose)) return;
  views_ = found->views;
}

void Visit::steer(const XrFrameState& state, const Views& views) {
  const XrTime now = state.predictedDisplayTime;
  const double seconds = steered_at_ ? static_cast<double>(now - *steered_at_) * 1e-9 : 0;
  steered_at_ = now;
  if (!session_.focused()) return;
  journey_.traveller->steer(input_.read(session_.get()),
                            middle(from_xr(views[0].pose), from_xr(views[1].pose)), seconds);
}

// The views in the scene's world; none where the runtime's angles are those of no frustum.
std::optional<std::vector<Camera>> Visit::cameras(const Views& views) const {
  Pose world_from_local = journey_.traveller->world_from_local();
  if (journey_.options.fixed_pose)
    world_from_local = journey_.traveller->start() *
                       inverse(middle(from_xr(views[0].pose), from_xr(views[1].pose)));
  std::vector<Camera> cameras(views.size());
  for (size_t i = 0; i < views.size(); ++i) {
    const XrFovf& fov = views[i].fov;
    cameras[i].pose = to_voyager(world_from_local * from_xr(views[i].pose));
    cameras[i].width = images_.view(i).extent.width;
    cameras[i].height = images_.view(i).extent.height;
    if (voyFrustumFromAngles(fov.angleLeft, fov.angleRight, fov.angleUp, fov.angleDown,
                             &cameras[i].frustum) != VOY_SUCCESS) {
      warn_once(
          "xrLocateViews: found the angles of no frustum, expected left below right and down below "
          "up: such frames stay empty");
      return std::nullopt;
    }
  }
  return cameras;
}

// False: nothing was drawn, and nothing can be shown in this frame.
bool Visit::draw(const Views& views) {
  const std::optional<std::vector<Camera>> seen = cameras(views);
  if (!seen || !images_.ready(kImagePatience)) return false;
  renderer_.draw(*seen, journey_.statistics.frames());
  images_.release();
  return true;
}

void Visit::submit(const XrFrameState& state, const Views& views) {
  XrCompositionLayerDepthInfoKHR depths[kMostViews];
  XrCompositionLayerProjectionView projections[kMostViews];
  for (size_t i = 0; i < views.size(); ++i) {
    const EyeImage& image = images_.view(i);
    const XrRect2Di rect = {
        {0, 0},
        {static_cast<int32_t>(image.extent.width), static_cast<int32_t>(image.extent.height)}};
    projections[i] =
        xr_struct<XrCompositionLayerProjectionView>(XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW);
    projections[i].pose = views[i].pose;
    projections[i].fov = views[i].fov;
    projections[i].subImage = {image.colour->get(), rect, image.layer};
    if (!image.depth) continue;
    depths[i] = xr_struct<XrCompositionLayerDepthInfoKHR>(XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR);
    depths[i].subImage = {image.depth->get(), rect, image.layer};
    depths[i].minDepth = 0;
    depths[i].maxDepth = 1;
    depths[i].nearZ = static_cast<float>(kDepth.near_z);
    depths[i].farZ = static_cast<float>(kDepth.far_z);
    projections[i].next = &depths[i];
  }
  auto layer = xr_struct<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  layer.space = session_.local();
  layer.viewCount = static_cast<uint32_t>(views.size());
  layer.views = projections;
  session_.end_frame(state.predictedDisplayTime, &layer);
}

}  // namespace host
