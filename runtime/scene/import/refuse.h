#pragma once
// The shape of every refusal: file, place, found, expected.
#include <cstdint>
#include <string>

#include "runtime/base/error.h"

namespace voyager {

[[noreturn]] inline void refuse(const std::string& file, uint64_t offset, const std::string& field,
                                const std::string& found, const std::string& expected) {
  throw Error(ErrorCode::refused_input, file + ": offset " + std::to_string(offset) + ": " + field +
                                            ": found " + found + ", expected " + expected);
}

}  // namespace voyager
