#include "runtime/refine/refine.h"

#include <vector>

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/lod/stand_in.h"
#include "runtime/refine/extents.h"
#include "runtime/refine/gain.h"
#include "runtime/refine/measured.h"
#include "runtime/select/cut.h"

namespace voyager {
namespace {

// Of the cuts that are drawn, in pixels of a picture: 9, 33 and 121 in one of 1920 at a focal
// length of 1400. Finer ones keep nearly every leaf, and leave little to choose.
constexpr double kTaus[] = {2, 8, 30};
constexpr double kKeepMilliseconds = 20000;

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
  set_extents(measured, tree);
}

}  // namespace voyager
