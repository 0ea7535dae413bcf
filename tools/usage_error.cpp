#include "tools/usage_error.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace voyager::tools {
namespace {

// The edit distance: how many letters must be inserted, removed or replaced.
size_t distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

const CLI::App& parsed_command(const CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? app : *parsed.front();
}

std::string name_of(const CLI::App& command) {
  return command.get_parent() ? command.get_parent()->get_name() + " " + command.get_name()
                              : command.get_name();
}

std::string suggestion(const std::string& found, const std::vector<std::string>& candidates) {
  const std::string meant = nearest(found, candidates);
  return meant.empty() ? "" : ", did you mean " + meant + "?";
}

// The argument that no option and no command has consumed, "" if there is none. If there are
// several: a wrong command, else the first that looks like an option, else the first.
std::string unexpected(const CLI::App& app) {
  const std::vector<std::string> rest = app.remaining(true);
  if (app.get_subcommands().empty() && !rest.empty() && !rest.front().starts_with('-'))
    return rest.front();
  const auto option =
      std::find_if(rest.begin(), rest.end(), [](const auto& a) { return a.starts_with('-'); });
  return option != rest.end() ? *option : rest.empty() ? "" : rest.front();
}

// "; scene is a.voy, -o is utput": what positional and one-letter options have consumed. It shows a
// user who typed -output that this was read as -o with the value "utput".
std::string taken(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options())
    if (option->count() != 0 && (option->get_positional() || !option->get_snames().empty()))
      text +=
          (text.empty() ? "; " : ", ") + option->get_name() + " is " + option->results().front();
  return text;
}

std::string refuse_unexpected(const CLI::App& command, const std::string& found) {
  std::vector<std::string> names;
  if (found.starts_with('-')) {
    for (const CLI::Option* option : command.get_options())
      if (option->nonpositional()) names.push_back(option->get_name());
    const std::string name = found.substr(0, found.find('='));
    return name + ": not an option of " + name_of(command) + " in this version" +
           suggestion(name, names);
  }
  if (command.get_parent() != nullptr)
    return found + ": found one argument too many" + taken(command);
  for (const CLI::App* known : command.get_subcommands({})) names.push_back(known->get_name());
  const std::string meant = suggestion(found, names);
  return found + ": not a command of this version" +
         (meant.empty() ? ", expected one of " + CLI::detail::join(names, ", ") : meant);
}

// CLI11's messages begin with the option's name.
std::string option_in(const std::string& message) {
  return message.substr(0, message.find_first_of(": "));
}

// "-o FILE: image to write, a .png": an option's name, type, and the first sentence of its
// description.
std::string expected_by(const CLI::App& command, const std::string& name) {
  const CLI::Option* option = command.get_option_no_throw(name);
  if (option == nullptr) return "one";
  std::string text = option->get_description();
  text = text.substr(0, text.find(". "));
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return option->nonpositional() ? name + " " + option->get_type_name() + ": " + text : text;
}

// The B of CLI11's "A excludes B" and "A requires B".
std::string other_option(const std::string& message) {
  return message.substr(message.rfind(' ') + 1);
}

std::string message_of(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = parsed_command(app);
  std::string what = error.what();
  const std::string name = option_in(what), found = unexpected(app);
  const bool extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const bool required = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  // If an option's name is mistyped, the option that was meant is missing. The mistyped name is the
  // better message.
  if ((extra && !found.empty()) || (required && found.starts_with('-')))
    return refuse_unexpected(command, found);
  if (required) return name + ": found none, expected " + expected_by(command, name);
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    return name + ": found it with " + other_option(what) + ", expected one of the two";
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    return name + ": found it without " + other_option(what) + ", expected both";
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    if (what.find("received") != std::string::npos)
      return name + ": found it more than once, expected it once";
    if (what.find("override") != std::string::npos)  // this message names flags without dashes
      return "--" + name + ": found a value, expected none";
    return name + ": found no value, expected " + expected_by(command, name);
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr)
    return name + ": found a value, expected none";
  return what;
}

}  // namespace

std::string nearest(const std::string& found, const std::vector<std::string>& candidates) {
  if (found.size() < 3) return "";
  const size_t far = std::max<size_t>(2, found.size() / 3) + 1;
  std::string best;
  size_t least = far;
  for (const std::string& candidate : candidates) {
    const bool begun = found.size() > 3 && candidate.starts_with(found);
    const size_t apart = begun ? 0 : distance(found, candidate);
    if (apart < least && apart < std::max(found.size(), candidate.size()) / 2 + 1) {
      least = apart;
      best = candidate;
    }
  }
  return best;
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  return message_of(app, error) + " (see " + name_of(parsed_command(app)) + " --help)";
}

}  // namespace voyager::tools
