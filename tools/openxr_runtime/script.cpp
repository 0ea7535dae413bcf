#include "script.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "extensions.h"
#include "formats.h"
#include "script_lists.h"

namespace test_runtime {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kFields = {"motion",
                                          "local_in_scene",
                                          "recommended",
                                          "maximum",
                                          "formats",
                                          "extensions",
                                          "vulkan",
                                          "hz",
                                          "period_ns",
                                          "realtime",
                                          "images",
                                          "image_order",
                                          "image_layouts",
                                          "hidden_frames",
                                          "position_lost_frames",
                                          "tracking_lost_frames",
                                          "image_timeout_frames",
                                          "flipped_frames",
                                          "patience_ms",
                                          "events",
                                          "input",
                                          "failures",
                                          "output",
                                          "report",
                                          "capture_frames"};

// Relative paths are meant from the script's folder.
std::string beside(const std::string& script, const std::string& path) {
  return path.empty() ? path : (fs::path(script).parent_path() / path).string();
}

XrExtent2Di extent(const Reader& json, const std::string& name, const Json& value) {
  const auto side = [&](size_t i) {
    if (!value[i].is_number_integer() || value[i].get<int64_t>() < 1 ||
        value[i].get<int64_t>() > 16384)
      json.refuse(name, "[width, height] from 1 to 16384");
    return value[i].get<int32_t>();
  };
  if (!value.is_array() || value.size() != 2) json.refuse(name, "[width, height] from 1 to 16384");
  return {side(0), side(1)};
}

void read_sizes(const Reader& json, Script& script) {
  if (json.has("maximum")) script.maximum = extent(json, "maximum", json.field("maximum"));
  if (json.has("recommended")) {
    const Json& value = json.field("recommended");
    const bool each = value.is_array() && !value.empty() && value[0].is_array();
    if (each && value.size() != 2 && value.size() != 4)
      json.refuse("recommended", "one size, or those of 2 or 4 views");
    for (size_t view = 0; view < 4; ++view)
      script.recommended[view] =
          extent(json, "recommended", each ? value[view % value.size()] : value);
  }
  for (const XrExtent2Di& size : script.recommended)
    if (size.width > script.maximum.width || size.height > script.maximum.height)
      json.refuse("recommended", "no more than maximum");
}

void read_formats(const Reader& json, Script& script) {
  if (!json.has("formats")) {
    for (const Format& format : default_formats()) script.formats.push_back(format.format);
    return;
  }
  const std::string expected = "an array of " + format_names();
  if (!json.field("formats").is_array()) json.refuse("formats", expected);
  for (const Json& name : json.field("formats")) {
    const Format* format = name.is_string() ? find_format(name.get<std::string>()) : nullptr;
    if (!format) json.refuse("formats", expected);
    script.formats.push_back(format->format);
  }
}

void read_extensions(const Reader& json, Script& script) {
  script.extensions = optional_extensions();
  if (!json.has("extensions")) return;
  script.extensions.clear();
  const std::string expected = "an array of names that this runtime knows";
  if (!json.field("extensions").is_array()) json.refuse("extensions", expected);
  for (const Json& name : json.field("extensions")) {
    const auto known = optional_extensions();
    if (!name.is_string() || std::find(known.begin(), known.end(), name) == known.end())
      json.refuse("extensions", expected);
    script.extensions.push_back(name);
  }
}

void read_vulkan(const Reader& json, Script& script) {
  if (!json.has("vulkan")) return;
  const auto numbers = json.numbers("vulkan", 4);
  for (const double number : numbers)
    if (number < 0 || number > 99 || number != std::floor(number))
      json.refuse("vulkan", "[major, minor, major, minor] from 0 to 99");
  const auto whole = [&](size_t i) { return static_cast<uint16_t>(numbers[i]); };
  script.vulkan[0] = XR_MAKE_VERSION(whole(0), whole(1), 0);
  script.vulkan[1] = XR_MAKE_VERSION(whole(2), whole(3), 0);
}

void read_timing(const Reader& json, Script& script) {
  if (json.has("hz") && json.has("period_ns")) json.refuse("hz", "no period_ns beside it");
  if (json.has("hz")) script.period = static_cast<int64_t>(1e9 / json.number("hz", 1, 1000));
  if (json.has("period_ns")) script.period = json.whole("period_ns", 1000000, 1000000000);
  if (json.has("realtime")) script.realtime = json.truth("realtime");
  if (json.has("patience_ms")) script.patience = json.whole("patience_ms", 0, 60000);
}

void read_images(const Reader& json, Script& script) {
  if (json.has("images")) script.images = json.whole("images", 1, 8);
  if (json.has("image_layouts")) script.image_layouts = json.truth("image_layouts");
  if (!json.has("image_order")) return;
  const std::string order = json.text("image_order");
  if (order == "descending")
    script.image_order = ImageOrder::descending;
  else if (order == "shuffled")
    script.image_order = ImageOrder::shuffled;
  else if (order != "ascending")
    json.refuse("image_order", "ascending, descending or shuffled");
}

Motion motion_file(const Reader& json, const std::string& script) {
  try {
    return read_motion(beside(script, json.text("motion")));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(json.where() + ": motion: " + error.what());
  }
}

// Motion in a file is in the scene's world; LOCAL's origin there is told, or is the first head's
// place, in the scene's axes turned to OpenXR's (y up).
void read_motion_in_local(const Reader& json, Script& script) {
  script.local_in_scene.orientation = {0, 1, 0, 0};
  const bool built_in = !json.has("motion") || json.text("motion") == "built-in";
  script.motion = built_in ? built_in_motion() : motion_file(json, script.path);
  if (!built_in) script.local_in_scene.position = script.motion[0].centre().position;
  if (json.has("local_in_scene")) {
    const Reader pose(json.where() + ": local_in_scene", json.field("local_in_scene"));
    script.local_in_scene = read_pose(pose);
  }
  if (built_in) return;
  const Pose to_local = script.local_in_scene.inverse();
  for (Head& head : script.motion)
    for (Eye& eye : head.eyes) eye.pose = to_local * eye.pose;
}

}  // namespace

bool contains(const Ranges& ranges, int64_t frame) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [&](const Range& range) { return range.contains(frame); });
}

Script read_script(const std::string& path) {
  Script script;
  script.path = path;
  const Json parsed = path.empty() ? Json::object() : parse_json(path);
  const Reader json(path, parsed);
  json.only(kFields);
  read_motion_in_local(json, script);
  read_sizes(json, script);
  read_formats(json, script);
  read_extensions(json, script);
  read_vulkan(json, script);
  read_timing(json, script);
  read_images(json, script);
  read_ranges(json, "hidden_frames", script.hidden);
  read_ranges(json, "position_lost_frames", script.position_lost);
  read_ranges(json, "tracking_lost_frames", script.tracking_lost);
  read_ranges(json, "image_timeout_frames", script.image_timeouts);
  read_ranges(json, "flipped_frames", script.flipped);
  read_ranges(json, "capture_frames", script.capture);
  script.events = read_events(json);
  script.inputs = read_inputs(json);
  script.failures = read_failures(json);
  if (json.has("output")) script.output = beside(path, json.text("output"));
  if (json.has("report")) script.report = beside(path, json.text("report"));
  return script;
}

}  // namespace test_runtime
