#pragma once
// The last error, for all threads. Each new message is logged once: a frame that fails does so
// sixty times a second.
#include "CoreMinimal.h"
#include "Misc/ScopeLock.h"

class FVoyagerErrors {
 public:
  void Report(const FString& Message);
  FString GetLast() const {
    FScopeLock Lock(&Mutex);
    return Last;
  }

 private:
  mutable FCriticalSection Mutex;
  FString Last;
};
