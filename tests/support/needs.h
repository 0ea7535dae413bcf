#pragma once
// What a machine may lack: VULKAN (a device, its validation layer), NGINX (with openssl), BROWSER,
// CUDA (a device), SCENES (the real ones), SPLAT_TRANSFORM (the program), NODE_PACKAGES (of npm). A
// test that lacks it skips and says why; where the environment has VOYAGER_REQUIRE_VULKAN and so
// on, it fails.
#include <gtest/gtest.h>

#include <cstdlib>

#define VOYAGER_SKIP_WITHOUT(what, reason)                                          \
  do {                                                                              \
    if (std::getenv("VOYAGER_REQUIRE_" #what) == nullptr) GTEST_SKIP() << (reason); \
    FAIL() << (reason) << ": VOYAGER_REQUIRE_" #what " asks for it";                \
  } while (false)
