// What the library leaves in a process that loads it, and what it leaves alone.
#include <malloc.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>

#include "host.h"

namespace process_test {
namespace {

// A sanitizer counts memory and threads of its own, and takes two copies for two definitions.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

void draw_once(const Library& voy) {
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CPU);
  desc.workerThreadCount = 2;
  Host host(voy, desc, 50);
  EXPECT_EQ(host.render(), VOY_SUCCESS) << voy.message();
}

size_t entries(const char* folder) {
  const std::filesystem::directory_iterator all(folder);
  return static_cast<size_t>(std::distance(begin(all), end(all)));
}

size_t mappings() {
  std::ifstream maps("/proc/self/maps");
  return static_cast<size_t>(std::count(std::istreambuf_iterator<char>(maps), {}, '\n'));
}

TEST(Process, LoadingAndUnloadingAHundredTimesLeavesNothing) {
  if (kSanitized) GTEST_SKIP() << "built with a sanitizer";
  constexpr int kWarm = 10, kTimes = 100;
  constexpr size_t kSlack = 64 << 10;  // bytes of heap that others may have taken meanwhile
  size_t heap = 0, descriptors = 0, mapped = 0, threads = 0;
  for (int i = 0; i < kWarm + kTimes; ++i) {
    draw_once(Library());
    if (i != kWarm - 1) continue;
    heap = mallinfo2().uordblks;
    descriptors = entries("/proc/self/fd");
    mapped = mappings();
    threads = entries("/proc/self/task");  // a CUDA driver keeps some
  }
  EXPECT_FALSE(Library::is_mapped());
  EXPECT_LE(mallinfo2().uordblks, heap + kSlack);
  EXPECT_EQ(entries("/proc/self/fd"), descriptors);
  EXPECT_LE(mappings(), mapped + 4);
  EXPECT_EQ(entries("/proc/self/task"), threads) << "threads outlive the library";
}

TEST(Process, TwoCopiesOfTheLibraryKeepToThemselves) {
  if (kSanitized) GTEST_SKIP() << "built with a sanitizer";
  char folder[] = "/tmp/voyager_copy_XXXXXX";
  ASSERT_NE(::mkdtemp(folder), nullptr);
  const std::string copy = std::string(folder) + "/libvoyager.so";
  std::filesystem::copy_file(VOYAGER_LIBRARY, copy);
  {
    const Library first, second(copy.c_str());
    EXPECT_NE(first.GetVersion, second.GetVersion) << "it is one library, loaded once";
    Host a(first, device_for(VOY_BACKEND_CPU)), b(second, device_for(VOY_BACKEND_CPU));
    ASSERT_EQ(a.render(1), VOY_SUCCESS) << first.message();
    EXPECT_LT(first.SetViewTau(a.view, -1), 0);
    EXPECT_EQ(second.message(), "") << "the message of another copy";
    {
      Host other(second, device_for(VOY_BACKEND_CPU));
      ASSERT_EQ(other.render(1), VOY_SUCCESS) << second.message();
      EXPECT_EQ(other.pixels, a.pixels);
    }
    ASSERT_EQ(b.render(1), VOY_SUCCESS) << second.message();
    EXPECT_EQ(b.pixels, a.pixels);
    EXPECT_EQ(b.depth, a.depth);
  }
  std::filesystem::remove_all(folder);
}

// What belongs to the host, and to all of its threads.
struct Surroundings {
  Surroundings() {
    for (int number = 1; number < NSIG; ++number) {
      struct sigaction action = {};
      if (::sigaction(number, nullptr, &action) == 0) handlers[number] = action.sa_handler;
    }
    sigset_t mask;
    ::pthread_sigmask(SIG_SETMASK, nullptr, &mask);
    for (int number = 1; number < NSIG; ++number) blocked[number] = sigismember(&mask, number) == 1;
  }
  bool operator==(const Surroundings&) const = default;

  std::array<void (*)(int), NSIG> handlers = {};
  std::array<bool, NSIG> blocked = {};
  std::string locale = std::setlocale(LC_ALL, nullptr);
  locale_t thread_locale = ::uselocale(nullptr);
  std::string folder = std::filesystem::current_path().string();
  std::terminate_handler terminate = std::get_terminate();
  std::new_handler new_handler = std::get_new_handler();
};

TEST(Process, SignalsLocaleAndHandlersStayTheHosts) {
  const Surroundings before;
  {
    const Library voy;
    EXPECT_TRUE(before == Surroundings()) << "loading changed them";
    draw_once(voy);
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.path = "http://";  // asks the module for HTTP, where it is built
    Host host(voy, device_for(VOY_BACKEND_CPU));
    VoyScene scene = nullptr;
    EXPECT_LT(voy.OpenScene(host.device, &desc, &scene), 0);
    EXPECT_TRUE(before == Surroundings()) << "drawing changed them";
  }
  EXPECT_TRUE(before == Surroundings()) << "unloading changed them";
}

}  // namespace
}  // namespace process_test
