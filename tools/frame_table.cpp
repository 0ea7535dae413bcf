#include "tools/frame_table.h"

#include <fmt/core.h>

#include <algorithm>

#include "tools/console.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

// A number, or a dash where it is not known.
std::string cell(const Json& value, int digits) {
  return value.is_null() ? "-" : fmt::format("{:.{}f}", value.get<double>(), digits);
}

class Table {
 public:
  explicit Table(const Json& rows) : rows_(rows) {
    for (const Json& row : rows)
      name_width_ = std::max(name_width_, row["name"].get<std::string>().size() + 1);
  }

  // A column; value(row) gives its cell.
  template <class Value>
  Table& column(const char* title, const Value& value) {
    Column column{title, {}};
    for (const Json& row : rows_) column.cells.push_back(value(row));
    columns_.push_back(std::move(column));
    return *this;
  }

  void print(const char* title) const {
    say(fmt::format("{:<{}}", title, name_width_));
    for (const Column& column : columns_) say(fmt::format("{:>{}}", column.title, width(column)));
    say("\n");
    for (size_t i = 0; i < rows_.size(); ++i) {
      say(fmt::format("{:<{}}", rows_[i]["name"].get<std::string>(), name_width_));
      for (const Column& column : columns_)
        say(fmt::format("{:>{}}", column.cells[i], width(column)));
      say("\n");
    }
  }

 private:
  struct Column {
    std::string title;
    std::vector<std::string> cells;
  };
  static size_t width(const Column& column) {
    size_t widest = column.title.size();
    for (const std::string& text : column.cells) widest = std::max(widest, text.size());
    return widest + 2;
  }

  const Json& rows_;
  size_t name_width_ = 14;
  std::vector<Column> columns_;
};

void print_times(const Json& rows) {
  Table table(rows);
  const auto ms = [](const char* what, const char* which) {
    return [what, which](const Json& row) { return cell(row["ms"][what][which], 3); };
  };
  table.column("frame", ms("frame", "median"))
      .column("p95", ms("frame", "p95"))
      .column("p99", ms("frame", "p99"));
  for (const char* stage : {"search", "project", "sort", "bin", "rasterize", "resolve"})
    table.column(stage, ms(stage, "median"));
  if (rows[0].contains("speedup"))
    for (const char* slower : {"base", "3dgs"})
      table.column(slower == std::string("base") ? "base/x" : "3dgs/x",
                   [slower](const Json& row) { return cell(row["speedup"][slower], 2); });
  if (rows[0].contains("error"))
    table
        .column("PSNR",
                [](const Json& row) {
                  return row["error"]["psnr"].is_null() ? "same" : cell(row["error"]["psnr"], 2);
                })
        .column("largest/255", [](const Json& row) {
          return fmt::format("{:.2f}", 255 * row["error"]["largest"].get<double>());
        });
  table.print("milliseconds");
}

void print_counters(const Json& rows) {
  Table table(rows);
  const std::pair<const char*, const char*> counters[] = {{"cut", "cut"},
                                                          {"splats", "splats"},
                                                          {"pairs before", "pairs_before"},
                                                          {"pairs", "pairs_after"},
                                                          {"dropped", "pairs_dropped"},
                                                          {"pixels evaluated", "pixels_evaluated"},
                                                          {"blended", "pixels_blended"},
                                                          {"list places", "list_places"},
                                                          {"read", "list_places_read"}};
  for (const auto& [title, counter] : counters)
    table.column(title,
                 [name = counter](const Json& row) { return cell(row["counters"][name], 0); });
  table.column("blended/evaluated", [](const Json& row) { return cell(row["work_efficiency"], 3); })
      .print("means a frame");
}

void print_floors(const Json& rows) {
  Table table(rows);
  if (!rows[0]["floor"].is_null()) {
    for (const char* part : {"project", "sort", "blend", "out", "frame"})
      table.column(part, [part](const Json& row) { return cell(row["floor"]["ms"][part], 4); });
    for (const char* part : {"project", "sort", "rasterize", "frame"})
      table.column(("score " + std::string(part)).c_str(),
                   [part](const Json& row) { return cell(row["floor"]["score"][part], 3); });
  }
  for (const char* part : {"project", "sort", "blend", "out", "frame"})
    table.column(("Orin " + std::string(part)).c_str(),
                 [part](const Json& row) { return cell(row["orin"]["model_ms"][part], 3); });
  table.print("floors, ms");
}

}  // namespace

void print_frames(const Json& rows) {
  if (rows.empty()) return;
  print_times(rows);
  say("\n");
  print_counters(rows);
  say("\n");
  print_floors(rows);
}

}  // namespace voyager::tools
