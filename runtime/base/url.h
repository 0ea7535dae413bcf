#pragma once
#include <string>
#include <string_view>

namespace voyager {

// Does it begin with http:// or https://, in any case?
bool is_url(std::string_view path);

// As a message or a report may show it. Of a URL: without user, password, query and fragment,
// any of which may be a secret; other paths are as they are.
std::string shown_path(std::string_view path);

}  // namespace voyager
