#pragma once
// A frame's commands: Voyager draws every view, the eye pass fills the swapchain images. Two
// frames are in flight.
#include "eye_pass.h"
#include "frame_commands.h"
#include "readback.h"
#include "recorder.h"

namespace host {

class Renderer {
 public:
  // recorder may be NULL. Resizes voyager.
  Renderer(const Graphics& graphics, VoyagerLayer& voyager, const EyeImages& images,
           const DepthConvention& convention, Recorder* recorder);

  // The runtime has another mask for this view.
  void set_visible_area(size_t view, VisibleArea area);
  // The images are ready; when it returns the commands that fill them are submitted. frame:
  // its number, for the recorder.
  void draw(const std::vector<Camera>& views, uint64_t frame);
  // Writes what is still to be written of the recorder's pictures.
  void finish();

 private:
  // The pictures of a slot's frame, which are written once it is done.
  struct Recorded {
    std::optional<Readback> readback;
    std::optional<uint64_t> frame;
  };

  void save(Recorded& recorded);
  void submit_before(uint32_t slot);
  void submit_after(uint32_t slot, const std::vector<Camera>& views);

  const Graphics& graphics_;
  VoyagerLayer& voyager_;
  const EyeImages& images_;
  const DepthConvention convention_;
  Recorder* recorder_;
  EyePass pass_;
  std::vector<VisibleArea> areas_;  // of each view
  std::array<Recorded, kFramesInFlight> recorded_;
  FrameCommands frames_;  // goes first: it waits for the frames in flight
};

}  // namespace host
