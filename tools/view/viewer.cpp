#include "tools/view/viewer.h"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <memory>
#include <optional>

#include "failure.h"
#include "gui.h"
#include "mode_names.h"
#include "readback.h"
#include "runtime/base/error.h"
#include "tools/console.h"
#include "tools/output_paths.h"
#include "tools/view/canvas.h"
#include "tools/view/controls.h"
#include "tools/view/panel.h"
#include "tools/view/script.h"
#include "tools/view/session.h"
#include "validation.h"

namespace voyager::view {
namespace {

constexpr double kIdleSeconds = 0.05;  // between two looks for what other threads did

volatile std::sig_atomic_t interrupted = 0;

// SIGINT and SIGTERM end the loop as closing the window does, so that a bake removes what it began.
class SignalsEndLoop {
 public:
  SignalsEndLoop() {
    for (const int signal : kSignals)
      std::signal(signal, [](int which) {
        interrupted = 1;
        std::signal(which, SIG_DFL);  // the next one ends the program at once
      });
  }
  ~SignalsEndLoop() {
    for (const int signal : kSignals) std::signal(signal, SIG_DFL);
  }
  SignalsEndLoop(const SignalsEndLoop&) = delete;
  SignalsEndLoop& operator=(const SignalsEndLoop&) = delete;

 private:
  static constexpr int kSignals[] = {SIGINT, SIGTERM};
};

voy::Device create_device(const host::Device& vulkan_device, const ViewOptions& options) {
  VoyVulkanDeviceDesc vulkan = vulkan_device.voyager_desc();
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.next = &vulkan;
  desc.backend = options.backend;
  return voy::Device::create(desc);
}

// "llvmpipe, drawn by the cpu"
std::string description(const host::Device& vulkan, const voy::Device& device) {
  const VoyCapabilities found = device.capabilities();
  return fmt::format("{}; scene: {}, {}", vulkan.name(), host::backend_name(found.backend),
                     found.deviceName);
}

// NULL: there is no display and nobody has to look, so that frames are drawn off screen.
std::unique_ptr<host::Glfw> open_display(bool ends_by_itself) {
  if (ends_by_itself && !host::Glfw::has_display()) {
    tools::note("no display: drawn off screen");
    return nullptr;
  }
  return std::make_unique<host::Glfw>(
      "no display for a window (`voyager render` needs none, nor do --script and --screenshot)");
}

std::optional<host::Presentation> presentation_of(const host::Glfw* glfw) {
  if (!glfw) return std::nullopt;
  return glfw->presentation();
}

// All that the viewer takes, in the order in which it is made.
class Viewer {
 public:
  Viewer(const ViewOptions& options, std::optional<Script> script, host::Validation* validation)
      : glfw_(open_display(script.has_value())),
        presentation_(presentation_of(glfw_.get())),
        instance_("voyager", validation, presents()),
        vulkan_(instance_, presents(), options.gpu),
        device_(create_device(vulkan_, options)),
        description_(description(vulkan_, device_)),
        canvas_(instance_, vulkan_, {options.size.width, options.size.height}, glfw_ != nullptr),
        renderer_(vulkan_, canvas_.colour_format()),
        gui_(vulkan_, canvas_.window(), renderer_.overlay_pass()),
        session_(vulkan_, device_, options),
        script_(std::move(script)) {
    tools::note(description_);
    if (!options.scene.empty()) session_.open(options.scene);
  }
  // Frames may be in flight.
  ~Viewer() { vkDeviceWaitIdle(vulkan_.get()); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void run() {
    while (!canvas_.closed() && !session_.is_over() && !interrupted) {
      if (session_.is_still())
        canvas_.wait_for_events(kIdleSeconds);
      else
        canvas_.take_events();
      if (script_ && !script_->step(session_, canvas_)) return;
      name_window();
      if (is_sized()) draw_frame();
    }
  }

  const std::vector<Refusal>& refusals() const { return session_.refusals(); }

 private:
  const host::Presentation* presents() const { return presentation_ ? &*presentation_ : nullptr; }

  void name_window() {
    const LoadedScene* scene = session_.scene();
    const std::string title = scene ? scene->path + " - Voyager" : "Voyager";
    if (title != title_) canvas_.set_title(title);
    title_ = title;
  }

  // False while the window is minimised.
  bool is_sized() {
    const VkExtent2D wanted = canvas_.wanted();
    if (current_ && wanted.width == asked_.width && wanted.height == asked_.height) return true;
    vulkan_.wait_idle();
    asked_ = wanted;
    if (!canvas_.resize(wanted)) {
      canvas_.wait_for_events(kIdleSeconds);
      current_ = false;
      return false;
    }
    renderer_.resize(canvas_.extent());
    gui_.resize(canvas_.extent());
    session_.resize(canvas_.extent());
    return true;
  }

  void draw_frame() {
    steer_and_show();
    session_.update(canvas_.extent());
    const uint32_t slot = renderer_.wait_for_slot();
    current_ = canvas_.acquire(slot);
    if (!current_) return;
    FrameDesc frame = session_.frame();
    frame.acquired = canvas_.acquired(slot);
    frame.ready = canvas_.ready();
    auto& captures = session_.captures();
    std::optional<Capture> capture;
    host::Readback readback;
    if (!captures.empty()) {
      // Without a scene there is the panel, or nothing.
      if (frame.left || captures.front().with_panel) {
        capture = std::move(captures.front());
        readback = host::Readback(vulkan_, canvas_.extent(), false);
      }
      captures.pop_front();
    }
    if (!capture || capture->with_panel)
      frame.overlay = [this](VkCommandBuffer commands) { gui_.record(commands); };
    frame.record = [&](VkCommandBuffer commands, const host::RenderTargets& targets) {
      canvas_.record(commands, targets);
      if (capture) readback.record(commands, targets);
    };
    const bool is_drawn = draw(frame);
    current_ = canvas_.present();
    if (!capture || (!is_drawn && !capture->with_panel)) return;
    vulkan_.wait_idle();
    capture->then(readback.extent(), readback.rgba());
  }

  // False where Voyager refused the frame, so that it is one without a scene.
  bool draw(FrameDesc& frame) {
    try {
      renderer_.draw(frame);
      session_.frame_drawn(frame);
      return true;
    } catch (const voy::Error& problem) {
      session_.frame_refused(problem);
      frame.left = frame.right = nullptr;
      frame.still = VK_NULL_HANDLE;
      renderer_.draw(frame);  // the window's image was acquired, and waits
      return false;
    }
  }

  void steer_and_show() {
    gui_.begin();
    if (host::Window* window = canvas_.window()) take_input(*window);
    if (session_.settings.show_panel)
      show_panel(session_, texts_, description_, ImGui::GetIO().Framerate);
    show_notes(session_);
    gui_.end();
  }

  void take_input(host::Window& window) {
    const double now = glfwGetTime();
    steer(window, session_.navigator, now - last_, gui_.has_mouse() || drags_line(window),
          gui_.has_keyboard());
    last_ = now;
    for (const int key : window.take_keys())
      if (!ImGui::GetIO().WantTextInput) press(key);
    for (const std::string& path : window.take_dropped()) session_.open(path);
  }

  // Whether the mouse has the line between the two pictures.
  bool drags_line(const host::Window& window) {
    constexpr double kGrip = 0.008;  // of the width
    const bool pressed = window.button(GLFW_MOUSE_BUTTON_LEFT);
    const double at = window.cursor().x;
    Settings& settings = session_.settings;
    const bool begins = pressed && !was_pressed_ && !gui_.has_mouse() &&
                        settings.right_side != RightSide::none &&
                        std::abs(at - double{settings.split}) < kGrip;
    drags_line_ = pressed && (drags_line_ || begins);
    was_pressed_ = pressed;
    if (drags_line_) settings.split = static_cast<float>(std::clamp(at, 0.0, 1.0));
    return drags_line_;
  }

  void press(int key) {
    switch (key) {
      case GLFW_KEY_H:
        session_.settings.show_panel = !session_.settings.show_panel;
        break;
      case GLFW_KEY_B:
        return session_.add_bookmark();
      case GLFW_KEY_P:
        return session_.save_picture(texts_.picture, false);
      case GLFW_KEY_HOME:
        return session_.go_home();
      case GLFW_KEY_ESCAPE:
        return session_.cancel_path();
      case GLFW_KEY_1:
        return session_.navigator.set_mode(Navigation::orbit);
      case GLFW_KEY_2:
        return session_.navigator.set_mode(Navigation::fly);
      case GLFW_KEY_3:
        return session_.navigator.set_mode(Navigation::walk);
      default:
        break;
    }
  }

  const std::unique_ptr<const host::Glfw> glfw_;  // NULL: off screen
  const std::optional<host::Presentation> presentation_;
  const host::Instance instance_;
  const host::Device vulkan_;
  const voy::Device device_;
  const std::string description_;
  Canvas canvas_;
  FrameRenderer renderer_;
  host::Gui gui_;
  Session session_;
  std::optional<Script> script_;
  PanelTexts texts_;
  std::string title_ = "Voyager";
  bool current_ = false;                           // the canvas has the size that was asked for
  VkExtent2D asked_ = {0, 0};                      // the surface may have given another
  double last_ = glfw_ ? glfwGetTime() : 0;        // seconds, of the last input
  bool was_pressed_ = false, drags_line_ = false;  // the left button; the line
};

// Files first: what is refused is refused before there is a window.
void check_files(const ViewOptions& options) {
  if (!options.keep.empty()) tools::require_extension("--keep", options.keep, {".voy"});
  if (!options.screenshot.empty())
    tools::require_extension("--screenshot", options.screenshot, {".png"});
  tools::require_distinct({options.keep, options.screenshot},
                          {options.scene, options.cameras, options.script});
  for (const std::string& output : {options.keep, options.screenshot})
    if (!output.empty()) tools::require_writable(output);
}

std::optional<Script> script_of(const ViewOptions& options) {
  std::optional<Script> script;
  if (!options.script.empty()) script.emplace(options.script);
  if (options.frames > 0 || !options.screenshot.empty())
    script.emplace(options.frames, options.screenshot);
  return script;
}

// Where nobody looked at the messages. The exit code is that of the first.
void check_refusals(const std::vector<Refusal>& refusals, const std::string& script) {
  if (refusals.empty()) return;
  const Refusal& first = refusals.front();
  throw Error(first.code, script.empty()
                              ? first.text
                              : fmt::format("{}: found {} refused, expected none; the first: {}",
                                            script, refusals.size(), first.text));
}

}  // namespace

void run_viewer(const ViewOptions& options) {
  check_files(options);
  std::optional<Script> script = script_of(options);
  const bool ends_by_itself = script.has_value();
  const SignalsEndLoop signals;
  host::Validation validation;
  {
    Viewer viewer(options, std::move(script), options.validation ? &validation : nullptr);
    viewer.run();
    if (ends_by_itself) check_refusals(viewer.refusals(), options.script);
  }
  if (validation.messages() > 0)
    throw Error(ErrorCode::internal,
                fmt::format("--validation: {} messages", validation.messages()));
}

}  // namespace voyager::view
