#pragma once
// A frame's commands: Voyager draws both eyes, the eye pass fills the swapchain images. Two
// frames are in flight.
#include "eye_pass.h"
#include "readback.h"
#include "recorder.h"

namespace host {

class Renderer {
 public:
  // recorder may be NULL. Resizes voyager.
  Renderer(const Graphics& graphics, VoyagerLayer& voyager, const EyeImages& images,
           const DepthConvention& convention, Recorder* recorder);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // The runtime has another mask for this eye.
  void set_visible_area(size_t eye, VisibleArea area);
  // The images are ready; when it returns the commands that fill them are submitted. frame:
  // its number, for the recorder.
  void draw(const std::array<Camera, kEyes>& eyes, uint64_t frame);
  // Writes what is still to be written of the recorder's pictures.
  void finish();

 private:
  struct Slot {
    VkCommandBuffer before = VK_NULL_HANDLE, after = VK_NULL_HANDLE;  // Voyager's frame
    UniqueFence before_done, after_done;
    std::optional<Readback> readback;
    std::optional<uint64_t> recorded;  // the frame whose pictures are in it
  };

  void save(Slot& slot);
  void submit_before(const Slot& slot);
  void record_after(const Slot& slot, const std::array<Camera, kEyes>& eyes);
  void submit_after(const Slot& slot);

  const Graphics& graphics_;
  VoyagerLayer& voyager_;
  const EyeImages& images_;
  const DepthConvention convention_;
  Recorder* recorder_;
  EyePass pass_;
  std::array<VisibleArea, kEyes> areas_;
  UniqueCommandPool pool_;
  std::array<Slot, kFramesInFlight> slots_;
  uint32_t slot_ = 0;
};

}  // namespace host
