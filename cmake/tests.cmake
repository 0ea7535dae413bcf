# voyager_test_program(NAME SOURCES FILE... LINK TARGET... [LABELS LABEL...] [NEEDS TARGET...] [ONE_ENTRY]):
# one GoogleTest program called NAME_tests, and one CTest entry called NAME.SUITE for each suite in it. A suite's
# cases run in one process: they make a scene once, and state that they leave behind cannot affect another suite. ONE_ENTRY
# makes a single entry of the program, called NAME. NEEDS names what the tests run or load without linking it.
# Each entry writes test_results/ENTRY.xml, which scripts/summarise_tests.py reads.
function(voyager_test_program name)
  cmake_parse_arguments(ARG "ONE_ENTRY" "" "SOURCES;LINK;LABELS;NEEDS" ${ARGN})
  set(target ${name}_tests)
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_LINK} GTest::gtest_main voyager_options)
  target_compile_definitions(${target} PRIVATE
    VOYAGER_SOURCE_DIR="${PROJECT_SOURCE_DIR}" VOYAGER_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  if(ARG_NEEDS)
    add_dependencies(${target} ${ARG_NEEDS})
  endif()
  if(ARG_ONE_ENTRY)
    voyager_test_entry(${name} "${name};${ARG_LABELS}" ${target})
    return()
  endif()
  voyager_suites(suites ${ARG_SOURCES})
  foreach(suite ${suites})
    voyager_test_entry(${name}.${suite} "${name};${ARG_LABELS}" ${target} --gtest_filter=${suite}.*:*/${suite}.*)
  endforeach()
endfunction()

function(voyager_test_entry name labels)
  add_test(NAME ${name} COMMAND ${ARGN})
  set_tests_properties(${name} PROPERTIES
    LABELS "${labels}" ENVIRONMENT GTEST_OUTPUT=xml:${PROJECT_BINARY_DIR}/test_results/${name}.xml)
endfunction()

# The names of the suites that the sources define, each once, in order.
function(voyager_suites result)
  set(suites "")
  foreach(source ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} lines REGEX "^(TEST|TEST_F|TEST_P)\\(")
    foreach(line ${lines})
      string(REGEX REPLACE "^[A-Z_]+\\(([A-Za-z0-9_]+).*" "\\1" suite "${line}")
      list(APPEND suites ${suite})
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES suites)
  set(${result} ${suites} PARENT_SCOPE)
endfunction()
