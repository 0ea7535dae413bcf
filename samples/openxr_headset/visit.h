#pragma once
// One session from its making to its end: events, frames, what is shown in them.
#include "journey.h"
#include "renderer.h"

namespace host {

class Visit {
 public:
  Visit(const Runtime& runtime, const Graphics& graphics, const Input& input, VoyagerLayer& voyager,
        Journey& journey);

  // Until the session exits, be it that the journey is finished or that the runtime or the
  // player ends it. Throws Lost.
  void run();

 private:
  void handle_events();
  void handle(const XrEventDataBuffer& event);
  void read_visible_area(uint32_t view);
  void save_pictures() noexcept;
  void leave_when_finished();
  void frame();
  void look(XrTime display_time);
  void hold_frame_time(XrDuration display_period);
  void steer(const XrFrameState& state, const Views& views);
  bool draw(const Views& views);
  std::optional<std::vector<Camera>> cameras(const Views& views) const;
  void submit(const XrFrameState& state, const Views& views);

  const Runtime& runtime_;
  const Graphics& graphics_;
  const Input& input_;
  VoyagerLayer& voyager_;
  Journey& journey_;
  Session session_;
  EyeImages images_;
  Renderer renderer_;
  std::optional<Views> views_;  // the last that were known
  std::optional<XrDuration> shortest_period_;
  std::optional<XrTime> recentre_at_, steered_at_;
  bool leaving_ = false;
};

}  // namespace host
