#pragma once
// What a report has measured so far, in a hidden folder, so that one that was ended goes on.
#include <filesystem>
#include <optional>
#include <string>

#include "tools/report/report_row.h"

namespace voyager::tools {

struct KeptRow {
  ReportRow row;
  std::string picture, difference;  // PNGs
};

class KeptRows {
 public:
  // What is in the folder is of another report, or of none, unless its provenance is the same: it
  // is removed then. Throws Error(io).
  KeptRows(std::filesystem::path folder, const nlohmann::ordered_json& provenance);

  const std::filesystem::path& folder() const { return folder_; }
  std::optional<KeptRow> find(const ReportCase& is) const;
  void keep(const KeptRow& row);
  // The report is there.
  void remove();

 private:
  std::filesystem::path path_of(const ReportCase& is, const char* extension) const;

  std::filesystem::path folder_;
};

}  // namespace voyager::tools
