#include "tools/flat_output.h"

#include <fmt/core.h>

#include <filesystem>

#include "tools/byte_size.h"
#include "tools/console.h"

namespace voyager::tools {

void note_losses(const std::string& path, const FlatContents& contents) {
  for (const std::string& lost : losses(flat_format_of(path).value(), contents))
    note(path + ": " + lost);
}

void describe_flat_file(const std::string& path, const FlatContents& contents) {
  note_losses(path, contents);
  say(fmt::format("{}: {} Gaussians of SH degree {}, {}\n", path, contents.count,
                  contents.sh_degree, size_text(std::filesystem::file_size(path))));
  const ImportReport& report = contents.report;
  if (report.dropped() + report.repaired() > 0)
    say(fmt::format("{} Gaussians dropped, {} repaired\n", report.dropped(), report.repaired()));
}

}  // namespace voyager::tools
