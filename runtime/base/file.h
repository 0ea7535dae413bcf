#pragma once
// Byte input and output. A ByteSource is random access (a file, memory, the
// host's callback); a ByteReader is a forward-only stream (a pipe, or a window
// on a source); an AtomicFile appears under its name only when complete.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/base/file_descriptor.h"

namespace voyager {

// How a source will be read from now on.
enum class Access {
  forward,    // mostly from the start to the end: the system reads ahead
  scattered,  // pieces here and there: no reading ahead
  uncached,   // the same, past the system's page cache where the file system can
};

class ByteSource {
 public:
  virtual ~ByteSource() = default;
  // What error messages call it: a path, a URL without its secrets, or the host's name for it.
  virtual const std::string& name() const = 0;
  virtual uint64_t size() const = 0;
  // Fills all of `into` from `offset`, or throws: Error(io_transient) where the same read may
  // go well later; any other code where it will not, among them Error(refused_input) for a
  // range beyond size(). `into` then holds anything. Blocks; safe to call from several threads
  // at once.
  virtual void read(uint64_t offset, std::span<std::byte> into) const = 0;
  // How many reads are worth having at once: several where each waits for an answer (HTTP).
  virtual unsigned reads_at_once() const noexcept { return 1; }
  // A wish, granted where the source has something to choose. Before reads of other threads.
  virtual void expect(Access) const noexcept {}
  // Nobody wants the bytes any more: where reads can be slow for want of an answer (HTTP),
  // those in flight end at once with Error(io), as do all later ones. Callable from any thread,
  // during reads; for good. The others are not affected.
  virtual void cancel() const noexcept {}
  // Another file that this one refers to, in its folder or below: a relative path, its folders
  // parted by /. Only a local file has a folder. Throws Error(refused_input) naming both for any
  // other source and for a path that leads elsewhere, also through links; else what
  // open_file_source() throws.
  virtual std::unique_ptr<ByteSource> open_beside(const std::string& path) const;
};

// Throws Error(refused_input) unless [offset, offset + count) is within the source.
void check_range(const ByteSource& source, uint64_t offset, size_t count);

// A regular file, not most of it holes (file_data.h). Its reads fail with Error(io) once it has
// been truncated below them. Throws Error(file_not_found), Error(refused_input) or Error(io).
std::unique_ptr<ByteSource> open_file_source(const std::string& path);

class MemorySource final : public ByteSource {
 public:
  // The bytes are not copied and must outlive the source.
  MemorySource(std::string name, std::span<const std::byte> bytes);
  const std::string& name() const override { return name_; }
  uint64_t size() const override { return bytes_.size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override;

 private:
  std::string name_;
  std::span<const std::byte> bytes_;
};

class ByteReader {
 public:
  virtual ~ByteReader() = default;
  virtual const std::string& name() const = 0;
  // Reads up to into.size() bytes; fewer only at the end. Throws Error(io).
  virtual size_t read(std::span<std::byte> into) = 0;
  // Steps over up to `count` bytes; returns how many there were. Throws Error(io).
  virtual uint64_t skip(uint64_t count);
  // Bytes that are left, where that is known (not for a pipe).
  virtual std::optional<uint64_t> remaining() const = 0;
  // Bytes delivered so far: the offset that messages name.
  virtual uint64_t offset() const = 0;
};

// The source must outlive the reader.
std::unique_ptr<ByteReader> read_source(const ByteSource& source);
// Throws Error(refused_input) for a file most of which is holes.
std::unique_ptr<ByteReader> read_stdin();

// Has no name until commit(), which flushes and then takes `path` in one step; where `path` is a
// symbolic link, the name that it leads to. Destroyed without commit, or killed, it leaves `path`
// alone, and nothing behind but on file systems without unnamed files, where a kill leaves
// path.partial-*. write() may come from one thread at a time, write_at() from several where no two
// overlap. All throw Error(io).
class AtomicFile {
 public:
  // Throws Error(io) also where require_replaceable() does (output_path.h).
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);                      // append
  void write_at(uint64_t offset, std::span<const std::byte> bytes);  // overwrite, position kept
  uint64_t position() const { return position_; }
  void commit();
  // The same without the flush: whole to every process, also after a kill, but a loss of
  // power may tear it. For files under checksums that can be made again.
  void commit_unflushed();
  // The same, but only where nothing has the name yet; false where something has.
  bool commit_new();

  // Of the file, before and after it has its name.
  FileDescriptor& descriptor() { return fd_; }

 private:
  bool link_to(const std::string& name);  // false: the name is taken

  std::string path_, target_;
  std::string temporary_;  // the name that it has on the way, if any
  FileDescriptor fd_;
  uint64_t position_ = 0;
};

// A file's name without the ending that an AtomicFile gives it on the way.
std::string_view without_partial(std::string_view name);

}  // namespace voyager
