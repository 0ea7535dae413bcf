#pragma once
// The small files of a work folder: whole or absent, and found out where a byte of
// them has changed.
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "runtime/base/file.h"

namespace voyager {

// Appears in one step. Throws Error(io).
void write_sealed(const std::string& path, std::span<const std::byte> bytes);

// Throws Error(refused_input) naming the file where its checksum does not match; advice: what to do
// then.
inline constexpr char kFolderAltered[] = "the work folder was altered; remove it and bake again";
std::vector<std::byte> read_sealed(const std::string& path, const char* advice = kFolderAltered);

// Of a file outside a work folder, which begins with six letters that say what it is, a digit for
// the version, and a zero byte. Throws Error(refused_input) where there are others; content: what
// was expected.
void check_kind(const std::string& path, uint64_t kind, const std::string& content);

[[noreturn]] void refuse_folder(const std::string& path, const std::string& found,
                                const std::string& expected);

// Values and arrays of them, one after the other.
class Packer {
 public:
  template <class T>
  Packer& put(const T& value) {
    return put(std::span(&value, 1));
  }
  template <class T, size_t extent>
  Packer& put(std::span<T, extent> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const size_t begin = bytes_.size();
    bytes_.resize(begin + values.size_bytes());
    if (!values.empty()) std::memcpy(bytes_.data() + begin, values.data(), values.size_bytes());
    return *this;
  }
  // With its length before it.
  template <class Values>
  Packer& put_all(const Values& values) {
    return put(uint64_t{values.size()}).put(std::span(values.data(), values.size()));
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

class Unpacker {
 public:
  // The bytes outlive the unpacker; `path` names them in refusals.
  Unpacker(const std::string& path, std::span<const std::byte> bytes)
      : path_(path), bytes_(bytes) {}

  template <class T>
  T take() {
    T value;
    take(std::span(&value, 1));
    return value;
  }
  template <class T>
  void take(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    need(values.size_bytes());
    if (!values.empty()) std::memcpy(values.data(), bytes_.data(), values.size_bytes());
    bytes_ = bytes_.subspan(values.size_bytes());
  }
  template <class Values>
  void take_all(Values& values) {
    const auto count = take<uint64_t>();
    need(count);  // before anything is allocated for it
    values.resize(count);
    take(std::span(values.data(), values.size()));
  }

 private:
  void need(uint64_t bytes) const {
    if (bytes > bytes_.size())
      refuse_folder(path_, std::to_string(bytes_.size()) + " bytes left", std::to_string(bytes));
  }

  const std::string& path_;
  std::span<const std::byte> bytes_;
};

}  // namespace voyager
