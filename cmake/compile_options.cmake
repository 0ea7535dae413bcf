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
endif()
