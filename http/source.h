#pragma once
// What a URL names, as a byte source: ranges over HTTP, HTTPS, HTTP/2 where TLS agrees on it.
#include <memory>
#include <string>
#include <vector>

#include "http/pool.h"
#include "runtime/base/file.h"

namespace voyager::http {

// The file's size and version come from a first range request, which also brings the first
// bytes: reads of those ask nobody. Reads that fail and may yet go well are tried again, from
// where they were cut off, after times that double, with jitter, or that the server names.
class Source final : public ByteSource {
 public:
  // Throws Error(invalid_argument) for a malformed URL, else what read() throws.
  Source(const std::string& url, const Options& options);

  const std::string& name() const override { return name_; }  // the URL as shown_path() has it
  uint64_t size() const override { return version_.size; }
  // Error(io_transient): the network, a busy server, the deadline, after all tries.
  // Error(file_not_found), Error(io), Error(refused_input): as check_reply says; for good.
  void read(uint64_t offset, std::span<std::byte> into) const override;
  unsigned reads_at_once() const noexcept override {
    return static_cast<unsigned>(options_.connections);
  }
  void cancel() const noexcept override { pool_.cancel(); }

 private:
  class Tries;
  void read_first_bytes();

  const std::string name_;
  const Options options_;
  mutable Pool pool_;
  FileVersion version_;
  std::vector<std::byte> first_bytes_;
};

}  // namespace voyager::http
