#include "tools/report/kept_rows.h"

#include <fmt/core.h>

#include <fstream>
#include <iterator>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/base/file.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path.string());
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

}  // namespace

KeptRows::KeptRows(std::filesystem::path folder, const Json& provenance)
    : folder_(std::move(folder)) {
  const std::filesystem::path key = folder_ / "provenance.json";
  const std::string text = provenance.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (text_of(key) == text) return;
  std::error_code error;
  std::filesystem::remove_all(folder_, error);
  if (!error) std::filesystem::create_directories(folder_, error);
  if (error) throw Error(ErrorCode::io, folder_.string() + ": folder: " + error.message());
  write(key, text);
}

std::filesystem::path KeptRows::path_of(const ReportCase& is, const char* extension) const {
  const std::string name = is.group + ", " + is.name();
  return folder_ /
         fmt::format("row-{:016x}{}", checksum(std::as_bytes(std::span(name))), extension);
}

// The row is written last.
std::optional<KeptRow> KeptRows::find(const ReportCase& is) const {
  const Json json = Json::parse(text_of(path_of(is, ".json")), nullptr, false);
  if (json.is_discarded() || json["name"] != is.name()) return std::nullopt;
  try {
    return KeptRow{row_from_json(json, is), text_of(path_of(is, ".png")),
                   text_of(path_of(is, ".difference.png"))};
  } catch (const Json::exception&) {  // of a build that measured less
    return std::nullopt;
  }
}

void KeptRows::keep(const KeptRow& row) {
  write(path_of(row.row.is, ".png"), row.picture);
  write(path_of(row.row.is, ".difference.png"), row.difference);
  write(path_of(row.row.is, ".json"), to_json(row.row).dump() + "\n");
}

void KeptRows::remove() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

}  // namespace voyager::tools
