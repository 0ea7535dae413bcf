# ccache if it is installed and no other launcher was asked for.
find_program(VOYAGER_CCACHE ccache)
if(VOYAGER_CCACHE)
  foreach(language C CXX CUDA)
    if(NOT DEFINED CMAKE_${language}_COMPILER_LAUNCHER)
      set(CMAKE_${language}_COMPILER_LAUNCHER ${VOYAGER_CCACHE})
    endif()
  endforeach()
endif()

# One INTERFACE target carries warnings and the floating-point contract of
# every target: no contraction (METHOD §3, §6: the cut predicate and the sort key
# are exact binary32), no fast-math anywhere.
add_library(voyager_options INTERFACE)
target_compile_options(voyager_options INTERFACE
  -ffp-contract=off
  -Wall -Wextra -Wpedantic -Wshadow
  # GCC 12 warns of overlapping copies inside its own std::string operator+ (GCC PR 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual>)
if(VOYAGER_WERROR)
  target_compile_options(voyager_options INTERFACE -Werror)
endif()
if(VOYAGER_SANITIZE)
  add_compile_options(-fsanitize=${VOYAGER_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${VOYAGER_SANITIZE})
  # GCC 12 under a sanitizer warns of what its own std::regex leaves unset (GCC PR 105562).
  target_compile_options(voyager_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
if(VOYAGER_BUILD_FUZZERS)  # every library tells the fuzzer which of its edges an input reaches
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()
