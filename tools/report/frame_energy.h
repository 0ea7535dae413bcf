#pragma once
#include <optional>

#include "runtime/base/clock.h"
#include "tools/report/energy_meter.h"

namespace voyager::tools {

// The energy of frames drawn one after another. Sensors are read every tenth of a second or so: of
// less than `least` milliseconds there is no figure.
class FrameEnergy {
 public:
  static constexpr double kLeast = 1500;

  // meter: may be null. The first `untimed` frames do not count.
  FrameEnergy(EnergyMeter* meter, size_t untimed, double least = kLeast)
      : meter_(meter), untimed_(untimed), least_(least) {}

  // So many have been drawn.
  void frame(size_t drawn);
  // There is a sensor that answers, and it has not seen enough.
  bool wants_more() const { return before_ && watch_.milliseconds() < least_; }
  std::optional<double> joules_a_frame() const;

 private:
  EnergyMeter* meter_;
  size_t untimed_, drawn_ = 0;
  double least_;
  Stopwatch watch_;
  std::optional<double> before_;
};

}  // namespace voyager::tools
