#pragma once
// Tests that need a Vulkan device, or its validation layer, skip where there is none; with
// VOYAGER_REQUIRE_VULKAN set, as scripts/test.sh sets it, they fail.
#include <gtest/gtest.h>

#include <cstdlib>

#define VOYAGER_SKIP_WITHOUT_VULKAN(reason)                                         \
  do {                                                                              \
    if (std::getenv("VOYAGER_REQUIRE_VULKAN") == nullptr) GTEST_SKIP() << (reason); \
    FAIL() << (reason) << ": VOYAGER_REQUIRE_VULKAN asks for it";                   \
  } while (false)
