#pragma once
// The nodes of one scene, or of a part of one, learn in the trainer's memory.
#include "runtime/optimize/optimize.h"
#include "runtime/optimize/training_views.h"

namespace voyager {

// Whether extents shrink at the end. Those of a part do not, since all of a scene's shrink by the
// same factor: its `after` is then of extents as they were measured.
enum class ShrinkExtents : uint8_t { no, yes };

// As optimize_nodes(), of a clustered tree with a merged node; all of it at once. Views look at
// some leaves only; shares of cuts are of these, and do not count the others.
OptimizeSummary learn_scene(BakedScene& baked, const LookedAt& looked_at, const OptimizeGoal& goal,
                            ShrinkExtents shrink, Backend& backend, const std::string& kept,
                            Workers& workers, const Progress& progress);

// by: above 0, at most 1.
void shrink_extents(double by, LodTree& tree);

inline constexpr uint32_t kMostPictures = 1'000'000'000;  // to learn from
// Pictures that extents are measured in, where so many are learned from.
uint32_t measured_with(uint32_t pictures);
// How many pictures to learn from in so much time, where each takes so long, and `others` are drawn
// to see what was gained. At least 1.
uint32_t pictures_in(double minutes, double milliseconds, uint32_t others);

}  // namespace voyager
