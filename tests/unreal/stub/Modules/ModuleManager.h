#pragma once
#include "CoreMinimal.h"

class IModuleInterface {
 public:
  virtual ~IModuleInterface() = default;
  virtual void StartupModule() {}
  virtual void ShutdownModule() {}
};

class FModuleManager {
 public:
  template <class T>
  static T& LoadModuleChecked(const TCHAR* Name) {
    return static_cast<T&>(*FindModule(Name));
  }

 private:
  static IModuleInterface* FindModule(const TCHAR* Name);
};

#define IMPLEMENT_MODULE(Class, Name)        \
  IModuleInterface* StubInitialize##Name();  \
  IModuleInterface* StubInitialize##Name() { \
    return new Class();                      \
  }
