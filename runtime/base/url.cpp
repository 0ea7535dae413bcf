#include "runtime/base/url.h"

#include <algorithm>

namespace voyager {
namespace {

// Bytes of http:// or https:// at the start; 0 where there is neither.
size_t scheme_length(std::string_view path) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    const auto same = [](char a, char b) {
      return b == (a >= 'A' && a <= 'Z' ? static_cast<char>(a + ('a' - 'A')) : a);
    };
    if (path.size() >= scheme.size() && std::equal(scheme.begin(), scheme.end(), path.begin(),
                                                   [&](char b, char a) { return same(a, b); }))
      return scheme.size();
  }
  return 0;
}

// Nothing but digits behind the host's colon, if it has one: else a password with a slash in it
// would look like a host.
bool has_sound_port(std::string_view host) {
  const size_t name_end = host.rfind(']') == std::string_view::npos ? 0 : host.rfind(']');
  const size_t colon = host.find(':', name_end);
  if (colon == std::string_view::npos) return true;
  const std::string_view port = host.substr(colon + 1);
  return std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

bool is_url(std::string_view path) {
  return scheme_length(path) != 0;
}

std::string shown_path(std::string_view path) {
  const size_t scheme = scheme_length(path);
  if (scheme == 0) return std::string(path);
  const std::string_view rest = path.substr(scheme);
  const size_t host_end = std::min(rest.find_first_of("/?#"), rest.size());
  std::string_view host = rest.substr(0, host_end);
  if (const size_t at = host.rfind('@'); at != std::string_view::npos) host.remove_prefix(at + 1);
  if (!has_sound_port(host)) return std::string(path.substr(0, scheme)) + "(malformed)";
  const std::string_view after = rest.substr(host_end);
  return std::string(path.substr(0, scheme)) + std::string(host) +
         std::string(after.substr(0, after.find_first_of("?#")));
}

}  // namespace voyager
