#pragma once
// A .spz for what has one inside.
#include "runtime/math/half_turn.h"
#include "runtime/scene/export/writer.h"

namespace voyager::spz {

struct WriterOptions {
  int version = 4;
  int fractional_bits = 12;  // of positions
  HalfTurn to_inria;         // from the axes that its numbers are to have
};
// As write_spz().
std::unique_ptr<GaussianWriter> write(ByteSink& sink, uint64_t count, int sh_degree,
                                      const WriterOptions& options);

}  // namespace voyager::spz
