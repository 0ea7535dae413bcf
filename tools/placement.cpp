#include "tools/placement.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "runtime/scene/import/placed_blocks.h"
#include "runtime/scene/transform.h"
#include "tools/options.h"

namespace voyager::tools {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

[[noreturn]] void refuse(const std::string& text) {
  throw CLI::ValidationError(
      "--transform",
      "found " + text +
          ", expected three or four rows of four numbers (\"1 0 0 5, 0 1 0 0, 0 0 1 0\"), or terms "
          "out of \"translate X Y Z\", \"rotate X Y Z DEGREES\" and \"scale S\" or \"scale X Y "
          "Z\", "
          "parted by commas");
}

// The words between commas.
std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line, ',');) {
    std::istringstream words(line);
    rows.emplace_back();
    for (std::string word; words >> word;) rows.back().push_back(word);
  }
  return rows;
}

// All but the first `skip` words.
std::vector<double> numbers_of(const std::vector<std::string>& row, size_t skip,
                               const std::string& text) {
  std::vector<double> numbers;
  for (size_t i = skip; i < row.size(); ++i) {
    const auto number = parse_number(row[i]);
    if (!number) refuse(text);
    numbers.push_back(*number);
  }
  return numbers;
}

Affine term_of(const std::vector<std::string>& row, const std::string& text) {
  const std::vector<double> v = numbers_of(row, 1, text);
  if (row[0] == "translate" && v.size() == 3) return {kIdentity, {v[0], v[1], v[2]}};
  if (row[0] == "scale" && v.size() == 1) return {{{{v[0], 0, 0}, {0, v[0], 0}, {0, 0, v[0]}}}, {}};
  if (row[0] == "scale" && v.size() == 3) return {{{{v[0], 0, 0}, {0, v[1], 0}, {0, 0, v[2]}}}, {}};
  if (row[0] != "rotate" || v.size() != 4) refuse(text);
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 0)) refuse(text);
  const double half = v[3] * kDegree / 2, s = std::sin(half) / length;
  return {rotation(normalise(Quatd{std::cos(half), s * v[0], s * v[1], s * v[2]})), {}};
}

Affine matrix_of(const std::vector<std::vector<std::string>>& rows, const std::string& text) {
  if (rows.size() < 3 || rows.size() > 4) refuse(text);
  Affine affine;
  for (size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> v = numbers_of(rows[i], 0, text);
    if (v.size() != 4 || (i == 3 && v != std::vector<double>{0, 0, 0, 1})) refuse(text);
    if (i == 3) continue;
    affine.linear.row[i] = {v[0], v[1], v[2]};
    affine.offset[static_cast<int>(i)] = v[3];
  }
  return affine;
}

template <class T>
const T& one_of(const std::vector<T>& given, size_t i) {
  return given.size() == 1 ? given[0] : given[i];
}

void require_number(const char* option, size_t found, size_t inputs) {
  if (found > 1 && found != inputs)
    throw CLI::ValidationError(option, "found " + std::to_string(found) +
                                           " of them, expected one, or one for each of the " +
                                           std::to_string(inputs) + " inputs in their order");
}

std::string exactly(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace

Affine parse_transform(const std::string& text) {
  const auto rows = rows_of(text);
  if (rows.empty() ||
      std::any_of(rows.begin(), rows.end(), [](const auto& r) { return r.empty(); }))
    refuse(text);
  if (parse_number(rows[0][0])) return matrix_of(rows, text);
  Affine affine;
  for (const auto& row : rows) affine = term_of(row, text) * affine;
  return affine;
}

Affine turn_up(const std::string& axis) {
  if (axis == "y") return {{{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}, {}};
  if (axis == "z") return {kFromZUp, {}};
  return {};
}

std::vector<Affine> Placement::of(size_t inputs) const {
  require_number("--up", up.size(), inputs);
  require_number("--transform", transforms.size(), inputs);
  std::vector<Affine> places(inputs);
  for (size_t i = 0; i < inputs; ++i) {
    if (!up.empty()) places[i] = turn_up(one_of(up, i));
    if (!transforms.empty()) places[i] = one_of(transforms, i) * places[i];
  }
  return places;
}

void add_placement_options(CLI::App& command, Placement& placement) {
  command
      .add_option(
          "--up", placement.up,
          "Which axis of an input points up: -y, as in INRIA's files and by default, y or z. "
          "Given once for all inputs, or once for each in their order")
      ->check(CLI::Validator(
          [](const std::string& axis) {
            return axis == "y" || axis == "z" || axis == "-y"
                       ? ""
                       : "found " + axis + ", expected y|z|-y";
          },
          ""))
      ->allow_extra_args(false)
      ->type_name("y|z|-y");
  command
      .add_option_function<std::vector<std::string>>(
          "--transform",
          [&placement](const std::vector<std::string>& texts) {
            for (const std::string& text : texts)
              placement.transforms.push_back(parse_transform(text));
          },
          "Move an input, after --up: \"scale 2, rotate 0 1 0 90, translate 10 0 5\", or a matrix "
          "of rows, \"1 0 0 5, 0 1 0 0, 0 0 1 0\". Given once for all inputs, or once for each in "
          "their order")
      ->allow_extra_args(false)
      ->type_name("TEXT");
  name_group(command, "Where the inputs go");
}

std::vector<std::unique_ptr<BlockReader>> placed(std::vector<std::unique_ptr<BlockReader>> readers,
                                                 const std::vector<Affine>& places) {
  Vec3d middle{};
  for (size_t i = 0; i < readers.size(); ++i) {
    const std::array<double, 3> own = readers[i]->origin();
    middle = middle +
             1 / static_cast<double>(readers.size()) * (places[i] * Vec3d{own[0], own[1], own[2]});
  }
  const std::array<double, 3> origin = origin_near(middle);
  for (size_t i = 0; i < readers.size(); ++i) {
    const std::string what = readers[i]->name() + ": --transform";
    readers[i] = place_blocks(std::move(readers[i]), places[i], origin, what);
  }
  return readers;
}

std::string request_lines(const std::vector<Affine>& places) {
  if (std::all_of(places.begin(), places.end(), [](const Affine& a) { return a == Affine{}; }))
    return {};
  std::string text;
  for (const Affine& place : places) {
    text += "placed by";
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) text += " " + exactly(place.linear.row[i][k]);
      text += " " + exactly(place.offset[i]);
    }
    text += "\n";
  }
  return text;
}

}  // namespace voyager::tools
