#pragma once
// An input read block by block, and compared to the bit.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "runtime/scene/import/block_reader.h"
#include "tests/fuzz/import_fuzz.h"

namespace voyager::fuzz {

inline void append_words(GaussianCloud& all, const GaussianCloud& block) {
  all.sh_degree = block.sh_degree;
  all.native = block.native;
  all.origin = block.origin;
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(all.position, block.position);
  add(all.log_scale, block.log_scale);
  add(all.rotation, block.rotation);
  add(all.opacity, block.opacity);
  add(all.sh, block.sh);
}

inline GaussianCloud read_blocks(BlockReader& reader, size_t most) {
  GaussianCloud all;
  all.sh_degree = reader.sh_degree();
  all.native = reader.native();
  for (;;) {
    const RawBlock block = reader.next(most);
    if (block.count > most) std::abort();
    if (block.count == 0) return all;
    const GaussianCloud cloud = reader.decode(block);
    if (cloud.size() != block.count || !is_complete(cloud)) std::abort();
    append_words(all, cloud);
  }
}

inline bool same_bits(const std::pmr::vector<float>& a, const std::pmr::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) {
    return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y);
  });
}

inline void expect_same(const std::optional<GaussianCloud>& a,
                        const std::optional<GaussianCloud>& b) {
  if (a.has_value() != b.has_value()) std::abort();
  if (!a) return;
  const bool same = a->sh_degree == b->sh_degree && a->native == b->native &&
                    (a->origin == b->origin || a->size() == 0) &&
                    same_bits(a->position, b->position) && same_bits(a->log_scale, b->log_scale) &&
                    same_bits(a->rotation, b->rotation) && same_bits(a->opacity, b->opacity) &&
                    same_bits(a->sh, b->sh);
  if (!same) std::abort();
}

}  // namespace voyager::fuzz
