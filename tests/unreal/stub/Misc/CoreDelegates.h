#pragma once
#include <map>

#include "CoreMinimal.h"

class FSimpleMulticastDelegate {
 public:
  template <class T>
  void AddRaw(T* Object, void (T::*Function)()) {
    Functions.emplace(Object, [Object, Function] { (Object->*Function)(); });
  }
  void RemoveAll(const void* Object) { Functions.erase(Object); }
  void Broadcast() const {
    for (const auto& [Object, Function] : Functions) Function();
  }

 private:
  std::multimap<const void*, std::function<void()>> Functions;
};

struct FCoreDelegates {
  static FSimpleMulticastDelegate OnEnginePreExit;
};
