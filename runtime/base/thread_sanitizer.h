#pragma once
// ThreadSanitizer does not see how oneTBB's own code, which is not built with it, orders the
// tasks of a loop. These say it: what came before the loop happens before each task, and each
// task before what comes after. Nothing in other builds.

#if defined(__SANITIZE_THREAD__)
#define VOYAGER_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define VOYAGER_THREAD_SANITIZER 1
#endif
#endif

#ifdef VOYAGER_THREAD_SANITIZER
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace voyager {

// One loop, from before it begins until after it has ended.
class LoopOrder {
 public:
#ifdef VOYAGER_THREAD_SANITIZER
  LoopOrder() {
    __tsan_release(&begun_);
  }
  ~LoopOrder() {
    __tsan_acquire(&ended_);
  }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;
  void begin_task() {
    __tsan_acquire(&begun_);
  }
  void end_task() {
    __tsan_release(&ended_);
  }

 private:
  char begun_ = 0, ended_ = 0;
#else
  void begin_task() {}
  void end_task() {}
#endif
};

}  // namespace voyager
