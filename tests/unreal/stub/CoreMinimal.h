#pragma once
// What samples/unreal_plugin uses of Unreal's Core, written from Unreal's public documentation:
// names and signatures, with the least that a test needs behind them.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

using int32 = int32_t;
using uint8 = uint8_t;
using uint32 = uint32_t;
using uint64 = uint64_t;
using ANSICHAR = char;
using UTF8CHAR = char8_t;
using TCHAR = char16_t;
#define TEXT_PASTE(x) u##x
#define TEXT(x) TEXT_PASTE(x)

constexpr int32 INDEX_NONE = -1;

template <class T>
void Swap(T& A, T& B) {
  std::swap(A, B);
}

namespace FMath {
template <class T>
T Max(T A, T B) {
  return A < B ? B : A;
}
}  // namespace FMath

// ------------------------------------------------------------------------ text

std::string Narrow(const TCHAR* Text);          // the stub's own: UTF-16 to UTF-8
std::u16string Widen(const std::string& Text);  // the stub's own

class FString {
 public:
  FString() = default;
  FString(const TCHAR* In) : Text(In) {}
  bool IsEmpty() const { return Text.empty(); }
  const TCHAR* operator*() const { return Text.c_str(); }
  FString operator+(const FString& Other) const { return (Text + Other.Text).c_str(); }
  bool operator==(const FString& Other) const { return Text == Other.Text; }

  // %d takes an int32 and %s a const TCHAR*.
  template <class... Args>
  static FString Printf(const TCHAR* Format, Args... Values) {
    const std::string Narrowed = Narrow(Format);
    char Out[512];
    std::snprintf(Out, sizeof Out, Narrowed.c_str(), Printable(Values)...);
    return Widen(Out).c_str();
  }

 private:
  static int32 Printable(int32 Value) { return Value; }
  static const char* Printable(const TCHAR* Value) {
    thread_local std::string Kept;
    return (Kept = Narrow(Value)).c_str();
  }
  std::u16string Text;
};

class FAnsiString {
 public:
  FAnsiString(const ANSICHAR* In) : Text(In) {}
  const ANSICHAR* operator*() const { return Text.c_str(); }

 private:
  std::string Text;
};

template <class To>
struct TStringConversion {
  std::string Text;
  const To* Get() const { return reinterpret_cast<const To*>(Text.c_str()); }
};
template <class To>
TStringConversion<To> StringCast(const TCHAR* Text) {
  return {Narrow(Text)};
}
#define UTF8_TO_TCHAR(Text) (Widen(Text).c_str())

#define DEFINE_LOG_CATEGORY_STATIC(Category, Default, Compiled) \
  static constexpr const char* Category [[maybe_unused]] = #Category
void StubLog(const char* Category, const FString& Line);
#define UE_LOG(Category, Verbosity, Format, ...) \
  StubLog(Category, FString::Printf(Format, __VA_ARGS__))

// ------------------------------------------------------------------ containers

template <class T>
class TArray {
 public:
  int32 Num() const { return static_cast<int32>(Items.size()); }
  const T* GetData() const { return Items.data(); }
  void Add(const T& Item) { Items.push_back(Item); }
  template <class Predicate>
  void RemoveAll(Predicate&& Matches) {
    std::erase_if(Items, Matches);
  }
  auto begin() const { return Items.begin(); }
  auto end() const { return Items.end(); }

 private:
  std::vector<T> Items;
};

template <class T>
class TArrayView {
 public:
  TArrayView() = default;
  TArrayView(T* InData, int32 InCount) : Data(InData), Count(InCount) {}
  int32 Num() const { return Count; }
  T& operator[](int32 Index) const { return Data[Index]; }

 private:
  T* Data = nullptr;
  int32 Count = 0;
};

template <class Signature>
using TFunction = std::function<Signature>;

enum class ESPMode { NotThreadSafe, ThreadSafe };

template <class T, ESPMode Mode = ESPMode::ThreadSafe>
class TSharedPtr {
 public:
  TSharedPtr() = default;
  TSharedPtr(std::nullptr_t) {}
  explicit TSharedPtr(std::shared_ptr<T> In) : Pointer(std::move(In)) {}
  bool IsValid() const { return Pointer != nullptr; }
  explicit operator bool() const { return IsValid(); }
  T* operator->() const { return Pointer.get(); }
  T& operator*() const { return *Pointer; }
  void Reset() { Pointer.reset(); }
  std::weak_ptr<T> StubWeak() const { return Pointer; }

 private:
  std::shared_ptr<T> Pointer;
};
template <class T, ESPMode Mode = ESPMode::ThreadSafe>
using TSharedRef = TSharedPtr<T, Mode>;

template <class T, class... Args>
TSharedPtr<T> MakeShared(Args&&... Values) {
  return TSharedPtr<T>(std::make_shared<T>(std::forward<Args>(Values)...));
}
template <class T>
TSharedPtr<T> MakeShareable(T* Object) {
  return TSharedPtr<T>(std::shared_ptr<T>(Object));
}

class FCriticalSection {
 public:
  void Lock() { Mutex.lock(); }
  void Unlock() { Mutex.unlock(); }

 private:
  std::mutex Mutex;
};

// ----------------------------------------------------------------- mathematics

struct FVector {
  double X, Y, Z;
  FVector() = default;
  FVector(double InX, double InY, double InZ) : X(InX), Y(InY), Z(InZ) {}
};

// Row vectors: a point is multiplied from the left.
struct FMatrix {
  double M[4][4];
};

struct FIntPoint {
  int32 X, Y;
  FIntPoint() = default;
  FIntPoint(int32 InX, int32 InY) : X(InX), Y(InY) {}
  bool operator==(const FIntPoint& Other) const = default;
};

struct FIntRect {
  FIntPoint Min, Max;
  FIntRect() = default;
  FIntRect(int32 X0, int32 Y0, int32 X1, int32 Y1) : Min(X0, Y0), Max(X1, Y1) {}
  bool operator==(const FIntRect& Other) const = default;
  int32 Width() const { return Max.X - Min.X; }
  int32 Height() const { return Max.Y - Min.Y; }
  FIntPoint Size() const { return {Width(), Height()}; }
};
