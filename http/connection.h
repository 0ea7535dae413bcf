#pragma once
// libcurl, behind one function.
#include <curl/curl.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "http/options.h"
#include "http/reply.h"

namespace voyager::http {

using Clock = std::chrono::steady_clock;

// One request, and what has come of it, also where it failed.
struct Transfer {
  ByteRange range;
  std::span<std::byte> into;           // of the range's size, at least
  const FileVersion* known = nullptr;  // as check_reply takes it
  Clock::time_point deadline{};        // should nothing come; bytes put it off (Options::time_for)

  size_t got = 0;                        // bytes in `into`
  std::optional<FileVersion> version{};  // once the server's headers were accepted
  std::chrono::seconds retry_after{0};   // the server's wish
};

// A connection to the server (and those that it redirects to), kept open from one request to the
// next. Used by one thread at a time, wake() apart.
class Connection {
 public:
  // What it is given by reference must outlive it, but for the url. Throws Error(internal),
  // std::bad_alloc.
  Connection(const std::string& url, const std::string& name, const Options& options,
             const std::atomic<bool>& cancelled);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  // Returns when all bytes of the range that the file has are in `into`. Throws what check_reply
  // throws; Error(io_transient) where the network failed or the deadline passed; Error(io) when
  // cancelled, or where the certificate is refused; Error(invalid_argument) for a malformed URL;
  // Error(refused_input) for what is no HTTP, and for a redirection to a malformed URL.
  void get(Transfer& transfer);
  // Makes get() look at `cancelled` now. From any thread.
  void wake() noexcept { curl_multi_wakeup(multi_.get()); }

 private:
  struct EndEasy {
    void operator()(CURL* easy) const { curl_easy_cleanup(easy); }
  };
  struct EndMulti {
    void operator()(CURLM* multi) const { curl_multi_cleanup(multi); }
  };

  struct Answer;
  static size_t on_head(const char* line, size_t one, size_t count, void* answer);
  static size_t on_body(const char* bytes, size_t one, size_t count, void* answer);
  void begin_request();
  CURLcode run(Answer& answer);
  // Milliseconds until it is over, for the reason in error_.
  int64_t time_left(const Answer& answer);
  [[noreturn]] void fail(CURLcode code, const Transfer& transfer) const;

  const std::string url_;
  const std::string& name_;
  const Options& options_;
  const std::atomic<bool>& cancelled_;
  std::unique_ptr<CURLM, EndMulti> multi_;  // owns the open connections
  std::unique_ptr<CURL, EndEasy> easy_;
  char error_[CURL_ERROR_SIZE] = {};
};

}  // namespace voyager::http
