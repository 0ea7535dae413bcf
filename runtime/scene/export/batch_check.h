#pragma once
// What every writer checks of its batches before it writes a byte of them.
#include <array>
#include <string>

#include "runtime/base/error.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

inline void check_sh_degree(int sh_degree) {
  if (sh_degree < 0 || sh_degree > kMaxShDegree)
    throw Error(ErrorCode::invalid_argument,
                "SH degree: found " + std::to_string(sh_degree) + ", expected 0 to 3");
}

class BatchCheck {
 public:
  BatchCheck(uint64_t count, int sh_degree) : count_(count), sh_degree_(sh_degree) {}

  void accept(const GaussianCloud& batch) {
    if (batch.size() > 0 && batch.sh_degree != sh_degree_)
      throw Error(ErrorCode::invalid_argument,
                  "SH degree of a batch: found " + std::to_string(batch.sh_degree) +
                      ", expected the announced " + std::to_string(sh_degree_));
    if (batch.size() > count_ - written_) fail(written_ + batch.size());
    written_ += batch.size();
  }
  // For formats whose positions have one place that they are relative to.
  void accept_of_one_origin(const GaussianCloud& batch) {
    if (written_ > 0 && batch.size() > 0 && batch.origin != origin_)
      throw Error(ErrorCode::invalid_argument,
                  "origin of a batch: found another than the first batch's, expected the same");
    accept(batch);
    if (written_ == batch.size()) origin_ = batch.origin;
  }
  void finish() const {
    if (written_ != count_) fail(written_);
  }
  uint64_t written() const { return written_; }
  // Of accept_of_one_origin().
  const std::array<double, 3>& origin() const { return origin_; }

 private:
  [[noreturn]] void fail(uint64_t found) const {
    throw Error(ErrorCode::invalid_argument, "Gaussians to write: found " + std::to_string(found) +
                                                 ", expected the announced " +
                                                 std::to_string(count_));
  }

  uint64_t count_, written_ = 0;
  int sh_degree_;
  std::array<double, 3> origin_{0, 0, 0};
};

}  // namespace voyager
