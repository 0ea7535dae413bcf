// What lives as long as the library is mapped, and how it goes at dlclose.
#include <dlfcn.h>
#include <tbb/global_control.h>
#include <tbb/version.h>

#include <new>

#include "plugin/handles.h"

namespace voyager {
namespace {

// Other threads of the host keep oneTBB's per-thread state after they called us,
// with a destructor inside libtbb: that library may not vanish with ours.
void pin_tbb() {
  Dl_info where = {};
  if (dladdr(reinterpret_cast<void*>(&TBB_runtime_version), &where) != 0)
    dlopen(where.dli_fname, RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
}

// oneTBB 2021.5 (Ubuntu 22.04) has it as a preview (CMakeLists.txt), under another name.
tbb::task_scheduler_handle scheduler_handle() {
#if TBB_INTERFACE_VERSION < 12060
  return tbb::task_scheduler_handle::get();
#else
  return tbb::task_scheduler_handle(tbb::attach{});
#endif
}

// Joins oneTBB's workers where nobody else in the process uses them, so that none
// is still returning through our code when it is unmapped.
class TbbThreads {
 public:
  TbbThreads() : handle_(scheduler_handle()) { pin_tbb(); }
  ~TbbThreads() { tbb::finalize(handle_, std::nothrow); }
  TbbThreads(const TbbThreads&) = delete;
  TbbThreads& operator=(const TbbThreads&) = delete;

 private:
  tbb::task_scheduler_handle handle_;
};

// In this order: the objects that the host left go before the threads.
struct Library {
  TbbThreads threads;
  HandleTable table;
};

}  // namespace

HandleTable& HandleTable::instance() {
  static Library library;
  return library.table;
}

}  // namespace voyager
