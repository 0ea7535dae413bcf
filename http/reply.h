#pragma once
// What a server's headers say, and whether that answers what was asked.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace voyager::http {

// Bytes first to last, both included, as HTTP counts.
struct ByteRange {
  uint64_t first, last;
  uint64_t size() const { return last - first + 1; }
};

struct ContentRange {
  std::optional<ByteRange> range;  // absent: none of it could be served ("bytes */N")
  uint64_t size;                   // of the whole file
};

// "bytes F-L/N" or "bytes */N" with F <= L < N; nothing else.
std::optional<ContentRange> parse_content_range(std::string_view text);

// The headers of one answer, line by line.
class ReplyHead {
 public:
  // A status line starts over, so that after redirects it is the last answer that counts.
  void add_line(std::string_view line);

  // Is it neither informational nor a redirection?
  bool is_final() const;

  long status = 0;
  // "" where the header is absent.
  std::string content_range, content_length, content_encoding, etag, last_modified, location;
};

// Which version of a file an answer has bytes of.
struct FileVersion {
  uint64_t size = 0;
  std::string etag, last_modified;  // "" where the server has none
};

struct Accepted {
  FileVersion version;
  uint64_t body;  // bytes that follow
};

// Throws unless `head` answers a request for `asked`: with those bytes and no others, cut off at
// the end of the file, as they are stored. `known` is the version that earlier answers had, NULL
// for the first: an answer of another one is refused, so that two versions never mix. `name` is
// what messages call the file.
//   Error(io_transient)    408, 425, 429, 500, 502, 503, 504
//   Error(file_not_found)  404, 410
//   Error(io)              401, 403, 407, 451; another version of the file
//   Error(refused_input)   all else: ranges ignored, a wrong Content-Range, ...
Accepted check_reply(const std::string& name, const ReplyHead& head, const ByteRange& asked,
                     const FileVersion* known);

}  // namespace voyager::http
