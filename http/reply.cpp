#include "http/reply.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "runtime/base/error.h"

namespace voyager::http {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::optional<uint64_t> number(std::string_view text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

// A server's words in a message: short, and printable.
std::string quoted(std::string_view text) {
  std::string shown(text.substr(0, 80));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.empty() ? "none" : shown;
}

std::string shown(const ByteRange& range) {
  return std::to_string(range.first) + "-" + std::to_string(range.last);
}

// One answer held against one request.
class Check {
 public:
  Check(const std::string& name, const ReplyHead& head, const ByteRange& asked,
        const FileVersion* known)
      : name_(name), head_(head), asked_(asked), known_(known) {}

  Accepted accept() const {
    if (head_.status == 206) return accept_part();
    if (head_.status == 200) return accept_whole();
    if (head_.status == 416) return accept_none();
    refuse_status();
  }

 private:
  [[noreturn]] void fail(ErrorCode code, const std::string& found,
                         const std::string& expected) const {
    throw Error(code,
                name_ + ": bytes " + shown(asked_) + ": found " + found + ", expected " + expected);
  }
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    fail(ErrorCode::refused_input, found, expected);
  }

  [[noreturn]] void refuse_status() const {
    constexpr std::array<long, 7> kMayPass = {408, 425, 429, 500, 502, 503, 504};
    constexpr std::array<long, 4> kForbidden = {401, 403, 407, 451};
    const auto is_in = [&](const auto& list) {
      return std::find(list.begin(), list.end(), head_.status) != list.end();
    };
    const ErrorCode code = is_in(kMayPass)                              ? ErrorCode::io_transient
                           : is_in(kForbidden)                          ? ErrorCode::io
                           : head_.status == 404 || head_.status == 410 ? ErrorCode::file_not_found
                                                                        : ErrorCode::refused_input;
    fail(code, "status " + std::to_string(head_.status), "206 with these bytes");
  }

  Accepted accept_part() const {
    const auto found = parse_content_range(head_.content_range);
    if (!found || !found->range)
      refuse("status 206 with the Content-Range " + quoted(head_.content_range),
             "one with the file's size");
    const FileVersion version = version_of(found->size);
    const ByteRange expected = {asked_.first, std::min(asked_.last, found->size - 1)};
    if (found->range->first != expected.first || found->range->last != expected.last)
      refuse("the bytes " + shown(*found->range), shown(expected));
    return accept_body(version, expected.size());
  }

  // A server that knows no ranges serves files that are asked for as a whole.
  Accepted accept_whole() const {
    const auto size = number(head_.content_length);
    if (known_ && size) version_of(*size);  // a file that was replaced is named as that
    const bool whole = size && asked_.first == 0 && *size <= asked_.size();
    if (!whole)
      refuse("status 200 with " + (size ? "all " + head_.content_length : "no count of") +
                 " bytes of the file",
             "206 with these bytes: the server ignores Range requests");
    return accept_body(version_of(*size), *size);
  }

  // Of an empty file no byte can be had.
  Accepted accept_none() const {
    const auto found = parse_content_range(head_.content_range);
    if (found && !found->range && found->size == 0 && !known_) return {version_of(0), 0};
    if (found && !found->range) version_of(found->size);
    refuse("status 416, of a file with the Content-Range " + quoted(head_.content_range),
           "206 with these bytes");
  }

  Accepted accept_body(FileVersion version, uint64_t bytes) const {
    if (!head_.content_encoding.empty() && !same_word(head_.content_encoding, "identity"))
      refuse("the Content-Encoding " + quoted(head_.content_encoding), "none");
    if (!head_.content_length.empty() && number(head_.content_length) != bytes)
      refuse("the Content-Length " + quoted(head_.content_length), std::to_string(bytes));
    return {std::move(version), bytes};
  }

  // This answer's. An ETag decides alone: servers that share a load may differ in dates.
  FileVersion version_of(uint64_t size) const {
    if (known_) {
      same_version("size", std::to_string(size), std::to_string(known_->size));
      if (!known_->etag.empty())
        same_version("ETag", head_.etag, known_->etag);
      else
        same_version("Last-Modified", head_.last_modified, known_->last_modified);
    }
    return {size, head_.etag, head_.last_modified};
  }
  void same_version(const char* what, const std::string& found, const std::string& expected) const {
    if (found == expected) return;
    fail(ErrorCode::io, std::string(what) + " " + quoted(found),
         quoted(expected) + ": the file was replaced while open");
  }

  const std::string& name_;
  const ReplyHead& head_;
  const ByteRange& asked_;
  const FileVersion* known_;
};

}  // namespace

std::optional<ContentRange> parse_content_range(std::string_view text) {
  constexpr std::string_view kUnit = "bytes ";
  if (text.size() < kUnit.size() || !same_word(text.substr(0, kUnit.size()), kUnit)) return {};
  text = trimmed(text.substr(kUnit.size()));
  const size_t slash = text.find('/');
  if (slash == std::string_view::npos) return {};
  const auto size = number(text.substr(slash + 1));
  if (!size) return {};
  const std::string_view range = text.substr(0, slash);
  if (range == "*") return ContentRange{std::nullopt, *size};
  const size_t dash = std::min(range.find('-'), range.size());
  const auto first = number(range.substr(0, dash));
  const auto last = number(range.substr(std::min(dash + 1, range.size())));
  if (!first || !last || *first > *last || *last >= *size) return {};
  return ContentRange{ByteRange{*first, *last}, *size};
}

void ReplyHead::add_line(std::string_view line) {
  line = trimmed(line);
  if (line.substr(0, 5) == "HTTP/") {
    *this = {};
    const std::string_view rest = trimmed(line.substr(std::min(line.find(' '), line.size())));
    status = static_cast<long>(number(rest.substr(0, 3)).value_or(0));
    return;
  }
  const size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;
  const std::string_view field = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
  if (same_word(field, "content-range")) content_range = value;
  if (same_word(field, "content-length")) content_length = value;
  if (same_word(field, "content-encoding")) content_encoding = value;
  if (same_word(field, "etag")) etag = value;
  if (same_word(field, "last-modified")) last_modified = value;
  if (same_word(field, "location")) location = value;
}

bool ReplyHead::is_final() const {
  return status >= 200 && (status < 300 || status >= 400 || location.empty());
}

Accepted check_reply(const std::string& name, const ReplyHead& head, const ByteRange& asked,
                     const FileVersion* known) {
  return Check(name, head, asked, known).accept();
}

}  // namespace voyager::http
