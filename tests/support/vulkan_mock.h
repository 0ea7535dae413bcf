#pragma once
// A Vulkan without a device: what the hand-off calls, with live objects, semaphore values and
// recorded commands on view. Any call that can fail can be made to. One at a time.
#include "tests/support/vulkan_mock_device.h"
#include "tests/support/vulkan_mock_table.h"
