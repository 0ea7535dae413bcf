#pragma once
// One of everything, what a hostile call should answer, and a frame at the end
// to show that nothing broke.
#include <limits>

#include "host.h"

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInf = std::numeric_limits<double>::infinity();

class Hostile : public ::testing::Test {
 protected:
  ~Hostile() override { EXPECT_EQ(host.render(), VOY_SUCCESS) << voy.message(); }
  void expect_refused(VoyResult found, VoyResult expected, const char* part) {
    EXPECT_EQ(found, expected) << voy.message();
    EXPECT_NE(voy.message().find(part), std::string::npos) << voy.message();
  }
  void expect_invalid(VoyResult found, const char* part) {
    expect_refused(found, VOY_ERROR_INVALID_ARGUMENT, part);
  }
  VoyResult create_view(const VoyViewDesc& desc) {
    VoyView made = nullptr;
    const VoyResult result = voy.CreateView(host.device, &desc, &made);
    EXPECT_EQ(result == VOY_SUCCESS, made != nullptr);
    EXPECT_EQ(voy.DestroyView(made), VOY_SUCCESS);
    return result;
  }
  VoyResult create_target(const VoyTargetDesc& desc) {
    VoyTarget made = nullptr;
    const VoyResult result = voy.CreateTarget(host.device, &desc, &made);
    EXPECT_EQ(result == VOY_SUCCESS, made != nullptr);
    EXPECT_EQ(voy.DestroyTarget(made), VOY_SUCCESS);
    return result;
  }
  VoyResult create_device(const VoyDeviceDesc& desc) {
    VoyDevice made = nullptr;
    const VoyResult result = voy.CreateDevice(&desc, &made);
    EXPECT_EQ(voy.DestroyDevice(made), VOY_SUCCESS);
    return result;
  }

  Library voy;
  Host host{voy};
};

// What a host in C can hand over; to read it is what a sanitizer reports.
template <class Enum>
__attribute__((no_sanitize("enum"))) Enum bad_enum(int value) {
  Enum bad;
  std::memcpy(&bad, &value, sizeof bad);
  return bad;
}
