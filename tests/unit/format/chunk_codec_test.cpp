#include "runtime/format/chunk_codec.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "runtime/base/checksum.h"
#include "runtime/format/quantise.h"
#include "runtime/format/reader.h"
#include "runtime/scene/import/importer.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

namespace voyager::chunk_codec_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr uint32_t kLevels[] = {0, 1, 4}, kTiers[] = {0, 1};

// A root with three leaves.
Chunk family(size_t coefficients) {
  Chunk chunk;
  chunk.subtrees.push_back({0, 1, 0, 1, 3, 0, Repeats::nothing});
  for (uint32_t i = 0; i < 4; ++i) {
    chunk.record.push_back(i);
    const float x = static_cast<float>(i);
    chunk.records.push_back(
        {{x - 1, -1, -1}, i == 0 ? 9.0f : 0.0f, {x + 1, 1, 1}, i == 0 ? 3u : 0u});
    chunk.words.push_back({{x, 0, 0}, {-1, -2, -3}, {1, 0, 0, 0}, 0.5f});
    chunk.node_code.push_back(i == 0 ? 0 : 5);
    chunk.source_index.push_back(i == 0 ? kNoNode : i - 1);
  }
  chunk.sh.assign(4 * coefficients * 3, 0.25f);
  return chunk;
}

ChunkContext context_of(Quality quality, int degree = 1) {
  ChunkContext context;
  context.quality = quality;
  context.sh_degree = degree;
  context.leaf_count = 3;
  context.tiers = {3, kLevels, kTiers};
  context.largest_sh = 0.25f;
  return context;
}

// Of the family in a file of its own.
ChunkEntry entry_of(const EncodedChunk& encoded) {
  ChunkEntry entry{};
  entry.offset = 4096;
  entry.checksum = encoded.checksum;
  entry.subtree_count = 1;
  entry.node_count = entry.record_count = 4;
  entry.place = SubtreeCursor({3, kLevels, kTiers}).place();
  return entry;
}

constexpr SubtreePlace kEnd{{4, 4, 4, 4}, 0, 0};

Chunk round_trip(const Chunk& chunk, const ChunkContext& context) {
  const EncodedChunk encoded = encode_chunk(chunk, context);
  const std::string file = "test.voy";
  const ChunkEntry entry = entry_of(encoded);
  return decode_chunk(encoded.bytes, {file, 0, entry, kEnd}, context);
}

int stored_degree(const EncodedChunk& encoded) {
  ChunkHeader header;
  std::memcpy(&header, encoded.bytes.data(), sizeof header);
  return header.sh_degree;
}

TEST(ChunkCodec, BandsThatAreZeroThroughoutAreNotStoredAndComeBack) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const ChunkContext context = context_of(quality, 3);
    Chunk chunk = family(16);
    for (size_t i = 0; i < chunk.sh.size(); ++i)
      if (i % 48 >= 12) chunk.sh[i] = 0;
    const EncodedChunk encoded = encode_chunk(chunk, context);
    EXPECT_EQ(stored_degree(encoded), 1);
    EXPECT_EQ(encoded.largest_sh, 0.25f);
    EXPECT_EQ(std::memcmp(encoded.bytes.data(),
                          encode_chunk(family(4), context_of(quality, 1)).bytes.data(),
                          encoded.bytes.size()),
              0);
    EXPECT_TRUE(round_trip(chunk, context).sh == chunk.sh);
    chunk.sh[47] = -0.0f;
    EXPECT_EQ(stored_degree(encode_chunk(chunk, context)), 3);
    EXPECT_EQ(std::signbit(round_trip(chunk, context).sh[47]), quality == Quality::lossless);
  }
}

// Of versions 4 and 5: without counts of roots, a byte less for each subtree.
TEST(ChunkCodec, OlderFilesHaveOneRootInEachSubtree) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    ChunkContext context = context_of(quality);
    context.version = 5;
    const Chunk chunk = family(4), back = round_trip(chunk, context);
    ASSERT_EQ(back.subtrees.size(), 1u);
    EXPECT_TRUE(back.subtrees[0] == chunk.subtrees[0]);
    EXPECT_EQ(back.node, round_trip(chunk, context_of(quality)).node);
  }
}

TEST(ChunkCodec, MoreBandsThanTheFileHasAreRefused) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const EncodedChunk encoded = encode_chunk(family(9), context_of(quality, 2));
    const std::string file = "test.voy";
    const ChunkEntry entry = entry_of(encoded);
    EXPECT_EQ(test::error_code([&] {
                decode_chunk(encoded.bytes, {file, 0, entry, kEnd}, context_of(quality, 1));
              }),
              ErrorCode::damaged_chunk);
  }
}

// Checksums are right in each case: the values themselves are refused.
TEST(ChunkCodec, ImpossibleValuesAreRefusedUnderARightChecksum) {
  const std::vector<std::function<void(Chunk&)>> faults = {
      [](Chunk& c) { c.records[1].box_min.x = kNan; },
      [](Chunk& c) { c.records[1].box_max.y = kInfinity; },
      [](Chunk& c) { c.records[2].box_min.z = 2; },
      [](Chunk& c) { c.records[0].extent = -1; },
      [](Chunk& c) { c.records[0].extent = kNan; },
      [](Chunk& c) { c.subtrees[0].root_count = 0; },
      [](Chunk& c) { c.subtrees[0].root_count = 2; },
      [](Chunk& c) { c.subtrees[0].root_count = 255; },
      [](Chunk& c) { c.subtrees[0].child_count = 2; },
      [](Chunk& c) { c.subtrees[0].child_count = 255; },
      [](Chunk& c) { c.subtrees[0].grandchild_count = 1; },
      [](Chunk& c) { c.records[1].child_count = 1; },
      [](Chunk& c) { c.records[0].child_count = 4; },
      [](Chunk& c) { c.records[0].child_count = 0; },
      [](Chunk& c) { c.records[0].child_count = 0xffffffff; },
      [](Chunk& c) { c.source_index[1] = 3; },
      [](Chunk& c) { c.source_index[0] = 0; },
      [](Chunk& c) { c.node_code[1] = 24; },
  };
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    ASSERT_NO_THROW(round_trip(family(4), context_of(quality)));
    for (size_t i = 0; i < faults.size(); ++i) {
      Chunk chunk = family(4);
      faults[i](chunk);
      EXPECT_EQ(test::error_code([&] { round_trip(chunk, context_of(quality)); }),
                ErrorCode::damaged_chunk)
          << i;
    }
  }
}

TEST(ChunkCodec, EveryNodeCodeComesBack) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    ChunkContext context = context_of(quality);
    context.footprint_levels = kFootprintLevels;
    Chunk chunk = family(4);
    for (int level = 0; level < kFootprintLevels; ++level)
      for (int axis = 0; axis < kAxisCodes; ++axis) {
        chunk.node_code = {node_code(0, level), node_code(axis, level), node_code(23 - axis, 0),
                           node_code(axis, kFootprintLevels - 1)};
        ASSERT_EQ(round_trip(chunk, context).node_code, chunk.node_code);
      }
  }
}

TEST(ChunkCodec, ALevelBeyondTheHeadersIsRefusedWithWhatWasExpected) {
  for (const Quality quality : {Quality::lossless, Quality::compact})
    for (int levels = 1; levels < kFootprintLevels; ++levels) {
      ChunkContext context = context_of(quality);
      context.footprint_levels = levels;
      Chunk chunk = family(4);
      chunk.node_code[2] = node_code(23, levels - 1);
      EXPECT_NO_THROW(round_trip(chunk, context));
      chunk.node_code[2] = node_code(0, levels);
      try {
        round_trip(chunk, context);
        ADD_FAILURE() << levels << " levels";
      } catch (const Error& error) {
        const std::string code = std::to_string(24 * levels);
        EXPECT_NE(std::string(error.what())
                      .find("node 2 with node code " + code + ", expected less than " + code),
                  std::string::npos)
            << error.what();
      }
    }
}

// Bytes of a sound chunk that are changed, under a checksum that is right.
ErrorCode refusal_of(const EncodedChunk& encoded, const std::vector<std::byte>& bytes,
                     const ChunkContext& context) {
  const std::string file = "test.voy";
  ChunkEntry entry = entry_of(encoded);
  entry.checksum = checksum(bytes);
  return test::error_code([&] { decode_chunk(bytes, {file, 0, entry, kEnd}, context); });
}

TEST(ChunkCodec, WhatNobodyWouldReadIsRefused) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const EncodedChunk encoded = encode_chunk(family(4), context_of(quality));
    std::vector<std::byte> bytes = encoded.bytes;
    bytes.back() = std::byte{1};
    EXPECT_EQ(refusal_of(encoded, bytes, context_of(quality)), ErrorCode::damaged_chunk);
  }
  // A second, empty frame behind the first.
  const ChunkContext context = context_of(Quality::compact);
  const EncodedChunk encoded = encode_chunk(family(4), context);
  ChunkHeader header;
  std::memcpy(&header, encoded.bytes.data(), sizeof header);
  const std::byte skippable[] = {std::byte{0x50}, std::byte{0x2a}, std::byte{0x4d}, std::byte{0x18},
                                 std::byte{0},    std::byte{0},    std::byte{0},    std::byte{0}};
  std::vector<std::byte> bytes(
      encoded.bytes.begin(),
      encoded.bytes.begin() + static_cast<std::ptrdiff_t>(sizeof header + header.payload_bytes));
  bytes.insert(bytes.end(), std::begin(skippable), std::end(skippable));
  header.payload_bytes += sizeof skippable;
  std::memcpy(bytes.data(), &header, sizeof header);
  bytes.resize(align_up(bytes.size(), chunk_align(Quality::compact)));
  EXPECT_EQ(refusal_of(encoded, bytes, context), ErrorCode::damaged_chunk);
}

TEST(ChunkCodec, WordsThatAreNotFiniteAreRefused) {
  const std::vector<std::function<void(Chunk&)>> faults = {
      [](Chunk& c) { c.words[1].mean.x = kNan; },
      [](Chunk& c) { c.words[1].mean.x = 2e18f; },
      [](Chunk& c) { c.words[1].log_scale.y = kInfinity; },
      [](Chunk& c) { c.words[1].log_scale.y = 80; },
      [](Chunk& c) { c.words[1].rotation.z = kNan; },
      [](Chunk& c) { c.words[1].opacity = kInfinity; },
      [](Chunk& c) { c.words[0].opacity = -1; },
      [](Chunk& c) { c.sh[7] = kNan; },
  };
  for (size_t i = 0; i < faults.size(); ++i) {
    Chunk chunk = family(4);
    faults[i](chunk);
    EXPECT_EQ(test::error_code([&] { round_trip(chunk, context_of(Quality::lossless)); }),
              ErrorCode::damaged_chunk)
        << i;
  }
}

TEST(ChunkCodec, AChunkOutOfPlaceIsRefused) {
  const ChunkContext context = context_of(Quality::compact);
  const EncodedChunk encoded = encode_chunk(family(4), context);
  const std::string file = "test.voy";
  const auto expect_damaged = [&](const ChunkEntry& entry, const SubtreePlace& next,
                                  const ChunkContext& where) {
    EXPECT_EQ(test::error_code([&] {
                decode_chunk(encoded.bytes, {file, 0, entry, next}, where);
              }),
              ErrorCode::damaged_chunk);
  };
  const ChunkEntry sound = entry_of(encoded);
  EXPECT_NO_THROW(decode_chunk(encoded.bytes, {file, 0, sound, kEnd}, context));
  for (const auto field : {&ChunkEntry::first_subtree, &ChunkEntry::subtree_count,
                           &ChunkEntry::node_count, &ChunkEntry::record_count}) {
    ChunkEntry entry = sound;
    ++(entry.*field);
    expect_damaged(entry, kEnd, context);
  }
  ChunkEntry elsewhere = sound;
  elsewhere.place.next[1] = 2;
  expect_damaged(elsewhere, kEnd, context);
  expect_damaged(sound, {{1, 3, 4, 4}, 2, 0}, context);
  expect_damaged(sound, kEnd, context_of(Quality::lossless));
  expect_damaged(sound, kEnd, context_of(Quality::compact, 0));
}

// Scenes keep steps in as many bits as their range takes, so that one beyond it would spoil others.
TEST(ChunkCodec, AStepOfShBeyondItsRangeIsRefused) {
  ChunkContext context = context_of(Quality::compact, 3);
  context.largest_sh = 2;
  const EncodedChunk sound = encode_chunk(family(16), context);
  ChunkHeader header;
  std::memcpy(&header, sound.bytes.data(), sizeof header);
  const std::byte* const frame = sound.bytes.data() + sizeof header;
  constexpr size_t kNodes = 4;
  std::vector<std::byte> raw(32 * kNodes + 3 + kNodes * (34 + 3 * 15));
  ASSERT_EQ(ZSTD_decompress(raw.data(), raw.size(), frame, header.payload_bytes), raw.size());
  // Bands 2 and 3 of a family, all of which have one step.
  constexpr size_t kSteps = 36 * kNodes;
  const auto begin = std::search_n(raw.begin(), raw.end(), kSteps, std::byte{31});
  ASSERT_NE(begin, raw.end());
  for (const int step : {31, -31, 32, -32, 100, -128})
    for (const std::ptrdiff_t at : {std::ptrdiff_t{0}, std::ptrdiff_t{kSteps - 1}}) {
      std::vector<std::byte> planes = raw;
      planes[static_cast<size_t>(begin - raw.begin() + at)] = static_cast<std::byte>(step);
      std::vector<std::byte> bytes(sizeof header + ZSTD_compressBound(planes.size()));
      header.payload_bytes = static_cast<uint32_t>(ZSTD_compress(bytes.data() + sizeof header,
                                                                 bytes.size() - sizeof header,
                                                                 planes.data(), planes.size(), 1));
      std::memcpy(bytes.data(), &header, sizeof header);
      bytes.resize(sizeof header + header.payload_bytes);
      bytes.resize((bytes.size() + 63) / 64 * 64);
      const std::string file = "test.voy";
      ChunkEntry entry = entry_of(sound);
      entry.checksum = checksum(bytes);
      const auto decode = [&] { decode_chunk(bytes, {file, 0, entry, kEnd}, context); };
      if (std::abs(step) <= 31)
        EXPECT_NO_THROW(decode()) << step;
      else
        EXPECT_EQ(test::error_code(decode), ErrorCode::damaged_chunk) << step;
    }
}

// What a device relies on without reading the whole file.
TEST(ChunkCodec, WhatTheHeaderRulesOutIsRefused) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    for (const size_t k : {size_t{0}, size_t{16}, size_t{47}}) {  // constants and band 1
      Chunk chunk = family(4);
      chunk.sh[k] =
          -std::nextafter(0.25f, 1.0f) - (k % 12 < 3 ? 0.001f : 0.0f);  // a step of binary16
      EXPECT_EQ(test::error_code([&] { round_trip(chunk, context_of(quality)); }),
                ErrorCode::damaged_chunk)
          << k;
    }
    Chunk chunk = family(4);
    chunk.records[2].extent = 0.5f;
    ChunkContext context = context_of(quality);
    EXPECT_EQ(test::error_code([&] { round_trip(chunk, context); }), ErrorCode::damaged_chunk);
    context.leaves_have_extent = true;
    EXPECT_EQ(round_trip(chunk, context).records[2].extent, 0.5f);
  }
}

// A search takes it for infinitely large (METHOD §3).
TEST(ChunkCodec, AnInfiniteExtentIsKept) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    Chunk chunk = family(4);
    chunk.records[0].extent = kInfinity;
    EXPECT_EQ(round_trip(chunk, context_of(quality)).records[0].extent, kInfinity);
  }
}

double angle(const Quatf& p, const Quatf& q) {
  const Quatd a = normalise(Quatd{p.w, p.x, p.y, p.z}), b = normalise(Quatd{q.w, q.x, q.y, q.z});
  const double s = (a.w * b.w + a.x * b.x) + (a.y * b.y + a.z * b.z) < 0 ? -1 : 1;
  const double chord = std::hypot(std::hypot(a.w - s * b.w, a.x - s * b.x),
                                  std::hypot(a.y - s * b.y, a.z - s * b.z));
  return 4 * std::asin(std::min(1.0, chord / 2));
}

double half_error(float value) {
  return std::max(std::fabs(double{value}) * 0x1p-11, 0x1p-25);
}

// Every error that docs/voy-format.md states, against the exact chunk.
void expect_within_bounds(const Chunk& exact, const Chunk& compact, int degree, double file_error) {
  double step[3], largest[3] = {0, 0, 0}, whole = 0, away = 0;
  const size_t floats = static_cast<size_t>(sh_coefficients(degree)) * 3;
  for (int axis = 0; axis < 3; ++axis) {
    double farthest = 0, reach = 0, least = kInfinity, most = -kInfinity;
    for (size_t i = 0; i < exact.words.size(); ++i) {
      const NodeRecord& r = exact.record_of(i);
      const double mean = exact.words[i].mean[axis];
      farthest =
          std::max(farthest, std::fabs(mean - 0.5 * (double{r.box_min[axis]} + r.box_max[axis])));
      reach = std::max(reach, std::fabs(mean));
      least = std::min(least, mean), most = std::max(most, mean);
    }
    step[axis] = std::max(farthest / kPositionSteps, reach * 0x1p-24);
    whole = std::max(whole, most - least), away = std::max(away, reach);
  }
  const double grid_step = compact.mean_grid.step;
  EXPECT_LE(grid_step, 2.01 * std::max(whole / kMostMeanSteps, away * 0x1p-24));
  const auto band = [](size_t k) { return k < 12 ? 0 : k < 27 ? 1 : 2; };
  for (size_t k = 0; k < exact.sh.size(); ++k)
    if (k % floats >= 3)
      largest[band(k % floats)] =
          std::max<double>(largest[band(k % floats)], std::fabs(exact.sh[k]));
  for (size_t i = 0; i < exact.words.size(); ++i) {
    const GaussianWords &a = exact.words[i], &b = compact.words[i];
    const bool leaf = exact.is_leaf(i);
    double squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double error = double{a.mean[axis]} - b.mean[axis];
      squares += error * error;
      ASSERT_LE(std::fabs(error),
                step[axis] / 2 + std::fabs(a.mean[axis]) * 0x1p-24 + grid_step / 2);
      ASSERT_LE(std::fabs(double{std::max(a.log_scale[axis], -21.0f)} - b.log_scale[axis]),
                1.0 / 1024);
    }
    ASSERT_EQ(b.mean, restored_mean(compact.mean_code[i], compact.mean_grid));
    ASSERT_LE(std::sqrt(squares), file_error);
    ASSERT_LE(angle(a.rotation, b.rotation), 1.6e-4);
    if (leaf)
      ASSERT_LE(std::fabs(double{sigmoid(a.opacity)} - sigmoid(b.opacity)), 0.5 / 65535 + 0x1p-23);
    else
      ASSERT_LE(std::fabs(std::min(a.opacity, kMaxHalf) - b.opacity), half_error(a.opacity));
    for (size_t k = 0; k < floats; ++k) {
      const size_t at = i * floats + k;
      const double bound =
          k < 3 ? half_error(exact.sh[at])
                : largest[band(k)] / (2 * kShSteps[static_cast<size_t>(band(k))]) + 1e-7;
      ASSERT_LE(std::fabs(double{exact.sh[at]} - compact.sh[at]), bound) << k;
    }
  }
}

struct Sizes {
  double lossless, compact;
};

Sizes check_compact(const GaussianCloud& cloud) {
  const BakedScene baked = test::bake(cloud);
  const test::Bytes lossless = test::scene_bytes(baked, Quality::lossless),
                    compact = test::scene_bytes(baked, Quality::compact);
  const SceneFile exact(test::source_of(lossless)), small(test::source_of(compact));
  EXPECT_EQ(exact.info().position_error, 0);
  for (uint32_t index = 0; index < exact.chunks().size(); ++index) {
    const Chunk whole = exact.read_chunk(index), restored = small.read_chunk(index);
    expect_within_bounds(whole, restored, cloud.sh_degree, small.info().position_error);
    EXPECT_EQ(std::memcmp(whole.records.data(), restored.records.data(),
                          whole.records.size() * sizeof(NodeRecord)),
              0);
  }
  return {static_cast<double>(lossless.size()), static_cast<double>(compact.size())};
}

// What was baked before trees said where blending starts.
std::shared_ptr<const ByteSource> kept_file(const std::string& name) {
  return open_file_source(VOYAGER_SOURCE_DIR "/tests/fuzz/corpus/voy/" + name + ".voy");
}

// So that nothing changes where a cut goes from one to the other.
TEST(ChunkCodec, ADoubleIsRestoredAsItsChild) {
  const SceneFile file(kept_file("version4"));
  size_t doubles = 0;
  for (uint32_t index = 0; index < file.chunks().size(); ++index) {
    const Chunk chunk = file.read_chunk(index);
    for (size_t i = 0; i < chunk.node.size(); ++i) {
      const auto child = std::find(chunk.node.begin(), chunk.node.end(), chunk.first_child[i]);
      if (chunk.record_of(i).child_count != 1 || child == chunk.node.end()) continue;
      const auto k = static_cast<size_t>(child - chunk.node.begin());
      EXPECT_EQ(std::memcmp(&chunk.words[i], &chunk.words[k], sizeof chunk.words[i]), 0);
      const size_t floats = 3 * static_cast<size_t>(sh_coefficients(file.info().sh_degree));
      EXPECT_EQ(std::memcmp(&chunk.sh[floats * i], &chunk.sh[floats * k], floats * sizeof(float)),
                0);
      ++doubles;
    }
  }
  EXPECT_GT(doubles, 50u);
}

TEST(ChunkCodec, CompactKeepsItsBoundsAndItsSizeOnRandomGaussians) {
  const Sizes sizes = check_compact(test::specks(20000, 11, 3));
  EXPECT_LE(sizes.compact, 0.3 * sizes.lossless);
  for (const int degree : {0, 1, 2}) check_compact(test::random_cloud(3000, 12, degree));
}

TEST(ChunkCodec, CompactKeepsItsBoundsAndItsSizeOnARealBlock) {
  VOYAGER_NEEDS_SCENES(folder);
  const auto source = open_file_source(folder + "/formats/block.ply");
  const Sizes sizes = check_compact(import_gaussians(*read_source(*source)));
  EXPECT_LE(sizes.compact, 0.24 * sizes.lossless);
}

// Files of before can be read: what these hold was written once, and is what docs/voy-format.md
// says.
TEST(ChunkCodec, KeptFilesHoldWhatTheyHeld) {
  const std::pair<const char*, uint64_t> kept[] = {
      {"compact_sh3", 12890454702011229743u}, {"compact_hierarchicalgs", 119905554922511597u},
      {"chain", 17859004615487115216u},       {"version5", 10851759957604741355u},
      {"version6", 173412970277820190u},      {"version6_lossless", 12740476357596010903u}};
  for (const auto& [name, sum] : kept) {
    const SceneFile file(kept_file(name));
    std::vector<std::byte> held;
    const auto add = [&](const auto& values) {
      const auto bytes = std::as_bytes(std::span(values));
      held.insert(held.end(), bytes.begin(), bytes.end());
    };
    for (uint32_t index = 0; index < file.chunks().size(); ++index) {
      const Chunk chunk = file.read_chunk(index);
      add(chunk.records), add(chunk.node), add(chunk.sh), add(chunk.node_code);
      add(chunk.source_index);
      for (const GaussianWords& words : chunk.words)
        add(std::array{words.mean.x, words.mean.y, words.mean.z, words.log_scale.x});
    }
    EXPECT_EQ(checksum(held), sum) << name;
  }
}

}  // namespace
}  // namespace voyager::chunk_codec_test
