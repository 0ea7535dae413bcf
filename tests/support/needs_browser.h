#pragma once
// Tests that need a browser skip where there is none; with VOYAGER_REQUIRE_BROWSER set, as
// scripts/test.sh sets it, they fail.
#include <gtest/gtest.h>

#include <cstdlib>

#define VOYAGER_SKIP_WITHOUT_BROWSER()                                                       \
  do {                                                                                       \
    if (std::getenv("VOYAGER_REQUIRE_BROWSER") == nullptr)                                   \
      GTEST_SKIP() << "no chromium-headless-shell or chromium: pages are not opened";        \
    FAIL() << "no chromium-headless-shell or chromium: VOYAGER_REQUIRE_BROWSER asks for it"; \
  } while (false)
