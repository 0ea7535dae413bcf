#include "http/connection.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>

#include "http/sigpipe.h"
#include "runtime/base/error.h"

namespace voyager::http {
// What libcurl's callbacks fill. Nothing may be thrown through libcurl, so what went wrong is kept.
struct Connection::Answer {
  const std::string& name;
  Transfer& transfer;
  Clock::time_point heard = Clock::now();  // when bytes came last
  ReplyHead head{};
  uint64_t body = 0;  // bytes to come, once the head is accepted
  std::exception_ptr failure{};

  // Obsolete since RFC 7230, and libcurl up to 8.0 reads freed memory at the second of them.
  [[noreturn]] void refuse_folded() const {
    throw Error(ErrorCode::refused_input,
                name +
                    ": found a line of the head that begins with a space, expected the name of a "
                    "header field");
  }
  void take_head() {
    if (!head.is_final() || transfer.version) return;
    Accepted accepted = check_reply(name, head, transfer.range, transfer.known);
    body = accepted.body;
    transfer.version = std::move(accepted.version);
  }
};

// A line of the head; an empty one ends it. Anything but `count` ends the transfer.
size_t Connection::on_head(const char* line, size_t, size_t count, void* user) {
  auto& answer = *static_cast<Answer*>(user);
  answer.heard = Clock::now();
  try {
    if (count == 0 || line[0] == '\r' || line[0] == '\n')
      answer.take_head();
    else if (line[0] == ' ' || line[0] == '\t')
      answer.refuse_folded();
    else
      answer.head.add_line({line, count});
    return count;
  } catch (...) {
    answer.failure = std::current_exception();
    return 0;
  }
}

size_t Connection::on_body(const char* bytes, size_t, size_t count, void* user) {
  auto& answer = *static_cast<Answer*>(user);
  Transfer& transfer = answer.transfer;
  answer.heard = Clock::now();
  if (!transfer.version || count > answer.body - transfer.got) {
    answer.failure = std::make_exception_ptr(
        Error(ErrorCode::refused_input, answer.name +
                                            ": found more bytes than were announced, "
                                            "expected " +
                                            std::to_string(answer.body)));
    return 0;
  }
  std::memcpy(transfer.into.data() + transfer.got, bytes, count);
  transfer.got += count;
  return count;
}

namespace {

void start_libcurl() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (curl_global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK)
      throw Error(ErrorCode::internal, "libcurl: cannot be initialised");
  });
}

template <class Value>
void set(CURL* easy, CURLoption option, Value value) {
  const CURLcode code = curl_easy_setopt(easy, option, value);
  if (code == CURLE_OUT_OF_MEMORY) throw std::bad_alloc();
  if (code != CURLE_OK)
    throw Error(ErrorCode::internal,
                "libcurl: option " + std::to_string(option) + ": " + curl_easy_strerror(code));
}

// http and https alone; what began as https stays that.
void set_protocols(CURL* easy, bool secure) {
#if LIBCURL_VERSION_NUM >= 0x075500
  set(easy, CURLOPT_PROTOCOLS_STR, "http,https");
  set(easy, CURLOPT_REDIR_PROTOCOLS_STR, secure ? "https" : "http,https");
#else
  set(easy, CURLOPT_PROTOCOLS, long{CURLPROTO_HTTP | CURLPROTO_HTTPS});
  set(easy, CURLOPT_REDIR_PROTOCOLS,
      secure ? long{CURLPROTO_HTTPS} : long{CURLPROTO_HTTP | CURLPROTO_HTTPS});
#endif
}

// The variables that curl and OpenSSL know; without them, the system's own certificates.
void set_certificates(CURL* easy) {
  set(easy, CURLOPT_SSL_VERIFYPEER, 1L);
  set(easy, CURLOPT_SSL_VERIFYHOST, 2L);
  const auto given = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0' ? value : nullptr;
  };
  const char* bundle = given("CURL_CA_BUNDLE");
  if (bundle == nullptr) bundle = given("SSL_CERT_FILE");
  if (bundle != nullptr) set(easy, CURLOPT_CAINFO, bundle);
  if (const char* folder = given("SSL_CERT_DIR")) set(easy, CURLOPT_CAPATH, folder);
}

template <size_t N>
bool is_in(const std::array<CURLcode, N>& list, CURLcode code) {
  return std::find(list.begin(), list.end(), code) != list.end();
}

ErrorCode code_of(CURLcode code) {
  constexpr std::array kMayPass = {CURLE_COULDNT_RESOLVE_PROXY,
                                   CURLE_COULDNT_RESOLVE_HOST,
                                   CURLE_COULDNT_CONNECT,
                                   CURLE_OPERATION_TIMEDOUT,
                                   CURLE_SSL_CONNECT_ERROR,
                                   CURLE_GOT_NOTHING,
                                   CURLE_SEND_ERROR,
                                   CURLE_RECV_ERROR,
                                   CURLE_PARTIAL_FILE,
                                   CURLE_HTTP2,
                                   CURLE_HTTP2_STREAM,
                                   CURLE_AGAIN};
  constexpr std::array kNoAnswer = {CURLE_UNSUPPORTED_PROTOCOL, CURLE_WEIRD_SERVER_REPLY,
                                    CURLE_TOO_MANY_REDIRECTS, CURLE_BAD_CONTENT_ENCODING};
  if (is_in(kMayPass, code)) return ErrorCode::io_transient;
  if (is_in(kNoAnswer, code)) return ErrorCode::refused_input;
  return code == CURLE_URL_MALFORMAT ? ErrorCode::invalid_argument : ErrorCode::io;
}

}  // namespace

Connection::Connection(const std::string& url, const std::string& name, const Options& options,
                       const std::atomic<bool>& cancelled)
    : url_(url), name_(name), options_(options), cancelled_(cancelled) {
  start_libcurl();
  multi_.reset(curl_multi_init());
  if (!multi_) throw std::bad_alloc();
  begin_request();
}

// A handle of its own for each request: libcurl up to 8.0 keeps a pointer to the last header of the
// one before, and reads there where a head begins with a folded line. Connections are the multi
// handle's.
void Connection::begin_request() {
  easy_.reset(curl_easy_init());
  if (!easy_) throw std::bad_alloc();
  CURL* easy = easy_.get();
  set(easy, CURLOPT_URL, url_.c_str());
  set(easy, CURLOPT_ERRORBUFFER, error_);
  set(easy, CURLOPT_NOSIGNAL, 1L);
  set(easy, CURLOPT_USERAGENT, "voyager/" VOYAGER_VERSION);
  set(easy, CURLOPT_FOLLOWLOCATION, 1L);
  set(easy, CURLOPT_MAXREDIRS, static_cast<long>(options_.redirects));
  set_protocols(easy, url_.size() > 4 && (url_[4] == 's' || url_[4] == 'S'));
  set_certificates(easy);
  set(easy, CURLOPT_SUPPRESS_CONNECT_HEADERS, 1L);
  set(easy, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(options_.stall_time.count()));
  set(easy, CURLOPT_HEADERFUNCTION, &on_head);
  set(easy, CURLOPT_WRITEFUNCTION, &on_body);
#if LIBCURL_VERSION_NUM >= 0x075700
  set(easy, CURLOPT_QUICK_EXIT, 1L);  // a name that is being looked up is not waited for
#endif
}

void Connection::get(Transfer& transfer) {
  Answer answer{name_, transfer};
  begin_request();
  const std::string range =
      std::to_string(transfer.range.first) + "-" + std::to_string(transfer.range.last);
  set(easy_.get(), CURLOPT_RANGE, range.c_str());
  set(easy_.get(), CURLOPT_HEADERDATA, &answer);
  set(easy_.get(), CURLOPT_WRITEDATA, &answer);
  const CURLcode code = run(answer);
  curl_off_t wish = 0;
  curl_easy_getinfo(easy_.get(), CURLINFO_RETRY_AFTER, &wish);
  transfer.retry_after = std::chrono::seconds(std::clamp<curl_off_t>(wish, 0, 86'400));
  if (answer.failure) std::rethrow_exception(answer.failure);
  if (code != CURLE_OK) fail(code, transfer);
  if (!transfer.version) check_reply(name_, answer.head, transfer.range, transfer.known);
  if (!transfer.version || transfer.got < answer.body) fail(CURLE_PARTIAL_FILE, transfer);
}

CURLcode Connection::run(Answer& answer) {
  const NoSigpipe quiet;
  error_[0] = '\0';
  if (curl_multi_add_handle(multi_.get(), easy_.get()) != CURLM_OK) return CURLE_FAILED_INIT;
  CURLcode result = CURLE_RECV_ERROR;
  for (int running = 1;;) {
    if (curl_multi_perform(multi_.get(), &running) != CURLM_OK) break;
    if (running == 0) {
      int left = 0;
      const CURLMsg* message = curl_multi_info_read(multi_.get(), &left);
      if (message != nullptr) result = message->data.result;
      break;
    }
    const int64_t time = time_left(answer);
    result = cancelled_ ? CURLE_ABORTED_BY_CALLBACK : CURLE_OPERATION_TIMEDOUT;
    if (cancelled_ || time <= 0) break;
    curl_multi_poll(multi_.get(), nullptr, 0, static_cast<int>(std::min<int64_t>(time, 1000)),
                    nullptr);
  }
  curl_multi_remove_handle(multi_.get(), easy_.get());
  return result;
}

int64_t Connection::time_left(const Answer& answer) {
  using std::chrono::milliseconds;
  const Clock::time_point now = Clock::now();
  const auto stall = std::chrono::ceil<milliseconds>(answer.heard + options_.stall_time - now);
  const Transfer& transfer = answer.transfer;
  const auto end =
      std::chrono::ceil<milliseconds>(transfer.deadline - now) + options_.time_for(transfer.got);
  if (stall.count() <= 0 || end.count() <= 0)
    std::snprintf(error_, sizeof error_, "%s",
                  end.count() <= 0 ? "the end of the time for a read" : "a server that stalls");
  return std::min(stall, end).count();
}

void Connection::fail(CURLcode code, const Transfer& transfer) const {
  if (code == CURLE_OUT_OF_MEMORY) throw std::bad_alloc();
  if (code == CURLE_ABORTED_BY_CALLBACK)
    throw Error(ErrorCode::io, name_ + ": reading was cancelled");
  std::string found = error_[0] != '\0' ? error_ : curl_easy_strerror(code);
  if (transfer.got != 0) found += " after " + std::to_string(transfer.got) + " bytes";
  if (code == CURLE_OPERATION_TIMEDOUT) found += " (" + time_text(options_) + ")";
  long redirects = 0;
  curl_easy_getinfo(easy_.get(), CURLINFO_REDIRECT_COUNT, &redirects);
  // A URL that a server names is the server's mistake.
  const bool is_servers = code == CURLE_URL_MALFORMAT && redirects != 0;
  throw Error(is_servers ? ErrorCode::refused_input : code_of(code),
              name_ + ": bytes " + std::to_string(transfer.range.first) + "-" +
                  std::to_string(transfer.range.last) + ": found the failure \"" + found +
                  "\", expected these bytes");
}

}  // namespace voyager::http
