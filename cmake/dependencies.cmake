# What each part needs, from the distribution (scripts/setup.sh installs it, in parts). What is missing
# is listed once, with the package that brings it.
set_property(GLOBAL PROPERTY VOYAGER_MISSING "")

# voyager_needs(PART PACKAGE VARIABLE...): a VARIABLE that is false means that PACKAGE is missing.
function(voyager_needs part package)
  foreach(found ${ARGN})
    if(NOT ${found})
      set_property(GLOBAL APPEND_STRING PROPERTY VOYAGER_MISSING "  ${package}, for ${part}\n")
      return()
    endif()
  endforeach()
endfunction()

include(cmake/dependencies_library.cmake)
if(VOYAGER_BUILD_TOOLS)
  include(cmake/dependencies_tools.cmake)
endif()
if(VOYAGER_BUILD_SAMPLES)
  include(cmake/dependencies_samples.cmake)
endif()
if(VOYAGER_BUILD_TESTS)
  find_package(GTest QUIET)
  voyager_needs("the tests" libgtest-dev GTest_FOUND)
endif()
if(VOYAGER_BUILD_BENCH)
  find_package(benchmark QUIET)
  find_package(Vulkan QUIET)
  voyager_needs("the benchmarks" libbenchmark-dev benchmark_FOUND)
  voyager_needs("the benchmarks" libvulkan-dev Vulkan_FOUND)
endif()

get_property(missing GLOBAL PROPERTY VOYAGER_MISSING)
if(missing)
  message(FATAL_ERROR "These packages of Debian and Ubuntu were not found:\n${missing}"
    "Install them, or leave out what needs them with -DVOYAGER_BUILD_BENCH=OFF, -DVOYAGER_BUILD_TESTS=OFF, "
    "-DVOYAGER_BUILD_SAMPLES=OFF or -DVOYAGER_BUILD_TOOLS=OFF. "
    "scripts/setup.sh installs those of the library and the tools, scripts/setup.sh samples also those of the samples, "
    "scripts/setup.sh tests those of both and of the tests, scripts/setup.sh bench those of the benchmarks.")
endif()
