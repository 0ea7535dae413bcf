// Mutates what a .spz says, not its compressed bytes: plain bytes under a gzip whose CRC is right,
// or the header and the plain streams of a version 4, whose table is right again.
#include <zlib.h>
#include <zstd.h>

#include <algorithm>

#include "runtime/scene/import/spz_header.h"
#include "runtime/scene/spz_format.h"
#include "tests/fuzz/mutator.h"

namespace voyager::fuzz {
namespace {

constexpr size_t kMostPlain = 1 << 16;  // bytes, of a stream

// Empty where it is none.
Bytes gunzip(const Bytes& bytes) {
  z_stream stream = {};
  if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) return {};
  Bytes in = bytes, out(kMostPlain);
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  inflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

Bytes gzip(const Bytes& plain) {
  z_stream stream = {};
  if (deflateInit2(&stream, 1, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    return {};
  Bytes in = plain, out(deflateBound(&stream, static_cast<uLong>(plain.size())) + 64);
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

Bytes from_zstd(std::span<const std::byte> frame) {
  Bytes out(kMostPlain);
  const size_t got = ZSTD_decompress(out.data(), out.size(), frame.data(), frame.size());
  out.resize(ZSTD_isError(got) ? 0 : got);
  return out;
}

Bytes to_zstd(const Bytes& plain) {
  Bytes out(ZSTD_compressBound(plain.size()));
  out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 1));
  return out;
}

uint64_t integer(const Bytes& bytes, size_t at, size_t count) {
  uint64_t value = 0;
  std::memcpy(&value, bytes.data() + at, count);
  return value;
}

// The streams of a version 4 and what is before them.
struct Streams {
  Bytes head;  // up to the table
  std::vector<Bytes> plain;

  // False where it is none.
  bool read(const Bytes& bytes) {
    if (bytes.size() < spz::kStreamsHeaderBytes || integer(bytes, 4, 4) != 4) return false;
    const size_t count = integer(bytes, 15, 1), table = integer(bytes, 16, 4);
    if (count > spz::kAttributes || table > bytes.size() ||
        count * spz::kTableEntryBytes > bytes.size() - table)
      return false;
    head.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(table));
    size_t at = table + count * spz::kTableEntryBytes;
    for (size_t i = 0; i < count; ++i) {
      const uint64_t size = integer(bytes, table + i * spz::kTableEntryBytes, 8);
      if (size > bytes.size() - at) return false;
      plain.push_back(from_zstd(std::span(bytes).subspan(at, size)));
      at += size;
    }
    return head.size() >= spz::kStreamsHeaderBytes;
  }

  Bytes written() const {
    Bytes table, frames;
    for (const Bytes& stream : plain) {
      const Bytes frame = to_zstd(stream);
      for (const uint64_t size : {uint64_t{frame.size()}, uint64_t{stream.size()}}) {
        const auto words = std::as_bytes(std::span(&size, 1));
        table.insert(table.end(), words.begin(), words.end());
      }
      frames.insert(frames.end(), frame.begin(), frame.end());
    }
    Bytes all = head;
    all.insert(all.end(), table.begin(), table.end());
    all.insert(all.end(), frames.begin(), frames.end());
    return all;
  }

  // Streams of the length that the header asks for.
  void fit() {
    const uint64_t count = integer(head, 8, 4);
    const int degree =
        static_cast<int>(std::min<uint64_t>(integer(head, 12, 1), spz::kMostStoredShDegree));
    plain.resize(degree > 0 ? spz::kAttributes : spz::kSh);
    head[15] = static_cast<std::byte>(plain.size());
    for (size_t i = 0; i < plain.size(); ++i) {
      const uint64_t bytes = count * spz::width(static_cast<spz::Attribute>(i), 4, degree);
      if (bytes <= kMostPlain) plain[i].resize(bytes);
    }
  }
};

void mutate_streams(Streams& streams, Random& random) {
  if (random.once_in(3) || streams.plain.empty()) {
    mutate_word(streams.head, 8, random);  // the count
    if (random.once_in(2))
      streams.head[8 + random.below(8)] = static_cast<std::byte>(random.below(5));
  } else {
    Bytes& stream = streams.plain[random.below(streams.plain.size())];
    mutate(stream, stream.size() + 32);
  }
  if (!random.once_in(4)) streams.fit();
}

}  // namespace
}  // namespace voyager::fuzz

size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  using namespace voyager::fuzz;
  Random random(seed);
  const auto* first = reinterpret_cast<const std::byte*>(data);
  Bytes bytes(first, first + size);
  const bool as_it_is = random.once_in(8);
  Streams streams;
  if (Bytes plain; !as_it_is && size > 2 && data[0] == 0x1f && !(plain = gunzip(bytes)).empty()) {
    mutate(plain, std::max<size_t>(plain.size() + 64, 256));
    bytes = gzip(plain);
  } else if (!as_it_is && streams.read(bytes)) {
    mutate_streams(streams, random);
    bytes = streams.written();
  } else {
    mutate(bytes, max_size);
  }
  return hand_back(bytes, data, size, max_size);
}
