#pragma once
#ifdef __cplusplus
extern "C" {
#endif

/* Draws `scene`, a file, as a host does that was compiled against kept headers. NULL, or what went
 * wrong. */
const char* run_kept_host(const char* scene);

#ifdef __cplusplus
}
#endif
