#include "runtime/format/check_claims.h"

#include <algorithm>
#include <future>
#include <random>

#include "runtime/base/error.h"
#include "runtime/math/sh.h"

namespace voyager {
namespace {

// What is believed of any file: a bake of a few ten thousand Gaussians.
constexpr uint64_t kBelieved = 16 << 20;  // bytes
// An eighth of the tries must be sound. A file of which half is sound is refused once in 800,000
// openings, one with a quarter once in 40. One with a 32nd passes once in 60, one with a 64th once
// in 700. The file's author cannot know which chunks will be tried.
constexpr size_t kSamples = 32, kSound = kSamples / 8;
// A thread, where there is one to be had.
constexpr std::launch kAnyLaunch = std::launch::async | std::launch::deferred;

// Bytes of a node whose Gaussian is there, beside its SH, of its record, and of a subtree: as
// stored, as a search reads it, and what views keep of it.
constexpr uint64_t kNodeBytes = 112, kRecordBytes = 40, kSubtreeBytes = 64;

uint64_t claim_of(const SceneFileInfo& info, uint64_t bytes, uint64_t nodes, uint64_t records,
                  uint64_t subtrees) {
  const uint64_t sh = 3 * sizeof(float) * static_cast<uint64_t>(sh_coefficients(info.sh_degree));
  return bytes + nodes * (kNodeBytes + sh) + records * kRecordBytes + subtrees * kSubtreeBytes;
}

std::string damage_of(const SceneFile& file, uint32_t chunk) {
  try {
    file.read_chunk(chunk);
    return {};
  } catch (const Error& error) {
    if (error.code() != ErrorCode::damaged_chunk) throw;
    return error.what();
  }
}

// The chunks at places in the sum of all claims, ascending.
std::vector<uint32_t> chunks_at(std::vector<uint64_t> places, const SceneFile& file) {
  std::sort(places.begin(), places.end());
  std::vector<uint32_t> chunks;
  uint64_t end = 0;
  for (uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk) {
    const ChunkEntry e = file.chunks().numbers(chunk);
    end += claim_of(file.info(), e.bytes, e.node_count, e.record_count, e.subtree_count);
    while (chunks.size() < places.size() && places[chunks.size()] < end) chunks.push_back(chunk);
  }
  return chunks;
}

}  // namespace

uint64_t claimed_bytes(const SceneFile& file) {
  const ChunkDirectory::Totals& all = file.chunks().totals();
  return claim_of(file.info(), all.bytes, all.nodes, all.records, file.info().subtree_count);
}

uint64_t process_seed() {
  static const uint64_t seed = [] {
    std::random_device device;
    return uint64_t{device()} << 32 | device();
  }();
  return seed;
}

void check_claims(const SceneFile& file, uint64_t seed) {
  const uint64_t claimed = claimed_bytes(file);
  if (claimed <= kBelieved) return;
  std::mt19937_64 random(seed);
  std::vector<uint64_t> places(kSamples);
  std::generate(places.begin(), places.end(), [&] { return random() % claimed; });
  // Where each try waits for an answer, as many at once as may do.
  const size_t at_once = file.source().reads_at_once() > 1 ? kSound : 1;
  const std::vector<uint32_t> chunks = chunks_at(std::move(places), file);
  size_t sound = 0;
  std::string first_damage;
  for (size_t first = 0; first < chunks.size(); first += at_once) {
    std::vector<std::future<std::string>> tries;
    for (size_t i = first; i < std::min(first + at_once, chunks.size()); ++i)
      tries.push_back(std::async(at_once == 1 ? std::launch::deferred : kAnyLaunch,
                                 [&, i] { return damage_of(file, chunks[i]); }));
    for (std::future<std::string>& one : tries) {
      const std::string damage = one.get();
      if (damage.empty() && ++sound == kSound) return;
      if (first_damage.empty()) first_damage = damage;
    }
  }
  throw Error(ErrorCode::refused_input, first_damage + "; of " + std::to_string(kSamples) +
                                            " chunks that were tried " + std::to_string(sound) +
                                            " are sound, expected at least " +
                                            std::to_string(kSound) + " of a file that claims " +
                                            std::to_string(file.info().node_count) + " nodes");
}

}  // namespace voyager
