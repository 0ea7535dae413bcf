# What is built. Each part looks for its own dependencies only (dependencies.cmake).
option(VOYAGER_BUILD_TOOLS "Build the command line, voyager" ON)
option(VOYAGER_BUILD_SAMPLES "Build the sample hosts for Vulkan and OpenXR" ON)
set(VOYAGER_CUDA AUTO CACHE STRING "Build the CUDA module: AUTO (where nvcc is found), ON or OFF")
set(VOYAGER_HTTP AUTO CACHE STRING "Build the HTTP module: AUTO (where libcurl is found), ON or OFF")
set(VOYAGER_SOG AUTO CACHE STRING "Build the SOG module: AUTO (where libwebp and libzip are found), ON or OFF")

# The tests run the tools and the samples, and the benchmarks use the tools' cameras and statistics.
set(tests_default ${VOYAGER_BUILD_TOOLS})
if(NOT VOYAGER_BUILD_SAMPLES)
  set(tests_default OFF)
endif()
option(VOYAGER_BUILD_TESTS "Build the tests; needs the tools and the samples" ${tests_default})
option(VOYAGER_BUILD_BENCH "Build the benchmarks; needs the tools" OFF)
option(VOYAGER_BUILD_FUZZERS "Build the fuzz targets with libFuzzer (clang); needs the tests" OFF)

option(VOYAGER_WERROR "Treat warnings as errors" OFF)
set(VOYAGER_SANITIZE "" CACHE STRING "Sanitizers for the whole build, as -fsanitize takes them")

function(voyager_option_needs option)
  foreach(needed ${ARGN})
    if(${option} AND NOT ${needed})
      message(FATAL_ERROR "${option}=ON: found ${needed}=OFF, expected ON. Set both ON, or both OFF.")
    endif()
  endforeach()
endfunction()
voyager_option_needs(VOYAGER_BUILD_TESTS VOYAGER_BUILD_TOOLS VOYAGER_BUILD_SAMPLES)
voyager_option_needs(VOYAGER_BUILD_BENCH VOYAGER_BUILD_TOOLS)
voyager_option_needs(VOYAGER_BUILD_FUZZERS VOYAGER_BUILD_TESTS)

# voyager_leave_out(OPTION WHAT WHY): says so where OPTION is AUTO or OFF, and stops where it is ON.
# From then on the variable OPTION is ON or OFF: whether the part is built.
macro(voyager_leave_out option what why)
  if(${option} STREQUAL "ON")
    message(FATAL_ERROR "${option}=ON: ${why}")
  endif()
  message(STATUS "${what}: left out (${why})")
  set(${option} OFF)
endmacro()

foreach(option VOYAGER_CUDA VOYAGER_HTTP VOYAGER_SOG)
  set_property(CACHE ${option} PROPERTY STRINGS AUTO ON OFF)
  string(TOUPPER "${${option}}" ${option})
  string(REGEX REPLACE "^(1|YES|TRUE|Y)$" ON ${option} "${${option}}")
  string(REGEX REPLACE "^(0|NO|FALSE|N)$" OFF ${option} "${${option}}")
  if(NOT ${option} MATCHES "^(AUTO|ON|OFF)$")
    message(FATAL_ERROR "${option}: found \"${${option}}\", expected AUTO, ON or OFF")
  endif()
endforeach()
