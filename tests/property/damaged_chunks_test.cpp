// Every chunk of a file damaged, alone and together with each other one: bytes that fell over, and
// records that are wrong under checksums that are right. Streamed or whole, the scene is refused or
// draws a cut without what was damaged.
#include "runtime/frame/open_streamed.h"
#include "runtime/frame/whole_tree.h"
#include "tests/support/is_cut.h"
#include "tests/support/random_trees.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"

namespace voyager::damaged_chunks_test {
namespace {

using test::Bytes;
using test::Frame;

enum class Damage {
  flipped,  // the checksum says so
  grown,    // the first record is larger than its parent's, or than the node's elsewhere
};
constexpr Damage kDamages[] = {Damage::flipped, Damage::grown};

enum class How {
  whole,
  streamed,
  streamed_at_once
};  // all that there is room for, when it is opened

struct Wrong {
  uint32_t chunk;
  Damage damage;
};

// Of a file whose nodes are plain arrays.
class Damaged {
 public:
  explicit Damaged(test::TreeShape shape)
      : bytes_(test::scene_bytes(test::baked_of(test::random_tree(shape, 320, 5)),
                                 Quality::lossless, 1, kMinChunkBytes)),
        file_(test::source_of(bytes_)),
        whole_(load_scene(test::source_of(bytes_), memory(), workers_)) {}

  uint32_t chunks() const { return file_.info().chunk_count; }

  // Sound or not, the scene is drawn, or refused for what is wrong.
  void expect_sound(std::initializer_list<Wrong> wrong) {
    Bytes bytes = bytes_;
    for (const Wrong& w : wrong)
      if (w.damage == Damage::grown) grow(w.chunk, bytes);
    bytes = test::sealed(std::move(bytes));
    for (const Wrong& w : wrong)
      if (w.damage == Damage::flipped) bytes[at(w.chunk) + sizeof(ChunkHeader)] ^= std::byte{1};
    for (const How how : {How::whole, How::streamed, How::streamed_at_once}) {
      try {
        expect_cut(draw(test::source_of(bytes), how), wrong);
      } catch (const Error& error) {
        EXPECT_TRUE(error.code() == ErrorCode::damaged_chunk ||
                    error.code() == ErrorCode::refused_input)
            << error.what();
      }
    }
  }

 private:
  static std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }
  size_t at(uint32_t chunk) const { return file_.chunks()[chunk].offset; }

  void grow(uint32_t chunk, Bytes& bytes) const {
    NodeRecord record;
    std::byte* place = bytes.data() + at(chunk) + sizeof(ChunkHeader);
    std::memcpy(&record, place, sizeof record);
    record.box_max.x += 1000;
    std::memcpy(place, &record, sizeof record);
  }

  Frame draw(const std::shared_ptr<const ByteSource>& source, How how) {
    StreamingDesc desc;
    desc.readers = 0;
    desc.first_bytes = how == How::streamed ? 0 : source->size();
    desc.clock = [this] { return time_ += 0.01; };
    View view(how == How::whole ? load_scene(source, memory(), workers_)
                                : open_streamed(source, desc, *backend_, memory(), workers_),
              *backend_, {}, memory(), workers_);
    FrameInput input = test::frame_input(test::look({0, -2, -200}, {0, 0, 0}, 24, 16), 0.01);
    input.wait_resident = input.stand_in = true;
    return test::render(view, input);
  }

  void expect_cut(const Frame& frame, std::initializer_list<Wrong> wrong) {
    EXPECT_TRUE(test::is_cut(*whole_tree(*whole_), frame.cut));
    test::expect_no_nan(frame);
    for (const Wrong& w : wrong) {
      if (w.damage == Damage::grown)
        continue;  // of the root alone, and of nothing else, it is sound
      const std::vector<NodeRange> lost = file_.nodes_of(w.chunk);
      for (const uint32_t node : frame.cut) EXPECT_FALSE(test::holds(lost, node)) << node;
    }
  }

  Workers workers_{1};
  const std::unique_ptr<Backend> backend_ = create_cpu_backend();
  const Bytes bytes_;
  const SceneFile file_;
  const std::shared_ptr<const Scene> whole_;
  double time_ = 0;
};

class DamagedChunks : public ::testing::TestWithParam<test::TreeShape> {};
INSTANTIATE_TEST_SUITE_P(Trees, DamagedChunks,
                         ::testing::Values(test::TreeShape::star, test::TreeShape::star_of_stars,
                                           test::TreeShape::recursive, test::TreeShape::eight_way));

TEST_P(DamagedChunks, AloneAndInPairs) {
  Damaged scene(GetParam());
  ASSERT_GT(scene.chunks(), 5u);
  for (uint32_t a = 0; a < scene.chunks(); ++a)
    for (const Damage damage : kDamages) {
      SCOPED_TRACE("chunk " + std::to_string(a) +
                   (damage == Damage::grown ? " grown" : " flipped"));
      scene.expect_sound({{a, damage}});
      for (uint32_t b = a + 1; b < scene.chunks(); ++b)
        for (const Damage other : kDamages) {
          SCOPED_TRACE("and " + std::to_string(b));
          scene.expect_sound({{a, damage}, {b, other}});
        }
    }
}

}  // namespace
}  // namespace voyager::damaged_chunks_test
