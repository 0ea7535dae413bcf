#include "runtime/refine/refine.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/lod/stand_in.h"
#include "runtime/refine/gain.h"
#include "runtime/refine/measured.h"
#include "runtime/select/cut.h"

namespace voyager {
namespace {

// Of the cuts that are drawn, in pixels of a picture: 9, 33 and 121 in one of 1920 at a focal
// length of 1400. Finer ones keep nearly every leaf, and leave little to choose.
constexpr double kTaus[] = {2, 8, 30};
// How far what was measured is followed: as a power, as if so many pictures had shown what the
// extent says, and at most by a factor.
constexpr double kFollow = 0.5, kBelief = 24, kMostChange = 16;
constexpr double kKeepMilliseconds = 20000;

bool is_measured(const LodTree& tree, uint32_t node) {
  const NodeRecord& r = tree.records[node];
  return r.child_count != 0 && r.extent > 0 && std::isfinite(r.extent);
}

class Measuring {
 public:
  Measuring(const BakedScene& baked, Workers& workers)
      : tree_(baked.tree),
        native_(baked.leaves.native),
        arrays_(baked, workers),
        viewpoints_(baked),
        workers_(workers) {
    for (uint32_t n = 0; n < tree_.size(); ++n)
      if (tree_.is_leaf(n)) leaves_.push_back(n);
  }

  // The next view.
  void look(Measured& measured) {
    const Viewpoint view = viewpoints_(measured.views++);
    const ProjectParams params = picture_params(view, native_);
    const Vec3f eye = cut_centre(view.eye, {0, 0, 0});
    const Picture leaves(params, arrays_, leaves_, workers_);
    for (const double tau : kTaus) {
      search_.run(tree_, {}, {eye, target_size(tau, kPictureFocal)}, workers_);
      const Picture cut(params, arrays_, search_.cut(), workers_);
      for (const NodeGain& found : gains(params, arrays_, tree_, cut, leaves, workers_)) {
        const NodeRecord& r = tree_.records[found.node];
        const double metres =
            double{squared_distance(eye, r.box_min, r.box_max)} / (kPictureFocal * kPictureFocal);
        measured.gain[found.node] += found.squares * metres / (r.child_count - 1);
        ++measured.pictures[found.node];
      }
    }
  }

 private:
  const LodTree& tree_;
  const NativeScale native_;
  const NodeArrays arrays_;
  const Viewpoints viewpoints_;
  Workers& workers_;
  std::vector<uint32_t> leaves_;
  ExhaustiveSearch search_;
};

// What turns a squared gain into a squared extent: half of the nodes that gain anything are to
// grow.
double scale_of(const Measured& measured, const LodTree& tree) {
  std::vector<double> ratios;
  for (uint32_t n = 0; n < tree.size(); ++n) {
    if (!is_measured(tree, n) || !(measured.gain[n] > 0)) continue;
    const double extent = tree.records[n].extent;
    ratios.push_back(measured.pictures[n] * extent * extent / measured.gain[n]);
  }
  if (ratios.empty()) return 0;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

void set_measured(const Measured& measured, LodTree& tree) {
  const double scale = scale_of(measured, tree);
  for (uint32_t n = 0; n < tree.size(); ++n) {
    if (!is_measured(tree, n) || measured.pictures[n] == 0) continue;
    NodeRecord& r = tree.records[n];
    const double extent = r.extent, pictures = measured.pictures[n];
    const double found = std::max(measured.gain[n], 0.0) * scale + kBelief * extent * extent;
    const double square = found / (pictures + kBelief) / (extent * extent);
    const double change = std::pow(square, kFollow / 2);
    const auto changed =
        static_cast<float>(extent * std::clamp(change, 1 / kMostChange, kMostChange));
    if (std::isfinite(changed)) r.extent = changed;
  }
}

void never_grow_downwards(LodTree& tree) {
  for (auto n = static_cast<uint32_t>(tree.size()); n-- > 0;) {
    NodeRecord& r = tree.records[n];
    for (uint32_t i = 0; i < r.child_count; ++i)
      r.extent = std::max(r.extent, tree.records[tree.first_child[n] + i].extent);
  }
}

}  // namespace

void refine_extents(BakedScene& baked, uint32_t views, const std::string& kept, Workers& workers,
                    const Progress& progress) {
  if (baked.kind != TreeKind::clustered)
    throw Error(ErrorCode::unsupported,
                kept + ": found a tree of another kind, expected a clustered one");
  LodTree& tree = baked.tree;
  Measured measured = read_kept(tree, kept);
  if (tree.size() < 2) return;
  if (measured.views > views)
    throw Error(ErrorCode::refused_input, kept + ": found " + std::to_string(measured.views) +
                                              " views, expected at most " + std::to_string(views) +
                                              ": ask for as many, or remove it");
  if (measured.views < views) {
    Measuring measuring(baked, workers);
    Stopwatch since_kept;
    while (measured.views < views) {
      report(progress, "measuring", measured.views, views);
      measuring.look(measured);
      if (since_kept.milliseconds() < kKeepMilliseconds && measured.views < views) continue;
      keep(measured, tree, kept);
      since_kept = {};
    }
    report(progress, "measuring", views, views);
  }
  set_measured(measured, tree);
  never_grow_downwards(tree);
}

}  // namespace voyager
