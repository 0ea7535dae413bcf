#include <algorithm>
#include <vector>

#include "runtime/scene/import/decompress.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/spz_decode.h"
#include "runtime/scene/transform.h"

namespace voyager {
namespace {

using spz::Attribute;

constexpr size_t kGaussiansAtOnce = 4096;

class SpzImport {
 public:
  SpzImport(ByteReader& reader, const ImportOptions& options)
      : input_(reader), options_(options), cloud_(options.memory) {}

  GaussianCloud run() {
    const std::span<const std::byte> first = input_.peek(1);
    if (!first.empty() && first[0] == std::byte{0x1f}) {
      GzipReader plain(input_);
      begin(plain, spz::kNewestPlanar, true);
      read_planar(plain);
      plain.finish();
    } else {
      begin(input_, spz::kNewest, false);
      if (header_.version == spz::kNewest)
        read_streams();
      else
        read_planar(input_);
      if (!input_.peek(1).empty())
        refuse(input_.name(), input_.offset(), "length", "more bytes", "the end of the file");
    }
    return std::move(cloud_);
  }

 private:
  void begin(ByteReader& plain, uint32_t newest_version, bool gzipped) {
    header_ = spz::read_header(plain, newest_version);
    spz::check_count(input_, header_, gzipped);
    cloud_.sh_degree = header_.sh_degree;
    cloud_.native = header_.native();
  }

  // v1-v3: one attribute after the other, then extensions if there are any.
  void read_planar(ByteReader& plain) {
    for (int i = 0; i < header_.attributes(); ++i) read(plain, static_cast<Attribute>(i));
    turn(spz::read_last_extensions(plain, header_));
  }

  void turn(const spz::Extensions& extensions) {
    if (extensions.turns())
      CloudTransform(extensions.axes, input_.name() + ": coordinate system").apply(cloud_, {});
  }

  void read_streams() {
    const spz::StreamTable table = spz::read_stream_table(input_, header_);
    for (int i = 0; i < header_.attributes(); ++i) {
      ZstdReader plain(input_, table.compressed[static_cast<size_t>(i)],
                       header_.bytes_of_all(static_cast<Attribute>(i)));
      read(plain, static_cast<Attribute>(i));
      plain.finish();
    }
    turn(table.extensions);
  }

  void read(ByteReader& plain, Attribute attribute) {
    const size_t width = header_.bytes_of(attribute);
    std::vector<std::byte> block(kGaussiansAtOnce * width);
    for (size_t first = 0; first < header_.count;) {
      const size_t n = std::min<size_t>(kGaussiansAtOnce, header_.count - first);
      const auto codes = std::span(block).first(n * width);
      const size_t got = plain.read(codes);
      if (got != codes.size())
        refuse(plain.name(), plain.offset(), spz::kAttributeName[attribute],
               std::to_string(first * width + got) + " bytes",
               std::to_string(uint64_t{header_.count} * width) + " bytes");
      make_room(attribute, first + n);
      spz::decode(header_, attribute, codes, first, cloud_);
      first += n;
      report(options_.progress, "reading", uint64_t{attribute} * header_.count + first,
             static_cast<uint64_t>(header_.attributes()) * header_.count);
    }
  }

  // Colours bring the whole row of SH coefficients; the sh stream fills it.
  void make_room(Attribute attribute, size_t gaussians) {
    const auto grow = [&](std::pmr::vector<float>& values, size_t width) {
      reserve_for(values, gaussians, header_.count, width);
      values.resize(gaussians * width);
    };
    switch (attribute) {
      case spz::kPositions:
        return grow(cloud_.position, 3);
      case spz::kAlphas:
        return grow(cloud_.opacity, 1);
      case spz::kColours:
        return grow(cloud_.sh, static_cast<size_t>(cloud_.coefficients()) * 3);
      case spz::kScales:
        return grow(cloud_.log_scale, 3);
      case spz::kRotations:
        return grow(cloud_.rotation, 4);
      default:
        return;
    }
  }

  PeekReader input_;
  const ImportOptions& options_;
  GaussianCloud cloud_;
  spz::Header header_;
};

}  // namespace

GaussianCloud import_spz(ByteReader& reader, const ImportOptions& options) {
  return SpzImport(reader, options).run();
}

}  // namespace voyager
