#pragma once
// What a browser finds wrong with a page.
#include <filesystem>

#include "tests/command_line/program.h"

namespace voyager::test {

// The distribution's command for a browser without a window; "" where there is none.
inline std::string browser() {
  for (const char* name : {"chromium-headless-shell", "chromium"})
    if (run_shell(std::string("command -v ") + name).exit_code == 0) return name;
  return "";
}

struct PageCheck {
  std::string findings;  // a line each
  size_t images = 0, plots = 0, links = 0;
};

// Opens the page in the browser, as a user does. Looks at every image, inline plot and link, and at
// what the page says on the console, errors of scripts among it: all that it says is a finding.
inline PageCheck check_page(const std::string& browser, const std::string& page) {
  const std::string output =
      run_shell("timeout 100 " + browser +
                " --headless --no-sandbox --disable-gpu --allow-file-access-from-files"
                " --enable-logging=stderr --virtual-time-budget=20000 --dump-dom"
                " 'file://" VOYAGER_SOURCE_DIR "/tests/command_line/page_check.html?" +
                std::filesystem::absolute(page).string() + "'")
          .output;
  PageCheck check;
  const std::string tag = "<pre id=\"findings\">";
  const size_t begin = output.find(tag), end = output.find("checked: ", begin);
  if (end == std::string::npos ||
      std::sscanf(output.c_str() + end, "checked: %zu images, %zu plots, %zu links", &check.images,
                  &check.plots, &check.links) != 3)
    check.findings = "the page was not checked:\n" + output;
  else
    check.findings = output.substr(begin + tag.size(), end - begin - tag.size());
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);)
    if (line.find("INFO:CONSOLE") != std::string::npos) check.findings += line + "\n";
  return check;
}

}  // namespace voyager::test
