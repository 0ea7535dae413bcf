#pragma once
// Which configurations are worth their time.
#include <string>
#include <vector>

#include "tools/report/report_row.h"

namespace voyager::tools {

// Indices of the rows that no other beats in both: the frame's median time, and FLIP against all
// leaves. By time, the fastest first; of equal rows the first.
std::vector<size_t> pareto_front(const std::vector<ReportRow>& rows);

struct Advice {
  size_t row = 0;
  bool in_time = false;  // else nothing is, and it is the fastest
};

// The least error of rows whose frames' p95 is within the target, in milliseconds; of the same
// error the first row, the default, else the fastest. Of rows that a host can ask for and that
// change the image: not of fewer SH bands than the first row's, which no option drops, nor of other
// searches and without the α-filter, which draw the same and differ by the clock's noise alone. The
// first row is neither.
Advice advise(const std::vector<ReportRow>& rows, double target);

// As options of `voyager render`: "--tau 6 --exp lut --lut-size 32". What has no option there (SH
// bands, storage) is said in words.
std::string render_options(const ReportCase& is, double tau);

}  // namespace voyager::tools
