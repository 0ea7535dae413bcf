#include "script_lists.h"

#include <openxr/openxr_reflection.h>

#include <algorithm>

#include "functions.h"
#include "profiles.h"

namespace test_runtime {
namespace {

constexpr int64_t kLast = int64_t{1} << 40;

// What can happen at a frame, and the field that says how much of it.
struct EventKind {
  const char* what;
  const char* amount;  // nullptr where there is none
  int64_t usual;
};
constexpr EventKind kEvents[] = {
    {"synchronized", nullptr, 0},   {"visible", nullptr, 0},      {"focused", nullptr, 0},
    {"stop", "restart_polls", 3},   {"exit", nullptr, 0},         {"lose_session", "frames", 2},
    {"lose_instance", "frames", 2}, {"recentre", nullptr, 0},     {"late", "periods", 1},
    {"swap_image", nullptr, 0},     {"mask_changed", nullptr, 0},
};

template <class Item>
void sort_by_frame(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.frame < b.frame; });
}

int64_t read_amount(const Reader& json, const EventKind& kind) {
  const bool never = kind.what == std::string("stop") && json.field(kind.amount).is_null();
  return never ? -1 : json.whole(kind.amount, 0, 1000);
}

Event read_event(const Reader& json) {
  Event event;
  event.frame = json.whole("frame", 0, kLast);
  event.what = json.text("do");
  std::string names;
  for (const EventKind& kind : kEvents) {
    names += (names.empty() ? "" : ", ") + std::string(kind.what);
    if (event.what != kind.what) continue;
    std::vector<std::string> fields = {"frame", "do"};
    if (kind.amount) fields.push_back(kind.amount);
    event.amount = kind.usual;
    if (kind.amount && json.has(kind.amount)) event.amount = read_amount(json, kind);
    if (event.what == "recentre") {
      fields.insert(fields.end(), {"position", "orientation"});
      event.recentred = read_pose(json);
    }
    json.only(fields);
    return event;
  }
  json.refuse("do", "one of " + names);
}

Input read_input(const Reader& json) {
  Input input;
  input.frame = json.whole("frame", 0, kLast);
  for (const auto& item : json.json().items()) {
    if (item.key() == "frame") continue;
    const Source* source = find_source(item.key());
    const bool hand = item.key() == "/user/hand/left" || item.key() == "/user/hand/right";
    if (!source && !hand) json.refuse(item.key(), "a path of an input source in README.md");
    if (hand || source->type == XR_ACTION_TYPE_BOOLEAN_INPUT)
      json.truth(item.key());
    else if (source->type == XR_ACTION_TYPE_FLOAT_INPUT)
      json.number(item.key(), -1, 1);
    else if (source->type == XR_ACTION_TYPE_VECTOR2F_INPUT)
      json.numbers(item.key(), 2);
    else
      json.refuse(item.key(), "no value for a pose or a haptic output");
    input.values[item.key()] = item.value();
  }
  return input;
}

XrResult read_result(const Reader& json) {
  const std::string name = json.text("result");
#define TEST_RUNTIME_MATCH(result, value) \
  if (name == #result) return result;
  XR_LIST_ENUM_XrResult(TEST_RUNTIME_MATCH)
#undef TEST_RUNTIME_MATCH
      json.refuse("result", "the name of an XrResult");
}

Failure read_failure(const Reader& json) {
  json.only({"call", "frame", "after", "times", "result"});
  Failure failure;
  failure.call = json.text("call");
  if (!is_function(failure.call)) json.refuse("call", "the name of a function of this runtime");
  failure.frame = json.has("frame") ? json.whole("frame", 0, kLast) : 0;
  failure.after = json.has("after") ? json.whole("after", 0, kLast) : 0;
  failure.times = json.has("times") ? json.whole("times", 1, kLast) : 1;
  failure.result = read_result(json);
  return failure;
}

}  // namespace

Pose read_pose(const Reader& json) {
  const auto p = json.numbers("position", 3);
  const auto q = json.numbers("orientation", 4);
  Pose pose = {{q[3], q[0], q[1], q[2]}, {p[0], p[1], p[2]}};
  if (!(std::abs(pose.orientation.norm() - 1) < 1e-3))
    json.refuse("orientation", "a unit quaternion (x, y, z, w)");
  pose.orientation.normalize();
  return pose;
}

void read_ranges(const Reader& json, const std::string& name, Ranges& ranges) {
  if (!json.has(name)) return;
  const std::string expected = "an array of [first frame, count]";
  if (!json.field(name).is_array()) json.refuse(name, expected);
  ranges.clear();
  for (const Json& range : json.field(name)) {
    if (!range.is_array() || range.size() != 2 || !range[0].is_number_unsigned() ||
        !range[1].is_number_unsigned())
      json.refuse(name, expected);
    ranges.push_back({range[0].get<int64_t>(), range[1].get<int64_t>()});
  }
}

std::vector<Event> read_events(const Reader& json) {
  std::vector<Event> events;
  if (json.has("events"))
    for (const Reader& event : json.objects("events")) events.push_back(read_event(event));
  sort_by_frame(events);
  return events;
}

std::vector<Input> read_inputs(const Reader& json) {
  std::vector<Input> inputs;
  if (json.has("input"))
    for (const Reader& input : json.objects("input")) inputs.push_back(read_input(input));
  sort_by_frame(inputs);
  return inputs;
}

std::vector<Failure> read_failures(const Reader& json) {
  std::vector<Failure> failures;
  if (json.has("failures"))
    for (const Reader& failure : json.objects("failures"))
      failures.push_back(read_failure(failure));
  return failures;
}

}  // namespace test_runtime
