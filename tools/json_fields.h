#pragma once
// The fields of a JSON object that came from outside: each is there and of its kind, or the file
// is refused with the place, the field, what was found and what was expected.
#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace voyager::tools {

class JsonFields {
 public:
  // `place` is the file and the object's place in it, as a message names them. Throws
  // Error(refused_input), as all below, unless `json`, which must outlive this, is an object.
  JsonFields(std::string place, const nlohmann::json& json);

  bool has(const std::string& name) const { return json_.contains(name); }
  const nlohmann::json& field(const std::string& name) const;
  double number(const std::string& name) const;    // finite
  double positive(const std::string& name) const;  // and above 0
  // Of a picture: a whole number from 1.
  uint32_t side(const std::string& name, uint32_t largest) const;
  Eigen::Vector3d vector(const std::string& name) const;
  // As rows. `rows` are the least and the most that there may be; those beyond the least are left
  // out.
  Eigen::MatrixXd matrix(const std::string& name, size_t rows, size_t most_rows,
                         size_t columns) const;

  [[noreturn]] void refuse(const std::string& name, const std::string& expected) const;

 private:
  void fill(const std::string& name, const nlohmann::json& value, double* into, size_t count,
            const std::string& expected) const;

  std::string place_;
  const nlohmann::json& json_;
};

// Orthonormal within 0.001, determinant +1.
bool is_rotation(const Eigen::Matrix3d& m);
inline constexpr const char* kRotationExpected =
    "a rotation (orthonormal within 0.001, determinant +1)";

}  // namespace voyager::tools
