#include "tools/json_fields.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <cmath>

#include "runtime/base/error.h"

namespace voyager::tools {
namespace {

using Value = nlohmann::json;

std::string found_text(const Value& found) {
  std::string text = found.is_structured()
                         ? fmt::format("an {} of {}", found.type_name(), found.size())
                         : found.dump(-1, ' ', false, Value::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 60) + "…";
  return text;
}

}  // namespace

JsonFields::JsonFields(std::string place, const Value& json)
    : place_(std::move(place)), json_(json) {
  if (!json.is_object())
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found {}, expected an object", place_, found_text(json)));
}

void JsonFields::refuse(const std::string& name, const std::string& expected) const {
  throw Error(ErrorCode::refused_input, fmt::format("{}: {}: found {}, expected {}", place_, name,
                                                    found_text(field(name)), expected));
}

const Value& JsonFields::field(const std::string& name) const {
  const auto found = json_.find(name);
  if (found == json_.end())
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found no field {}, expected one", place_, name));
  return *found;
}

double JsonFields::number(const std::string& name) const {
  double value = 0;
  const Value& found = field(name);
  if (!found.is_number() || !std::isfinite(value = found.get<double>()))
    refuse(name, "a finite number");
  return value;
}

double JsonFields::positive(const std::string& name) const {
  const double value = number(name);
  if (!(value > 0)) refuse(name, "a number above 0");
  return value;
}

uint32_t JsonFields::side(const std::string& name, uint32_t largest) const {
  const double value = number(name);
  if (!(value >= 1 && value <= largest) || value != std::floor(value))
    refuse(name, fmt::format("a whole number from 1 to {}", largest));
  return static_cast<uint32_t>(value);
}

void JsonFields::fill(const std::string& name, const Value& value, double* into, size_t count,
                      const std::string& expected) const {
  if (!value.is_array() || value.size() < count) refuse(name, expected);
  for (size_t i = 0; i < count; ++i) {
    if (!value[i].is_number() || !std::isfinite(into[i] = value[i].get<double>()))
      refuse(name, expected);
  }
}

Eigen::Vector3d JsonFields::vector(const std::string& name) const {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  if (field(name).size() != 3) refuse(name, "three finite numbers");
  fill(name, field(name), v.data(), 3, "three finite numbers");
  return v;
}

Eigen::MatrixXd JsonFields::matrix(const std::string& name, size_t rows, size_t most_rows,
                                   size_t columns) const {
  const Value& value = field(name);
  const std::string count =
      rows == most_rows ? std::to_string(rows) : fmt::format("{} or {}", rows, most_rows);
  const std::string expected = fmt::format("{} rows of {} finite numbers", count, columns);
  if (!value.is_array() || value.size() < rows || value.size() > most_rows) refuse(name, expected);
  Eigen::MatrixXd m(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  Eigen::VectorXd row(static_cast<Eigen::Index>(columns));
  for (size_t i = 0; i < rows; ++i) {
    if (value[i].size() != columns) refuse(name, expected);
    fill(name, value[i], row.data(), columns, expected);
    m.row(static_cast<Eigen::Index>(i)) = row.transpose();
  }
  return m;
}

bool is_rotation(const Eigen::Matrix3d& m) {
  return (m * m.transpose()).isIdentity(1e-3) && m.determinant() > 0;
}

}  // namespace voyager::tools
