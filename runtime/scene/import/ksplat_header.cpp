#include <algorithm>
#include <bit>

#include "runtime/math/sh.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/ksplat_format.h"
#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::ksplat {
namespace {

constexpr size_t kHeaderBytes = 4096, kSectionBytes = 1024;
constexpr uint32_t kPositionSteps = 32767;  // where a header says none
constexpr float kShReach = 1.5f;
constexpr int kMostDegree = 2;

static_assert(std::endian::native == std::endian::little);

// The fields of one header, for its messages: where it starts, and what it is called.
class Fields {
 public:
  Fields(const ByteReader& input, std::vector<std::byte> bytes, size_t expected, std::string what)
      : name_(input.name()),
        at_(input.offset() - bytes.size()),
        what_(std::move(what)),
        bytes_(std::move(bytes)) {
    if (bytes_.size() != expected)
      refuse(name_, input.offset(), what_, std::to_string(bytes_.size()) + " bytes",
             std::to_string(expected) + " bytes");
  }

  template <class T>
  T value(size_t offset) const {
    return load<T>(&bytes_[offset]);
  }

  template <class T>
  T in_range(const char* field, size_t offset, uint64_t least, uint64_t most) const {
    const T found = value<T>(offset);
    if (found < least || found > most)
      refuse_field(field, offset, std::to_string(found),
                   std::to_string(least) + " to " + std::to_string(most));
    return found;
  }

  [[noreturn]] void refuse_field(const char* field, size_t offset, const std::string& found,
                                 const std::string& expected) const {
    refuse(name_, at_ + offset, what_ + ": " + field, found, expected);
  }

 private:
  std::string name_;
  uint64_t at_;
  std::string what_;
  std::vector<std::byte> bytes_;
};

Section read_section(const Fields& fields, const Header& header) {
  Section section;
  section.rows = fields.value<uint32_t>(4);
  section.count = fields.in_range<uint32_t>("Gaussians", 0, 0, section.rows);
  section.bucket_size = fields.value<uint32_t>(8);
  section.buckets = fields.value<uint32_t>(12);
  section.bucket_width = fields.value<float>(16);
  section.centre_bytes = fields.value<uint16_t>(20);
  section.position_steps = fields.value<uint32_t>(24);
  section.full_buckets = fields.value<uint32_t>(32);
  section.partial_buckets = fields.value<uint32_t>(36);
  section.sh_degree = fields.in_range<uint16_t>("SH degree", 40, 0, kMostDegree);
  if (section.position_steps == 0) section.position_steps = kPositionSteps;
  if (!header.compressed()) return section;
  fields.in_range<uint16_t>("bytes of a bucket", 20, 3 * sizeof(float), UINT16_MAX);
  fields.in_range<uint32_t>("full buckets", 32, 0, section.buckets);
  fields.in_range<uint32_t>("partly filled buckets", 36, 0, section.buckets - section.full_buckets);
  return section;
}

// The sections fill the file; none overflows, as each field has at most 32 bits.
void check_length(const ByteReader& input, const Header& header) {
  uint64_t count = 0, bytes = 0;
  bool fits = true;
  for (const Section& section : header.sections) {
    count += section.count;
    fits = fits && !__builtin_add_overflow(bytes, header.bytes_of(section), &bytes);
  }
  if (count != header.count)
    refuse(input.name(), input.offset(), "sections", std::to_string(count) + " Gaussians",
           std::to_string(header.count) + ", as the header says");
  const std::optional<uint64_t> found = input.remaining();
  if (found && (!fits || *found != bytes))
    refuse(input.name(), input.offset(), "sections", std::to_string(*found) + " bytes",
           std::to_string(bytes) + " bytes, as their headers say");
}

}  // namespace

size_t Header::row_bytes(const Section& section) const {
  const size_t rest = 3 * (static_cast<size_t>(sh_coefficients(section.sh_degree)) - 1);
  if (level == Level::floats) return 44 + 4 * rest;
  return 24 + (level == Level::halves ? 2 : 1) * rest;
}

uint64_t Header::bytes_of(const Section& section) const {
  return 4 * section.partial_buckets + section.centre_bytes * section.buckets +
         row_bytes(section) * section.rows;
}

int Header::sh_degree() const {
  int highest = 0;
  for (const Section& section : sections) highest = std::max(highest, section.sh_degree);
  return highest;
}

Header read_header(ByteReader& input) {
  const Fields fields(input, read_as_they_come(input, kHeaderBytes), kHeaderBytes, "header");
  fields.in_range<uint8_t>("major version", 0, 0, 0);
  fields.in_range<uint8_t>("minor version", 1, 1, 1);
  Header header;
  header.level = static_cast<Level>(fields.in_range<uint16_t>("compression level", 20, 0, 2));
  header.count = fields.value<uint32_t>(16);
  header.sh_least = fields.value<float>(36);
  header.sh_most = fields.value<float>(40);
  if (header.sh_least == 0 && header.sh_most == 0)
    header.sh_least = -kShReach, header.sh_most = kShReach;
  // Places for sections that are not used have no rows.
  const uint64_t sections = fields.value<uint32_t>(4);
  for (uint64_t i = 0; i < sections; ++i)
    header.sections.push_back(read_section(Fields(input, read_as_they_come(input, kSectionBytes),
                                                  kSectionBytes, "section " + std::to_string(i)),
                                           header));
  check_length(input, header);
  return header;
}

}  // namespace voyager::ksplat
