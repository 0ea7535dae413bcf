#include "tools/report/report_case.h"

#include <fmt/core.h>

#include <algorithm>

#include "tools/frame_rows.h"
#include "tools/lod_options.h"

namespace voyager::tools {
namespace {

struct Extents {
  std::vector<double> taus, taus_of_baselines;  // beside the default
  std::vector<uint32_t> lut_sizes;
};

Extents extents_of(ReportExtent extent) {
  if (extent == ReportExtent::quick) return {{6, 15}, {}, {32}};
  if (extent == ReportExtent::standard) return {{0, 1, 6, 15}, {15}, {8, 16, 31, 32, 64, 128}};
  return {{0, 0.5, 1, 2, 4, 6, 10, 15, 30, 60},
          {1, 6, 15, 30, 60},
          {4, 8, 16, 24, 31, 32, 48, 64, 128, 256}};
}

class Cases {
 public:
  Cases(ReportExtent extent, const ReportSubject& subject)
      : extent_(extent), subject_(subject), axes_(extents_of(extent)) {
    base_.group = "default";
    base_.sh_degree = subject.sh_degree;
    base_.desc.search = subject.search;
    base_.storage = subject.storages.front();
    base_.desc.exponential =
        has(Exponential::ex2) && subject.baseline ? Exponential::ex2 : Exponential::exact;
    if (subject.flat) base_.desc.lod = Lod::all_leaves;
  }

  std::vector<ReportCase> take() {
    cases_.push_back(base_);
    if (!subject_.flat) add_detail();
    add_exponentials();
    add("filter", [](ReportCase& c) { c.desc.alpha_filter = false; });
    for (int degree = subject_.sh_degree; degree-- > 0;)
      if (extent_ != ReportExtent::quick || degree == 0)
        add("sh", [&](ReportCase& c) { c.sh_degree = degree; });
    for (size_t i = 1; i < subject_.storages.size(); ++i)
      add("quality", [&](ReportCase& c) { c.storage = subject_.storages[i]; });
    if (subject_.baseline) add_baseline();
    if (extent_ != ReportExtent::quick) add_combinations();
    return std::move(cases_);
  }

 private:
  bool has(Exponential exponential) const {
    const auto& all = subject_.exponentials;
    return std::find(all.begin(), all.end(), exponential) != all.end();
  }

  template <class Change>
  void add(const char* group, const Change& change) {
    ReportCase found = base_;
    found.group = group;
    change(found);
    const auto same = [&](const ReportCase& other) { return other.name() == found.name(); };
    if (std::none_of(cases_.begin(), cases_.end(), same)) cases_.push_back(found);
  }

  void add_detail() {
    add("tau", [](ReportCase& c) { c.desc.lod = Lod::all_leaves; });
    for (const double tau : axes_.taus) add("tau", [&](ReportCase& c) { c.tau = tau; });
    if (extent_ == ReportExtent::quick) return;
    for (const Lod lod : {Lod::blocks, Lod::levels}) add_selection(lod);
    for (const Search search :
         {Search::exhaustive, Search::streaming, Search::temporal_visit, Search::temporal})
      add("search", [&](ReportCase& c) { c.desc.search = search; });
  }

  // At several τ, so that they can be compared at one error.
  void add_selection(Lod lod) {
    const auto select = [&](ReportCase& c) {
      c.desc.lod = lod;
      c.desc.search = without_sweep(c.desc.search);
    };
    add("select", select);
    for (const double tau : axes_.taus_of_baselines)
      add("select", [&](ReportCase& c) {
        select(c);
        c.tau = tau;
      });
  }

  void add_exponentials() {
    for (const Exponential exponential : {Exponential::exact, Exponential::ex2, Exponential::half2})
      if (has(exponential)) add("exp", [&](ReportCase& c) { c.desc.exponential = exponential; });
    for (const uint32_t size : axes_.lut_sizes)
      add("exp", [&](ReportCase& c) {
        c.desc.exponential = Exponential::lut;
        c.desc.lut_size = size;
      });
  }

  void add_baseline() {
    const auto as_3dgs = [](ReportCase& c) {
      c.desc.splatting = Splatting::baseline_3dgs;
      c.desc.exponential = Exponential::exact;
      c.desc.alpha_filter = false;
    };
    add("splat", as_3dgs);
    add("splat", [&](ReportCase& c) {
      as_3dgs(c);
      c.desc.lod = Lod::all_leaves;
    });
  }

  // Detail against colour, and against the exponential.
  void add_combinations() {
    for (const double tau : axes_.taus) {
      if (subject_.flat || tau == 0) continue;
      for (int degree = 0; degree < std::min(2, subject_.sh_degree); ++degree)
        add("combination", [&](ReportCase& c) {
          c.tau = tau;
          c.sh_degree = degree;
        });
      add("combination", [&](ReportCase& c) {
        c.tau = tau;
        c.desc.exponential = Exponential::lut;
      });
      if (has(Exponential::half2))
        add("combination", [&](ReportCase& c) {
          c.tau = tau;
          c.desc.exponential = Exponential::half2;
        });
    }
  }

  ReportExtent extent_;
  const ReportSubject& subject_;
  Extents axes_;
  ReportCase base_;
  std::vector<ReportCase> cases_;
};

}  // namespace

std::string ReportCase::name() const {
  std::string text;
  if (time_budget > 0)
    text = fmt::format("{:.3g} ms", time_budget);
  else
    text = draws_cut(desc.lod) ? fmt::format("tau {:g}", tau) : "all leaves";
  if (draws_cut(desc.lod) && desc.lod != Lod::cut)
    text += fmt::format(", {}", select_name(desc.lod));
  if (draws_cut(desc.lod) && desc.search != Search::temporal)
    text += fmt::format(", {}{}", search_name(desc.search),
                        desc.search == Search::temporal_visit ? " without slack" : "");
  if (desc.splatting == Splatting::baseline_3dgs) text += ", 3dgs";
  text += fmt::format(", {}", exponential_name(desc.exponential));
  if (desc.exponential == Exponential::lut) text += fmt::format(" {}", desc.lut_size);
  if (!desc.alpha_filter && desc.splatting == Splatting::ours) text += ", no filter";
  text += fmt::format(", sh {}", sh_degree);
  if (storage != Storage::flat) text += fmt::format(", {}", storage_name(storage));
  return text;
}

std::vector<ReportCase> report_cases(ReportExtent extent, const ReportSubject& subject) {
  return Cases(extent, subject).take();
}

std::vector<ReportCase> time_budget_cases(const ReportCase& base, double milliseconds) {
  std::vector<ReportCase> cases;
  for (const double share : {2.0 / 3, 1.0 / 3}) {
    cases.push_back(base);
    cases.back().group = "time budget";
    cases.back().time_budget = share * milliseconds;
  }
  return cases;
}

const char* storage_name(Storage storage) {
  switch (storage) {
    case Storage::lossless:
      return "lossless";
    case Storage::compact:
      return "compact";
    case Storage::flat:
      break;
  }
  return "flat";
}

}  // namespace voyager::tools
