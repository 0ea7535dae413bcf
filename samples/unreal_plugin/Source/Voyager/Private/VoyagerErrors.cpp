#include "VoyagerErrors.h"

DEFINE_LOG_CATEGORY_STATIC(LogVoyager, Log, All);

void FVoyagerErrors::Report(const FString& Message) {
  FScopeLock Lock(&Mutex);
  if (Message == Last) return;
  Last = Message;
  UE_LOG(LogVoyager, Error, TEXT("%s"), *Message);
}
