#pragma once
#include "RHI.h"

class FRHICommandListBase {};

// Commands are kept until the list is executed.
class FRHICommandListImmediate : public FRHICommandListBase {
 public:
  void EnqueueLambda(TFunction<void(FRHICommandListImmediate&)> Command) {
    Commands.push_back(std::move(Command));
  }
  void WriteGPUFence(const FGPUFenceRHIRef& Fence) { Fences.push_back(Fence); }

  void StubExecute() {
    for (auto& Command : Commands) Command(*this);
    Commands.clear();
  }
  std::vector<FGPUFenceRHIRef> Fences;  // written by these commands

 private:
  std::vector<TFunction<void(FRHICommandListImmediate&)>> Commands;
};
