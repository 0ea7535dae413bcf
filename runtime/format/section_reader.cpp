#include "runtime/format/section_reader.h"

namespace voyager {

SectionReader::SectionReader(const ByteSource& source, const Section& section, SectionKind kind,
                             uint64_t offset, uint64_t length, const Check& check)
    : source_(source), section_(section), check_(check), next_(offset), end_(offset + length) {
  const uint64_t at = offsetof(FileHeader, section_count);
  check.equal(at, "section kind", section.kind, static_cast<uint32_t>(kind));
  check.equal(at, "reserved field", section.reserved, 0);
  check.equal(at, "section offset", section.offset, offset);
  check.equal(at, "section length", section.length, length);
  check.at_most(at, "section end", end_, source.size());
}

void SectionReader::read_piece(std::span<std::byte> bytes) {
  source_.read(next_, bytes);
  sum_.add(bytes);
  next_ += bytes.size();
}

void SectionReader::finish(std::span<const std::byte> padding) {
  check_.equal(section_.offset, "section checksum", sum_.value(), section_.checksum);
  check_.that(
      std::all_of(padding.begin(), padding.end(), [](std::byte b) { return b == std::byte{0}; }),
      end_ - padding.size(), "padding that is not 0", "zeros");
}

}  // namespace voyager
