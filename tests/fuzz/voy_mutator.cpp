// Mutates what a .voy file says, not its compressed bytes: header, tiers, directory, and the plain
// payload of a chunk. What is left is sealed, so that nothing but the values is wrong.
#include <zstd.h>

#include "runtime/format/layout.h"
#include "tests/fuzz/mutator.h"
#include "tests/support/sealed.h"

namespace voyager::fuzz {
namespace {

constexpr size_t kMostPlain = 1 << 20;  // bytes of a chunk

class File {
 public:
  explicit File(const Bytes& bytes) : bytes_(bytes) {
    if (bytes_.size() < sizeof header_) return;
    std::memcpy(&header_, bytes_.data(), sizeof header_);
    const uint64_t directory = header_.directory.offset;
    sound_ = header_.chunk_count != 0 && directory <= bytes_.size() &&
             header_.chunk_count <= (bytes_.size() - directory) / sizeof(ChunkEntry);
    if (!sound_) return;
    entries_.resize(header_.chunk_count);
    std::memcpy(entries_.data(), bytes_.data() + directory, entries_.size() * sizeof(ChunkEntry));
    for (const ChunkEntry& entry : entries_)
      sound_ &= entry.bytes >= sizeof(ChunkHeader) && entry.offset <= bytes_.size() &&
                entry.bytes <= bytes_.size() - entry.offset;
  }
  bool sound() const { return sound_; }
  bool compact() const { return header_.quality == static_cast<uint32_t>(Quality::compact); }
  size_t chunks() const { return entries_.size(); }

  std::span<std::byte> header() { return std::span(bytes_).first(sizeof header_); }
  std::span<std::byte> tiers() {
    const Section& s = header_.tiers;
    if (s.offset > bytes_.size() || s.length > bytes_.size() - s.offset) return {};
    return std::span(bytes_).subspan(s.offset, s.length);
  }
  std::span<std::byte> directory() {
    return std::span(bytes_).subspan(header_.directory.offset,
                                     entries_.size() * sizeof(ChunkEntry));
  }
  // After the last chunk, mostly nothing.
  std::span<std::byte> further() {
    return std::span(bytes_).subspan(entries_.back().offset + entries_.back().bytes);
  }
  std::span<std::byte> stored(size_t chunk) {
    return std::span(bytes_).subspan(entries_[chunk].offset, entries_[chunk].bytes);
  }

  // Empty where it is none.
  Bytes plain(size_t chunk) {
    const auto all = stored(chunk).subspan(sizeof(ChunkHeader));
    ChunkHeader own;
    std::memcpy(&own, stored(chunk).data(), sizeof own);
    const auto payload = all.first(std::min<size_t>(own.payload_bytes, all.size()));
    if (!compact()) return {payload.begin(), payload.end()};
    const unsigned long long size = ZSTD_getFrameContentSize(payload.data(), payload.size());
    Bytes out(size <= kMostPlain ? size : kMostPlain);
    const size_t got = ZSTD_decompress(out.data(), out.size(), payload.data(), payload.size());
    out.resize(ZSTD_isError(got) ? 0 : got);
    return out;
  }

  void set_plain(size_t chunk, const Bytes& plain) {
    ChunkHeader own;
    std::memcpy(&own, stored(chunk).data(), sizeof own);
    Bytes payload = plain;
    if (compact()) {
      payload.resize(ZSTD_compressBound(plain.size()));
      payload.resize(ZSTD_compress(payload.data(), payload.size(), plain.data(), plain.size(), 1));
    }
    own.payload_bytes = static_cast<uint32_t>(payload.size());
    Bytes whole(sizeof own);
    std::memcpy(whole.data(), &own, sizeof own);
    whole.insert(whole.end(), payload.begin(), payload.end());
    whole.resize(align_up(whole.size(), chunk_align(static_cast<Quality>(header_.quality))));
    set_stored(chunk, whole);
  }

  // The chunks behind it move.
  void set_stored(size_t chunk, const Bytes& whole) {
    ChunkEntry& entry = entries_[chunk];
    const auto at = bytes_.begin() + static_cast<std::ptrdiff_t>(entry.offset);
    bytes_.insert(bytes_.erase(at, at + entry.bytes), whole.begin(), whole.end());
    for (ChunkEntry& other : entries_)
      if (other.offset > entry.offset) other.offset += whole.size() - entry.bytes;
    entry.bytes = static_cast<uint32_t>(whole.size());
    put_directory();
  }

  // One chunk in the place of another, with or without what the directory says of it.
  void copy_chunk(size_t from, size_t to, bool entry) {
    const auto source = stored(from);
    const Bytes whole(source.begin(), source.end());
    if (entry) {
      const uint64_t offset = entries_[to].offset;
      const uint32_t bytes = entries_[to].bytes;
      entries_[to] = entries_[from];
      entries_[to].offset = offset;
      entries_[to].bytes = bytes;
    }
    set_stored(to, whole);
  }

  const Bytes& bytes() const { return bytes_; }

 private:
  void put_directory() {
    std::memcpy(bytes_.data() + header_.directory.offset, entries_.data(),
                entries_.size() * sizeof(ChunkEntry));
  }

  Bytes bytes_;
  FileHeader header_{};
  std::vector<ChunkEntry> entries_;
  bool sound_ = false;
};

void mutate_some_word(std::span<std::byte> bytes, Random& random) {
  mutate_word(bytes, random.below(bytes.size() / 4) * 4, random);
}

void mutate_payload(File& file, Random& random) {
  const size_t chunk = random.below(file.chunks());
  Bytes plain = file.plain(chunk);
  if (plain.empty()) return mutate_in_place(file.stored(chunk));
  for (size_t times = 1 + random.below(4); times != 0; --times) {
    if (random.once_in(3))
      mutate_in_place(plain);
    else if (random.once_in(2))  // the counts of subtrees and nodes come first
      plain[random.below(std::min<size_t>(plain.size(), 64))] =
          static_cast<std::byte>(random.below(8));
    else
      mutate_word(plain, random.below(plain.size()), random);
  }
  file.set_plain(chunk, plain);
}

void mutate_file(File& file, Random& random) {
  // Counts and nodes come first.
  if (const auto further = file.further(); further.size() >= 8 && random.once_in(4))
    return mutate_some_word(further.first(std::min<size_t>(further.size(), 40)), random);
  switch (random.below(10)) {
    case 0:
      return mutate_some_word(file.header(), random);
    case 1:
      return mutate_some_word(file.tiers(), random);
    case 2:
    case 3:
      return mutate_some_word(file.directory(), random);
    case 4:
      return mutate_some_word(file.stored(random.below(file.chunks())).first(sizeof(ChunkHeader)),
                              random);
    case 5:
      return file.copy_chunk(random.below(file.chunks()), random.below(file.chunks()),
                             random.once_in(2));
    default:
      return mutate_payload(file, random);
  }
}

}  // namespace
}  // namespace voyager::fuzz

size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  using namespace voyager::fuzz;
  Random random(seed);
  const auto* first = reinterpret_cast<const std::byte*>(data);
  Bytes bytes(first, first + size);
  File file(bytes);
  if (!file.sound() || random.once_in(20)) {
    mutate(bytes, max_size);
  } else {
    for (size_t times = 1 + random.below(2); times != 0; --times) {
      mutate_file(file, random);
      if (file = File(file.bytes()); !file.sound()) break;
    }
    bytes = file.bytes();
  }
  return hand_back(voyager::test::sealed(bytes), data, size, max_size);
}
