// The documentation against the tree: links lead somewhere, commands have options that exist.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "tests/command_line/program.h"

namespace voyager::docs_test {
namespace {

using namespace voyager::test;
namespace fs = std::filesystem;

struct Line {
  int number;
  bool code;  // indented or fenced
  std::string text;
};

struct Page {
  fs::path path;
  std::vector<Line> lines;
};

std::vector<Line> lines_of(const fs::path& path) {
  std::vector<Line> lines;
  std::istringstream in(file_bytes(path));
  bool fenced = false;
  int number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (text.starts_with("```")) {
      fenced = !fenced;
      continue;
    }
    lines.push_back({number, fenced || text.starts_with("    "), text});
  }
  return lines;
}

// The pages of the tree, without what was built in it.
const std::vector<Page>& pages() {
  static const std::vector<Page> all = [] {
    const fs::path root = VOYAGER_SOURCE_DIR;
    std::vector<Page> found;
    for (auto at = fs::recursive_directory_iterator(root); at != fs::recursive_directory_iterator();
         ++at) {
      const std::string name = at->path().filename();
      if (at->is_directory() && (name == "build" || name.starts_with(".")))
        at.disable_recursion_pending();
      else if (at->path().extension() == ".md")
        found.push_back({at->path(), lines_of(at->path())});
    }
    return found;
  }();
  return all;
}

std::string anchor_of(std::string heading) {
  heading = std::regex_replace(heading, std::regex(R"(\[([^\]]*)\]\([^)]*\))"), "$1");
  std::string anchor;
  for (const char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 || std::isalnum(byte) != 0 || c == '-' || c == '_')
      anchor += static_cast<char>(byte < 0x80 ? std::tolower(byte) : byte);
    else if (c == ' ')
      anchor += '-';
  }
  return anchor;
}

const std::set<std::string>& anchors_of(const fs::path& path) {
  static std::map<fs::path, std::set<std::string>> known;
  const auto [at, fresh] = known.try_emplace(path);
  if (!fresh) return at->second;
  const std::regex heading("#+ +(.*[^ ]) *");
  std::smatch found;
  for (const Line& line : lines_of(path))
    if (!line.code && line.text.starts_with("#") && std::regex_match(line.text, found, heading))
      at->second.insert(anchor_of(found[1]));
  return at->second;
}

// What is wrong with a link of a page, "" where it leads somewhere.
std::string fault_of(const fs::path& page, const std::string& link) {
  if (link.starts_with("http:") || link.starts_with("https:")) return "";
  const size_t hash = link.find('#');
  const std::string file = link.substr(0, hash);
  const fs::path target = file.empty() ? page : (page.parent_path() / file).lexically_normal();
  if (!fs::exists(target)) return "found no such file";
  if (hash == std::string::npos || target.extension() != ".md") return "";
  return anchors_of(target).contains(link.substr(hash + 1)) ? "" : "found no such heading";
}

TEST(Docs, EachLinkLeadsSomewhere) {
  const std::regex link(R"(\]\(([^)\s]+)\))"), quoted("`[^`]*`");
  size_t links = 0;
  for (const Page& page : pages())
    for (const Line& line : page.lines) {
      if (line.code || line.text.find("](") == std::string::npos) continue;
      const std::string text = std::regex_replace(line.text, quoted, "");
      for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at, ++links)
        EXPECT_EQ(fault_of(page.path, (*at)[1]), "")
            << page.path.string() << ":" << line.number << ": " << (*at)[1];
    }
  EXPECT_GT(links, 100u);
}

// A command's options as its own help has them.
const std::set<std::string>& options_of(const std::string& command) {
  static std::map<std::string, std::set<std::string>> known;
  const auto [at, fresh] = known.try_emplace(command);
  if (fresh) {
    const Outcome help = run("voyager " + command + " --help");
    if (help.output.find("Usage: voyager " + command) == std::string::npos) return at->second;
    const std::regex option(R"((^|[ ,\[|])(--?[a-z][a-z0-9-]*))");
    for (std::sregex_iterator o(help.output.begin(), help.output.end(), option), end; o != end; ++o)
      at->second.insert((*o)[2]);
  }
  return at->second;
}

// Pieces of a line in which a shell's command may stand.
std::vector<std::string> commands_in(const Line& line) {
  if (line.text.find("voyager ") == std::string::npos) return {};
  if (line.code) return {line.text.substr(0, line.text.find(" #"))};
  std::vector<std::string> pieces;
  const std::regex quoted("`([^`]*)`");
  for (std::sregex_iterator at(line.text.begin(), line.text.end(), quoted), end; at != end; ++at)
    pieces.push_back((*at)[1]);
  return pieces;
}

// What people are told to type today: neither what changed, nor what was measured once.
bool is_history(const fs::path& page) {
  return page.filename() == "CHANGELOG.md" || page.filename() == "NOTES.md";
}

TEST(Docs, EachCommandHasTheOptionsThatItIsGiven) {
  const std::regex command(R"((^|[;&|$/] *| {4})voyager ([a-z]+)([^;&|]*))");
  const std::regex option(R"((\s|\[)(--?[a-z][a-z0-9-]*))");
  size_t commands = 0;
  for (const Page& page : pages()) {
    if (is_history(page.path)) continue;
    for (const Line& line : page.lines)
      for (const std::string& text : commands_in(line))
        for (std::sregex_iterator at(text.begin(), text.end(), command), end; at != end; ++at) {
          const std::string name = (*at)[2], given = (*at)[3];
          const std::set<std::string>& known = options_of(name);
          const std::string place = page.path.string() + ":" + std::to_string(line.number);
          EXPECT_FALSE(known.empty()) << place << ": voyager has no command " << name;
          ++commands;
          for (std::sregex_iterator o(given.begin(), given.end(), option); o != end; ++o)
            EXPECT_TRUE(known.contains((*o)[2]))
                << place << ": voyager " << name << " has no " << (*o)[2];
        }
  }
  EXPECT_GT(commands, 50u);
}

}  // namespace
}  // namespace voyager::docs_test
