#pragma once
// The panel: what can be turned, and what a frame took.
#include <string>

#include "tools/view/session.h"

namespace voyager::view {

// What people type into the panel.
struct PanelTexts {
  char open[512] = "", cameras[512] = "cameras.json", picture[512] = "picture.png",
       folder[512] = "path";
  int pictures = 120;
};

// In a frame of Dear ImGui. `window_rate`: frames a second that the window shows.
void show_panel(Session& session, PanelTexts& texts, const std::string& device, float window_rate);
// What is always shown: loading, messages, and what to do without a scene.
void show_notes(const Session& session);

// Parts of the panel.
void show_statistics(const Session& session);
void show_detail_scale();

}  // namespace voyager::view
