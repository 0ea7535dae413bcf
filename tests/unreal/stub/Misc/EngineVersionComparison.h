#pragma once
// The version that the stub imitates.
#ifndef STUB_ENGINE_MINOR_VERSION
#define STUB_ENGINE_MINOR_VERSION 8
#endif
#define UE_VERSION_OLDER_THAN(Major, Minor, Patch) \
  (5 < (Major) || (5 == (Major) && STUB_ENGINE_MINOR_VERSION < (Minor)))
