// What a file claims is held against what it has before it costs anything.
#include "runtime/format/check_claims.h"
#include "tests/support/hostile_files.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::claims_test {
namespace {

using test::Bytes;
using test::ClaimedFile;

// Zeros behind what is there. Remembers what it was asked for.
class Claiming final : public ByteSource {
 public:
  explicit Claiming(ClaimedFile file) : file_(std::move(file)) {}
  const std::string& name() const override { return name_; }
  uint64_t size() const override { return file_.length; }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    check_range(*this, offset, into.size());
    largest = std::max(largest, into.size());
    all += into.size();
    offsets.push_back(offset);
    for (size_t i = 0; i < into.size(); ++i)
      into[i] = offset + i < file_.head.size() ? file_.head[offset + i] : std::byte{0};
  }
  mutable size_t largest = 0, all = 0;
  mutable std::vector<uint64_t> offsets;

 private:
  std::string name_ = "claims.voy";
  ClaimedFile file_;
};

std::string refusal_of(const std::shared_ptr<const ByteSource>& source) {
  try {
    const SceneFile file(source);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
    return error.what();
  }
  return {};
}

TEST(Claims, OfASectionNoMoreIsReadThanIsRight) {
  for (const SectionKind which : {SectionKind::tiers, SectionKind::chunk_directory}) {
    const auto source = std::make_shared<Claiming>(test::claimed_section(which, uint64_t{2} << 30));
    ASSERT_GT(source->size(), uint64_t{1} << 30);
    EXPECT_NE(refusal_of(source), "");
    EXPECT_LE(source->all, size_t{3} << 20);
  }
}

TEST(Claims, ChunksThatHoldNothingAreTriedAndNotBelieved) {
  for (const Quality quality : {Quality::compact, Quality::lossless}) {
    const auto source = std::make_shared<Claiming>(test::claimed_chunks(quality, 100));
    const std::string refusal = refusal_of(source);
    EXPECT_NE(refusal.find("of 32 chunks that were tried 0 are sound"), std::string::npos)
        << refusal;
    EXPECT_LE(source->largest, size_t{4} << 20);
  }
}

TEST(Claims, ACompactChunkIsNoLongerThanItsPlanes) {
  const BakedScene baked = test::baked_of(test::random_tree(test::TreeShape::eight_way, 300, 2));
  Bytes bytes = test::scene_bytes(baked, Quality::compact, 1);
  const SceneFile file(test::source_of(bytes));
  ChunkEntry last = file.chunks().back();
  bytes.resize(bytes.size() + (1 << 16));
  last.bytes += 1 << 16;
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  std::memcpy(
      bytes.data() + header.directory.offset + (file.chunks().size() - 1) * sizeof(ChunkEntry),
      &last, sizeof last);
  EXPECT_NE(refusal_of(test::source_of(test::sealed(bytes))).find("chunk length"),
            std::string::npos);
}

// Of a large file, half of which is lost, what is left is not.
TEST(Claims, ADamagedFileIsReadAsLongAsMuchOfItIsThere) {
  const BakedScene baked =
      test::baked_of(test::random_tree(test::TreeShape::eight_way, 150'000, 2));
  const Bytes sound = test::scene_bytes(baked, Quality::lossless);
  EXPECT_EQ(refusal_of(test::source_of(sound)), "");
  const SceneFile file(test::source_of(sound));
  Bytes half = sound, none = sound;
  for (size_t chunk = 0; chunk < file.chunks().size(); ++chunk) {
    const uint64_t at = file.chunks()[chunk].offset;
    none[at] ^= std::byte{1};
    if (chunk % 2 == 0) half[at] ^= std::byte{1};
  }
  EXPECT_EQ(refusal_of(test::source_of(half)), "");
  const SceneFile damaged(test::source_of(half));
  for (uint64_t seed = 0; seed < 20; ++seed) EXPECT_NO_THROW(check_claims(damaged, seed)) << seed;
  EXPECT_NE(refusal_of(test::source_of(none)).find("0 are sound"), std::string::npos);
}

// Whoever makes a file knows all of its bytes: none of them may say which chunks will be tried.
TEST(Claims, WhichChunksAreTriedDoesNotFollowFromTheFile) {
  const Bytes bytes = test::scene_bytes(
      test::baked_of(test::random_tree(test::TreeShape::eight_way, 150'000, 2)), Quality::lossless);
  const auto source = std::make_shared<Claiming>(ClaimedFile{bytes, bytes.size()});
  const SceneFile file(source);
  std::vector<uint64_t> at_open;
  for (const uint64_t offset : source->offsets)
    if (offset >= file.chunks().front().offset) at_open.push_back(offset);
  const auto tried = [&](uint64_t seed) {
    source->offsets.clear();
    check_claims(file, seed);
    return source->offsets;
  };
  EXPECT_EQ(tried(process_seed()), at_open);
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  EXPECT_NE(tried(header.checksum), at_open);
  EXPECT_NE(tried(1), tried(2));
}

}  // namespace
}  // namespace voyager::claims_test
