#pragma once
// Tests that need nginx or openssl's command skip where there is none; with VOYAGER_REQUIRE_NGINX
// set, as scripts/test.sh sets it, they fail.
#include <gtest/gtest.h>

#include <cstdlib>

#define VOYAGER_SKIP_WITHOUT_NGINX(reason)                                         \
  do {                                                                             \
    if (std::getenv("VOYAGER_REQUIRE_NGINX") == nullptr) GTEST_SKIP() << (reason); \
    FAIL() << (reason) << ": VOYAGER_REQUIRE_NGINX asks for it";                   \
  } while (false)
