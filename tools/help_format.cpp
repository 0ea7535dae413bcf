#include "tools/help_format.h"

#include <algorithm>
#include <sstream>

namespace voyager::tools {
namespace {

constexpr size_t kOptionColumns = 26, kCommandColumns = 12, kPageColumns = 80;

// Bytes of UTF-8 that begin a character.
size_t columns(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

// Two columns; the right one begins at `begin` and is broken between words.
std::string row(const std::string& left, const std::string& right, size_t begin) {
  std::string text = "  " + left;
  size_t at = columns(text);
  if (at + 2 > begin) {
    text += "\n";
    at = 0;
  }
  std::istringstream words(right);
  for (std::string word; words >> word;) {
    if (at > begin && at + 1 + columns(word) > kPageColumns) {
      text += "\n";
      at = 0;
    }
    const size_t gap = at < begin ? begin - at : 1;
    text += std::string(gap, ' ') + word;
    at += gap + columns(word);
  }
  return text + "\n";
}

std::string description_of(const CLI::Option& option) {
  std::string text = option.get_description();
  if (option.get_required()) text += " (required)";
  if (!option.get_default_str().empty()) text += " (default: " + option.get_default_str() + ")";
  return text;
}

std::string left_of(const CLI::Option& option, bool positional) {
  std::string text = positional ? option.get_name(true, false) : option.get_name(false, true);
  if (const size_t comma = text.find(','); comma != std::string::npos) text.insert(comma + 1, " ");
  if (!positional && option.get_items_expected_max() > 0) text += " " + option.get_type_name();
  return text;
}

using Options = std::vector<const CLI::Option*>;

std::string section(const std::string& title, const Options& options, bool positional) {
  if (options.empty()) return "";
  std::string text = "\n" + title + ":\n";
  for (const CLI::Option* option : options)
    text += row(left_of(*option, positional), description_of(*option), kOptionColumns);
  return text;
}

Options positionals(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

// "voyager render scene -o FILE [options]"
std::string usage(const CLI::App& app) {
  std::string text = (app.get_parent() ? app.get_parent()->get_name() + " " : "") + app.get_name();
  if (!app.get_subcommands({}).empty()) return text + " COMMAND ...";
  for (const CLI::Option* option : positionals(app))
    text +=
        " " + option->get_name(true, false) + (option->get_items_expected_max() > 1 ? " ..." : "");
  for (const CLI::Option* option : app.get_options())
    if (option->get_required() && option->nonpositional())
      text += " " + option->get_name() + " " + option->get_type_name();
  return text + " [options]";
}

class HelpFormat final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
    std::string text = app->get_description() + "\n\nUsage: " + usage(*app) + "\n";
    const auto commands = app->get_subcommands({});
    if (!commands.empty()) text += "\nCommands:\n";
    for (const CLI::App* command : commands)
      text += row(command->get_name(), command->get_description(), kCommandColumns);
    text += section("Input", positionals(*app), true);
    std::vector<std::string> groups = app->get_groups();
    // What every command has comes last.
    std::stable_partition(groups.begin(), groups.end(),
                          [](const std::string& group) { return group != "Options"; });
    for (const std::string& group : groups)
      text += section(group == "Options" ? "General" : group,
                      app->get_options([&group](const CLI::Option* option) {
                        return option->nonpositional() && option->get_group() == group;
                      }),
                      false);
    return text + "\n" + app->get_footer() + "\n";
  }
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_format() {
  return std::make_shared<HelpFormat>();
}

}  // namespace voyager::tools
