#pragma once
// Parts of Voyager that live in shared libraries of their own, because what they need is not on
// every machine.
#include <cstddef>
#include <string>

#include "runtime/base/error.h"

namespace voyager {

// This build's stamp: version, compiler, and the size of a type that both sides share.
std::string module_stamp(size_t shared_type_bytes);

// What libvoyager_NAME.so exports as `symbol`: a struct whose first member is `const char*
// stamp`. The library is looked for beside the caller's library or program (and in ../lib
// beside it), else where the system looks, and stays loaded for good. Thread-safe. Throws
// Error(failure) where there is none, or one of another stamp, with the reason.
const void* open_module(const std::string& name, const char* symbol, const std::string& stamp,
                        ErrorCode failure);

}  // namespace voyager
