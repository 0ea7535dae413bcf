// What libvoyager_http.so exports.
#include <algorithm>
#include <cstring>

#include "http/source.h"
#include "runtime/base/http_module.h"
#include "runtime/base/module.h"

namespace voyager::http {
namespace {

ByteSource* open(const char* url, ErrorCode* code, char* message, size_t size) {
  std::string what;
  try {
    return new Source(url, options_of_environment());
  } catch (const Error& error) {
    *code = error.code();
    what = error.what();
  } catch (const std::exception& error) {
    *code = ErrorCode::internal;
    what = error.what();
  }
  const size_t length = std::min(size - 1, what.size());
  std::memcpy(message, what.data(), length);
  message[length] = '\0';
  return nullptr;
}

const char* stamp() {
  static const std::string text = module_stamp(sizeof(HttpModule));
  return text.c_str();
}

}  // namespace
}  // namespace voyager::http

extern "C" __attribute__((visibility("default")))
const voyager::HttpModule voyager_http_module = {voyager::http::stamp(), voyager::http::open};
