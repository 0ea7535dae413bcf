#pragma once
// Files in memory for the tests of importers and writers.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/scene/export/writer.h"
#include "runtime/scene/import/importer.h"
#include "tests/support/import_file.h"

namespace voyager::test {

using Bytes = std::vector<std::byte>;

inline Bytes bytes_of(const std::string& text) {
  const auto view = std::as_bytes(std::span(text));
  return Bytes(view.begin(), view.end());
}

template <class T>
void put(Bytes& bytes, T value) {
  const size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

class BytesSink final : public ByteSink {
 public:
  void write(std::span<const std::byte> more) override {
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  Bytes bytes;
};

class PlacedBytesSink final : public PlacedSink {
 public:
  void write(std::span<const std::byte> more) override {
    write_at(end_, more);
    end_ += more.size();
  }
  void write_at(uint64_t offset, std::span<const std::byte> more) override {
    bytes.resize(std::max<size_t>(bytes.size(), offset + more.size()));
    std::copy(more.begin(), more.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  }
  Bytes bytes;

 private:
  uint64_t end_ = 0;
};

// A stream that cannot say how long it is.
class PipeReader final : public ByteReader {
 public:
  explicit PipeReader(std::span<const std::byte> bytes)
      : source_("pipe", bytes), inner_(read_source(source_)) {}
  const std::string& name() const override { return source_.name(); }
  size_t read(std::span<std::byte> into) override { return inner_->read(into); }
  std::optional<uint64_t> remaining() const override { return std::nullopt; }
  uint64_t offset() const override { return inner_->offset(); }

 private:
  MemorySource source_;
  std::unique_ptr<ByteReader> inner_;
};

inline GaussianCloud import_bytes(const Bytes& bytes, const ImportOptions& options = {}) {
  const MemorySource source("sample.bin", bytes);
  return import_gaussians(*read_source(source), options);
}

inline GaussianCloud import_piped(const Bytes& bytes, const ImportOptions& options = {}) {
  PipeReader reader(bytes);
  return import_gaussians(reader, options);
}

// The message of the refusal, or "" where `work` succeeded or failed otherwise.
inline std::string refusal_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code() == ErrorCode::refused_input ? error.what() : "";
  }
  return "";
}

// Expects that both a source of known length and a pipe refuse the bytes, and
// that both messages name the file, a place, and `field`.
inline void expect_refused(const Bytes& bytes, const std::string& field, const std::string& what) {
  const std::string known = refusal_of([&] { import_bytes(bytes); });
  const std::string piped = refusal_of([&] { import_piped(bytes); });
  for (const std::string& message : {known, piped})
    for (const std::string& part :
         {std::string("offset "), std::string("found "), std::string("expected "), field})
      EXPECT_NE(message.find(part), std::string::npos)
          << what << ": " << part << " in: " << message;
  EXPECT_EQ(known.rfind("sample.bin", 0), 0u) << known;
}

// The same of every part of a file from its start, and of the file with one byte more.
inline void expect_refused_in_part(const Bytes& whole) {
  for (size_t size = 0; size < whole.size(); ++size)
    expect_refused(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)), "",
                   "cut to " + std::to_string(size));
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  expect_refused(longer, "bytes", "one byte more");
}

// Every number of each Gaussian; -0 is 0.
inline void expect_same(const GaussianCloud& a, const GaussianCloud& b) {
  EXPECT_EQ(a.sh_degree, b.sh_degree);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.log_scale, b.log_scale);
  EXPECT_EQ(a.rotation, b.rotation);
  EXPECT_EQ(a.opacity, b.opacity);
  EXPECT_EQ(a.sh, b.sh);
}

// Expects of a file with any one byte changed a cloud, or a refusal.
inline void expect_flips_are_harmless(const Bytes& whole,
                                      const std::function<GaussianCloud(const Bytes&)>& import) {
  const size_t most = import(whole).size() + 1;
  for (size_t at = 0; at < whole.size(); ++at)
    for (const int flip : {1, 0x20, 0x80, 0xff}) {
      Bytes bytes = whole;
      bytes[at] ^= static_cast<std::byte>(flip);
      try {
        EXPECT_LE(import(bytes).size(), most);
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
      }
    }
}

// window_bits: zlib's, which say what stands around the compressed bytes.
inline Bytes deflated(const Bytes& plain, int window_bits, int level = 6) {
  z_stream stream = {};
  deflateInit2(&stream, level, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY);
  Bytes out(deflateBound(&stream, plain.size()) + 64), in = plain;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

inline Bytes gzip(const Bytes& plain) {
  return deflated(plain, 16 + MAX_WBITS);
}

// Version 1 to 3 without gzip: `count` Gaussians whose codes run through all bytes.
inline Bytes planar_spz(uint32_t version, uint32_t count, int sh_degree, uint8_t flags = 0) {
  Bytes bytes;
  put<uint32_t>(bytes, 0x5053474e);
  put<uint32_t>(bytes, version);
  put<uint32_t>(bytes, count);
  for (const int field : {sh_degree, 12, int{flags}, 0})
    put<uint8_t>(bytes, static_cast<uint8_t>(field));
  const size_t width = (version == 1 ? 6u : 9u) + 1 + 3 + 3 + (version < 3 ? 3u : 4u) +
                       3u * static_cast<unsigned>((sh_degree + 1) * (sh_degree + 1) - 1);
  for (size_t i = 0; i < width * count; ++i) put<uint8_t>(bytes, static_cast<uint8_t>(i * 37 + 11));
  return bytes;
}

inline Bytes spz_v4(const GaussianCloud& cloud) {
  BytesSink sink;
  const auto writer = write_spz(sink, cloud.size(), cloud.sh_degree);
  writer->append(cloud);
  writer->finish();
  return sink.bytes;
}

inline Bytes ply_of(const GaussianCloud& cloud, bool double_positions = false) {
  BytesSink sink;
  const auto writer = write_ply(sink, cloud.size(), cloud.sh_degree, double_positions);
  writer->append(cloud);
  writer->finish();
  return sink.bytes;
}

}  // namespace voyager::test
