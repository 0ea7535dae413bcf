#pragma once
// The Gaussians of a scene in memory: those of a compact file as it stores them
// (runtime/math/mean_code.h, shape_code.h, sh_code.h), the others in binary32. Both give the same
// bits.
#include "runtime/format/chunk.h"
#include "runtime/frame/scene.h"
#include "runtime/stages/interpolate.h"

namespace voyager {

// Whether a scene keeps what the file stores.
inline bool is_coded(const Scene& scene) {
  return scene.storage == Storage::compact;
}
size_t gaussian_count(const Scene& scene);
inline size_t sh_floats(const Scene& scene) {
  return 3 * static_cast<size_t>(scene.coefficients());
}
// Bytes of a Gaussian, node code and all.
uint64_t gaussian_bytes(Storage storage, int sh_degree);

// As stages read them. Valid until the scene changes.
CodeGroups code_groups(const Scene& scene);
PackedSh packed_sh(const Scene& scene);
GaussianArrays gaussian_arrays(const Scene& scene);

// Empties the arrays, then makes room; groups: for their scales.
void make_gaussian_room(size_t gaussians, size_t groups, Scene& scene);

// Of the i-th Gaussian of a compact chunk, to the bit.
ShapeCode shape_code(const Chunk& chunk, size_t i);
// Its SH row, with the scales that the shape lacks. degree: of chunk.sh.
void put_row(const Chunk& chunk, size_t i, int degree, uint8_t* row);
// The i-th Gaussian of a chunk, but for the scales of its group.
void set_gaussian(const Chunk& chunk, size_t i, size_t index, Scene& scene);
// One that draws nothing.
void set_nothing(size_t index, Scene& scene);

// coefficients() * 3 floats, [k][rgb].
void copy_sh(const Scene& scene, size_t index, float* sh);
// Leaves out the bands above.
void lower_sh_degree(int degree, Scene& scene);

// Made once; any thread.
const ShapeTables& shape_tables();

}  // namespace voyager
