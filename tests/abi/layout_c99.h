#pragma once
/* C99 and C++. */
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A struct (field is "") or one of its fields; bytes. */
struct LayoutRow {
  const char* structure;
  const char* field;
  size_t offset, size;
};
extern const struct LayoutRow kLayout[];
extern const size_t kLayoutCount;

#ifdef __cplusplus
}
#endif
