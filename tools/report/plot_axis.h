#pragma once
#include <string>
#include <vector>

namespace voyager::tools {

// From values to [0, 1], with round numbers to label.
class PlotAxis {
 public:
  struct Tick {
    double at;  // 0 to 1
    std::string label;
  };

  // A range that holds all values, and some more. No values: 0 to 1.
  PlotAxis(const std::vector<double>& values, bool logarithmic);

  double at(double value) const;
  std::vector<Tick> ticks() const;

 private:
  double scaled(double value) const;

  bool logarithmic_;
  double least_ = 0, most_ = 1;  // log10 where logarithmic
};

}  // namespace voyager::tools
