#pragma once
// What a report has measured so far, in a hidden folder, so that one that was ended goes on.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/owned_folder.h"
#include "tools/report/report_row.h"

namespace voyager::tools {

struct KeptRow {
  ReportRow row;
  std::string picture, difference;  // PNGs
};

class KeptRows {
 public:
  // What is in the folder is another report's unless its provenance is the same: it is removed
  // then. Throws Error(refused_input) for a folder with files that are no report's; Error(io),
  // also where another process makes a report there.
  KeptRows(const std::filesystem::path& folder, const nlohmann::ordered_json& provenance);

  std::filesystem::path folder() const { return folder_.path(); }
  std::optional<KeptRow> find(const ReportCase& is) const;
  void keep(const KeptRow& row);
  // The report is there. Returns what is in the folder that no report has written: that stays.
  std::vector<std::string> remove();

 private:
  std::filesystem::path path_of(const ReportCase& is, const char* ending) const;

  OwnedFolder folder_;
};

}  // namespace voyager::tools
