#pragma once
#include <string>

namespace test_runtime {

// One of the API that this runtime has, an extension's included.
bool is_function(const std::string& name);

}  // namespace test_runtime
