#pragma once
// Which configurations are worth their time.
#include <optional>
#include <vector>

#include "tools/report/report_row.h"

namespace voyager::tools {

// Indices of the rows that no other beats in both: the frame's median time, and FLIP against all
// leaves. By time, the fastest first; of equal rows the first.
std::vector<size_t> pareto_front(const std::vector<ReportRow>& rows);

// The least error on the front whose frames' p95 is within the target, in milliseconds; none
// where none is.
std::optional<size_t> recommend(const std::vector<ReportRow>& rows,
                                const std::vector<size_t>& front, double target);

// As options of `voyager render`: "--tau 6 --exp lut --lut-size 32". What has no option there (SH
// bands, storage) is said in words.
std::string render_options(const ReportCase& is, double tau);

}  // namespace voyager::tools
