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

// 0 where the input is refused.
template <class Open>
uint64_t announced(const Open& open) {
  uint64_t count = 0;
  unless_refused([&] {
    count = open()->count();
    return GaussianCloud();
  });
  return count;
}

// What `open` gives: in blocks of any size the same words to the bit, or a refusal; and as a whole
// a sound cloud. More than some Gaussians take long, and say nothing new.
template <class Open>
void expect_same_in_blocks_and_whole(const Open& open) {
  constexpr uint64_t kMost = 1000;
  if (announced(open) > kMost) return;
  const auto whole = unless_refused([&] { return read_blocks(*open(), 5000); });
  expect_same(whole, unless_refused([&] { return read_blocks(*open(), 3); }));
  const auto sound = unless_refused([&] { return import_gaussians(*open()); });
  if (sound.has_value() != whole.has_value() || (sound && !is_complete(*sound))) std::abort();
}

}  // namespace voyager::fuzz
