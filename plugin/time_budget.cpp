#include "plugin/time_budget.h"

#include "plugin/structs.h"

namespace voyager {

void check_time_budget(const VoyTimeBudget& budget) {
  const auto check = [](const char* field, double found, bool right, const std::string& expected) {
    if (!std::isfinite(found) || !right)
      refuse_number(std::string("VoyTimeBudget.") + field, found, expected);
  };
  check("milliseconds", budget.milliseconds, budget.milliseconds > 0, "a finite number, > 0");
  check("minTau", budget.minTau, budget.minTau >= 0, "a finite number of pixels, >= 0");
  check("maxTau", budget.maxTau, budget.maxTau >= budget.minTau,
        "a finite number of pixels, >= minTau");
}

void set_time_budget(ViewObject& view, const VoyTimeBudget& budget) {
  if (!view.view->may_draw_cut())
    throw ApiError(VOY_ERROR_UNSUPPORTED,
                   "VoyTimeBudget: found a view of every leaf, where tau has no effect; expected a "
                   "view that draws cuts");
  view.view->set_time_budget({budget.milliseconds, budget.minTau, budget.maxTau}, view.tau);
}

}  // namespace voyager
