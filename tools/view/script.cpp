#include "tools/view/script.h"

#include <fmt/core.h>

#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include "runtime/base/error.h"
#include "tools/cameras.h"
#include "tools/options.h"

namespace voyager::view {
namespace {

constexpr std::chrono::minutes kLongestWait{60};

constexpr double kMostTau = 1e6, kMostStops = 16, kMostDegrees = 3600;
constexpr size_t kMostPictures = 1'000'000;

// How many words each line has after the first.
const std::map<std::string, size_t>& word_counts() {
  static const std::map<std::string, size_t> counts = {
      {"loaded", 0},    {"baked", 0},  {"still", 0},    {"frames", 1},       {"open", 1},
      {"size", 2},      {"budget", 1}, {"picture", 1},  {"window", 1},       {"panel", 1},
      {"tau", 1},       {"right", 1},  {"exposure", 1}, {"background", 3},   {"antialias", 1},
      {"right-tau", 1}, {"line", 1},   {"measure", 0},  {"milliseconds", 1}, {"turn", 2},
      {"move", 3},      {"home", 0},   {"bookmark", 0}, {"save", 1},         {"path", 2},
      {"stop", 0}};
  return counts;
}

// These throw std::invalid_argument, which becomes a refusal of the line.
void check_words(const std::vector<std::string>& words) {
  const auto found = word_counts().find(words[0]);
  if (found == word_counts().end())
    throw std::invalid_argument("found " + words[0] + ", expected a line of docs/viewer.md");
  if (words.size() - 1 != found->second)
    throw std::invalid_argument(fmt::format("found {} words after {}, expected {}",
                                            words.size() - 1, words[0], found->second));
}
double number(const std::string& text) {
  const auto value = tools::parse_number(text);
  if (!value) throw std::invalid_argument("found " + text + ", expected a number");
  return *value;
}
double number(const std::string& text, double least, double most) {
  const auto value = tools::parse_number(text);
  if (!value || *value < least || *value > most)
    throw std::invalid_argument(
        fmt::format("found {}, expected a number from {} to {}", text, least, most));
  return *value;
}
size_t whole(const std::string& text, size_t least, size_t most) {
  const auto value = tools::parse_whole(text);
  if (!value || *value < least || *value > most)
    throw std::invalid_argument(
        fmt::format("found {}, expected a whole number from {} to {}", text, least, most));
  return *value;
}
uint32_t side(const std::string& text) {
  return static_cast<uint32_t>(whole(text, 1, tools::kLargestSide));
}
template <class T>
T one_of(const std::string& text, const std::vector<std::pair<std::string, T>>& names) {
  std::string list;
  for (const auto& [name, value] : names) {
    if (name == text) return value;
    list += (list.empty() ? "" : "|") + name;
  }
  throw std::invalid_argument("found " + text + ", expected " + list);
}

auto at_once(auto action) {
  return [action](Session& session, Canvas&) {
    action(session);
    return true;
  };
}

}  // namespace

Script::Action Script::parse_wait(const Words& words) {
  const std::string& name = words[0];
  if (name == "loaded") return [](Session& s, Canvas&) { return !s.is_opening(); };
  if (name == "baked")
    return [](Session& s, Canvas&) { return s.loading().stage.empty() && s.is_still(); };
  if (name == "still") return [](Session& s, Canvas&) { return s.is_still() && !s.is_busy(); };
  if (name == "frames") {
    const auto left = std::make_shared<size_t>(whole(words[1], 1, kMostFrames));
    return [left](Session&, Canvas&) { return --*left == 0; };
  }
  return nullptr;
}

Script::Action Script::parse_setting(const Words& words) {
  const std::string& name = words[0];
  const auto value = [&](double least, double most, size_t index = 1) {
    return static_cast<float>(number(words[index], least, most));
  };
  const auto set = [](auto change) {
    return at_once([change](Session& session) { change(session.settings); });
  };
  if (name == "tau") return set([v = value(0, kMostTau)](Settings& s) { s.left.tau = v; });
  if (name == "milliseconds")
    return set([v = value(0, kLongestFrame)](Settings& s) { s.left.milliseconds = v; });
  if (name == "exposure")
    return set([v = value(-kMostStops, kMostStops)](Settings& s) { s.stops = v; });
  if (name == "line") return set([v = value(0, 1)](Settings& s) { s.split = v; });
  if (name == "right-tau") return set([v = value(0, kMostTau)](Settings& s) { s.right.tau = v; });
  if (name == "background")
    return set([r = value(0, 1), g = value(0, 1, 2), b = value(0, 1, 3)](Settings& s) {
      s.background[0] = r;
      s.background[1] = g;
      s.background[2] = b;
    });
  if (name == "antialias") {
    const auto antialias =
        one_of<VoyAntialias>(words[1], {{"on", VOY_ANTIALIAS_ON}, {"off", VOY_ANTIALIAS_OFF}});
    return set([antialias](Settings& s) { s.left.antialias = antialias; });
  }
  if (name == "panel") {
    const bool on = one_of<bool>(words[1], {{"on", true}, {"off", false}});
    return set([on](Settings& s) { s.show_panel = on; });
  }
  if (name == "right") {
    const auto side = one_of<RightSide>(words[1], {{"nothing", RightSide::none},
                                                   {"settings", RightSide::settings},
                                                   {"detail", RightSide::detail},
                                                   {"error", RightSide::error}});
    return set([side](Settings& s) { s.right_side = side; });
  }
  return nullptr;
}

Script::Action Script::parse_file(const Words& words) {
  const std::string& name = words[0];
  const auto with_file = [&](auto action) {
    return at_once([action, file = words[1]](Session& session) { action(session, file); });
  };
  if (name == "open") return with_file([](Session& s, const std::string& f) { s.open(f); });
  if (name == "picture")
    return with_file([](Session& s, const std::string& f) { s.save_picture(f, false); });
  if (name == "window")
    return with_file([](Session& s, const std::string& f) { s.save_picture(f, true); });
  if (name == "save")
    return with_file([](Session& s, const std::string& f) { s.save_bookmarks(f); });
  if (name == "path")
    return with_file([count = whole(words[2], 2, kMostPictures)](Session& s, const std::string& f) {
      s.start_path(f, count);
    });
  return nullptr;
}

Script::Action Script::parse(const Words& words) {
  check_words(words);
  for (const auto parser : {parse_wait, parse_setting, parse_file})
    if (Action action = parser(words)) return action;
  const std::string& name = words[0];
  if (name == "bookmark") return at_once([](Session& s) { s.add_bookmark(); });
  if (name == "measure") return at_once([](Session& s) { s.measure_error(); });
  if (name == "stop") return at_once([](Session& s) { s.cancel_path(); });
  if (name == "budget")
    return at_once(
        [v = number(words[1], kLeastBudget, kLargestBudget)](Session& s) { s.set_budget(v); });
  if (name == "turn")
    return at_once([x = number(words[1], -kMostDegrees, kMostDegrees),
                    y = number(words[2], -kMostDegrees, kMostDegrees)](Session& s) {
      constexpr double kRadians = 3.14159265358979323846 / 180;
      s.navigator.turn({x * kRadians, y * kRadians});
    });
  if (name == "move")
    return at_once([v = glm::dvec3(number(words[1]), number(words[2]), number(words[3]))](
                       Session& s) { s.navigator.move(v, 1 / s.navigator.speed()); });
  if (name == "size")
    return [size = VkExtent2D{side(words[1]), side(words[2])}](Session&, Canvas& canvas) {
      canvas.set_size(size);
      return true;
    };
  return at_once([](Session& s) { s.go_home(); });  // "home", the only one left
}

Script::Script(const std::string& path) : path_(path) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorCode::file_not_found, path + ": cannot be read");
  std::string text;
  for (size_t number = 1; std::getline(file, text); ++number) {
    std::istringstream stream(text);
    Words words;
    for (std::string word; stream >> word;) words.push_back(word);
    if (words.empty() || words[0][0] == '#') continue;
    try {
      lines_.push_back({text, parse(words)});
    } catch (const std::invalid_argument& problem) {
      throw Error(ErrorCode::refused_input,
                  fmt::format("{}: line {}: {}: {}", path, number, text, problem.what()));
    }
  }
}

Script::Script(size_t frames, const std::string& screenshot) : path_("--frames") {
  const auto add = [&](const Words& words) { lines_.push_back({words[0], parse(words)}); };
  add({"loaded"});
  frames == 0 ? add({"still"}) : add({"frames", std::to_string(frames)});
  if (!screenshot.empty()) add({"picture", screenshot});
}

bool Script::step(Session& session, Canvas& canvas) {
  const auto now = std::chrono::steady_clock::now();
  while (next_ < lines_.size()) {
    // Pictures that were asked for are of what was asked for before them.
    if (!session.captures().empty() || session.path()) return true;
    if (!lines_[next_].action(session, canvas)) {
      if (now - since_ > kLongestWait)
        throw Error(ErrorCode::timeout, path_ + ": " + lines_[next_].text + ": waited for " +
                                            std::to_string(kLongestWait.count()) + " minutes");
      return true;
    }
    ++next_;
    since_ = now;
  }
  return !session.captures().empty() || session.path();
}

}  // namespace voyager::view
