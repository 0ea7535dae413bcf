#include "tools/view/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "tools/byte_size.h"

namespace voyager::view {
namespace {

constexpr float kPanelWidth = 330;
constexpr float kHeightOfAll = 1000;  // pixels that all sections take, about
// Also of numbers that are typed in.
constexpr ImGuiSliderFlags kClamped = ImGuiSliderFlags_AlwaysClamp;
constexpr ImGuiSliderFlags kClampedLogarithmic = kClamped | ImGuiSliderFlags_Logarithmic;

void show_scene(Session& session, PanelTexts& texts) {
  const LoadedScene* scene = session.scene();
  if (scene) {
    ImGui::TextWrapped("%s", scene->path.c_str());
    ImGui::Text("%llu Gaussians%s", static_cast<unsigned long long>(scene->gaussians),
                scene->has_tree()     ? ""
                : scene->file.empty() ? ", a sample is shown"
                                      : ", flat");
  }
  if (ImGui::InputTextWithHint("##open", "open a file or URL", texts.open, sizeof texts.open,
                               ImGuiInputTextFlags_EnterReturnsTrue))
    session.open(texts.open);
  float budget = static_cast<float>(session.budget());
  ImGui::SliderFloat("budget, MB", &budget, 10, 64000, "%.0f", kClampedLogarithmic);
  if (ImGui::IsItemDeactivatedAfterEdit()) session.set_budget(double{budget});
}

void show_detail_of(SplatSettings& settings) {
  bool by_time = settings.milliseconds > 0;
  if (ImGui::RadioButton("by tau", !by_time)) settings.milliseconds = 0;
  ImGui::SameLine();
  if (ImGui::RadioButton("by milliseconds", by_time) && !by_time) settings.milliseconds = 50;
  if (settings.milliseconds > 0)
    ImGui::SliderFloat("ms a frame", &settings.milliseconds, 2, 1000, "%.0f", kClampedLogarithmic);
  else
    ImGui::SliderFloat("tau, pixels", &settings.tau, 0.25f, 60, "%.2f", kClampedLogarithmic);
  bool antialias = settings.antialias == VOY_ANTIALIAS_ON;
  if (ImGui::Checkbox("antialiasing", &antialias))
    settings.antialias = antialias ? VOY_ANTIALIAS_ON : VOY_ANTIALIAS_OFF;
}

void show_picture(Settings& settings) {
  show_detail_of(settings.left);
  bool coarser = settings.moving_milliseconds > 0;
  if (settings.left.milliseconds <= 0 && ImGui::Checkbox("coarser while moving", &coarser))
    settings.moving_milliseconds = coarser ? Settings().moving_milliseconds : 0;
  ImGui::SliderFloat("exposure, stops", &settings.stops, -6, 6, "%.1f", kClamped);
  ImGui::ColorEdit3("background", settings.background, ImGuiColorEditFlags_NoInputs);
}

void show_comparison(Session& session) {
  Settings& settings = session.settings;
  const auto choice = [&](const char* name, RightSide side) {
    if (ImGui::RadioButton(name, settings.right_side == side)) settings.right_side = side;
  };
  choice("nothing", RightSide::none);
  ImGui::SameLine();
  choice("other settings", RightSide::settings);
  choice("level of detail", RightSide::detail);
  ImGui::SameLine();
  choice("error", RightSide::error);
  if (settings.right_side != RightSide::none)
    ImGui::SliderFloat("line", &settings.split, 0, 1, "%.2f", kClamped);
  ImGui::PushID("right");
  if (settings.right_side == RightSide::settings) show_detail_of(settings.right);
  ImGui::PopID();
  if (settings.right_side == RightSide::detail) show_detail_scale();
  if (settings.right_side != RightSide::error) return;
  if (session.is_measuring())
    ImGui::Text("the truth is being drawn ...");
  else if (ImGui::Button("measure this view"))
    session.measure_error();
  if (!session.error()) return;
  if (std::isinf(session.error()->psnr))
    ImGui::Text("none: this view is the truth");
  else
    ImGui::Text("%.2f dB; shown 8 times, grey is none", session.error()->psnr);
}

void show_navigation(Session& session) {
  Navigator& navigator = session.navigator;
  const auto mode = [&](const char* name, Navigation value) {
    if (ImGui::RadioButton(name, navigator.mode() == value)) navigator.set_mode(value);
    ImGui::SameLine();
  };
  mode("orbit", Navigation::orbit);
  mode("fly", Navigation::fly);
  mode("walk", Navigation::walk);
  ImGui::NewLine();
  float speed = static_cast<float>(navigator.speed());
  if (ImGui::SliderFloat("speed, m/s", &speed, 0.1f, 1000, "%.2f", kClampedLogarithmic))
    navigator.set_speed(double{speed});
  const glm::dvec3& p = navigator.position();
  ImGui::Text("at %.2f, %.2f, %.2f m", p.x, p.y, p.z);
}

// A file may bring hundreds: they scroll on their own.
void show_numbers(Session& session) {
  constexpr size_t kInARow = 8;
  constexpr float kMostRows = 3.5f;  // half a row tells that there are more
  const size_t count = session.bookmarks.size(), rows = (count + kInARow - 1) / kInARow;
  if (count == 0) return;
  const float height =
      std::min(static_cast<float>(rows), kMostRows) * ImGui::GetTextLineHeightWithSpacing();
  ImGui::BeginChild("numbers", {0, height});
  for (size_t i = 0; i < count; ++i) {
    if (i % kInARow != 0) ImGui::SameLine();
    if (ImGui::SmallButton(std::to_string(i).c_str())) session.go_to(session.bookmarks[i]);
  }
  ImGui::EndChild();
}

void show_bookmarks(Session& session, PanelTexts& texts) {
  if (ImGui::Button("home")) session.go_home();
  ImGui::SameLine();
  if (ImGui::Button("add")) session.add_bookmark();
  show_numbers(session);
  ImGui::InputText("##cameras", texts.cameras, sizeof texts.cameras);
  ImGui::SameLine();
  if (ImGui::Button("save cameras")) session.save_bookmarks(texts.cameras);
}

void show_pictures(Session& session, PanelTexts& texts) {
  ImGui::InputText("##picture", texts.picture, sizeof texts.picture);
  ImGui::SameLine();
  if (ImGui::Button("save picture")) session.save_picture(texts.picture, false);
  ImGui::InputText("##folder", texts.folder, sizeof texts.folder);
  ImGui::SameLine();
  if (const auto& path = session.path()) {
    if (ImGui::Button("stop")) return session.cancel_path();
    const std::string done =
        std::to_string(path->next) + " of " + std::to_string(path->cameras.size());
    ImGui::ProgressBar(static_cast<float>(path->next) / static_cast<float>(path->cameras.size()),
                       {-1, 0}, done.c_str());
    return;
  }
  if (ImGui::Button("save path"))
    session.start_path(texts.folder, static_cast<size_t>(texts.pictures));
  ImGui::SliderInt("pictures", &texts.pictures, 2, 600, "%d", kClamped);
}

// Those that are used most are open at first; the others where the window has room for all.
enum class Use { often, seldom };
bool section(const char* name, Use use) {
  const bool open = use == Use::often || ImGui::GetIO().DisplaySize.y >= kHeightOfAll;
  return ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

}  // namespace

void show_panel(Session& session, PanelTexts& texts, const std::string& device, float window_rate) {
  const ImGuiIO& io = ImGui::GetIO();
  ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({kPanelWidth, io.DisplaySize.y - 16});
  ImGui::Begin("Voyager", nullptr, ImGuiWindowFlags_NoResize);
  ImGui::PushItemWidth(150);
  ImGui::TextWrapped("%s", device.c_str());
  if (session.is_still())
    ImGui::TextUnformatted("still");
  else
    ImGui::Text("%.1f frames a second", double{window_rate});
  ImGui::SameLine();
  ImGui::TextDisabled("H hides this panel");
  if (section("Scene", Use::often)) show_scene(session, texts);
  if (section("Picture", Use::often)) show_picture(session.settings);
  if (section("Right of the line", Use::often)) show_comparison(session);
  if (section("Moving", Use::often)) show_navigation(session);
  if (section("Bookmarks", Use::seldom)) show_bookmarks(session, texts);
  if (section("Pictures and paths", Use::seldom)) show_pictures(session, texts);
  if (section("Statistics", Use::seldom)) show_statistics(session);
  ImGui::PopItemWidth();
  ImGui::End();
}

void show_notes(const Session& session) {
  const LoadProgress loading = session.loading();
  const bool empty = !session.scene() && loading.stage.empty();
  if (loading.stage.empty() && session.messages().empty() && !empty) return;
  const ImGuiIO& io = ImGui::GetIO();
  const float left = session.settings.show_panel ? kPanelWidth + 16 : 8;
  ImGui::SetNextWindowPos({left, io.DisplaySize.y - 8}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({std::min(560.0f, io.DisplaySize.x - left - 8), 0});
  ImGui::SetNextWindowBgAlpha(0.75f);
  ImGui::Begin("notes", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  if (empty) ImGui::Text("Drop a scene on this window");
  for (const Message& message : session.messages()) ImGui::TextWrapped("%s", message.text.c_str());
  if (!loading.stage.empty()) {
    const float share = loading.total == 0 ? 0
                                           : static_cast<float>(static_cast<double>(loading.done) /
                                                                static_cast<double>(loading.total));
    ImGui::ProgressBar(share, {-1, 0}, loading.stage.c_str());
  }
  ImGui::End();
}

}  // namespace voyager::view
