# What `cmake --install` puts where: the components runtime, development, tools, http, sog and cuda.
# Nothing of it holds an absolute path, so that the folder may be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/voyager)

# The library finds its modules beside itself, and what it needs of others there, too. Files of the build folder have
# the installed ones' run path, because guides copy them from there.
install(TARGETS voyager EXPORT voyager
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set_target_properties(voyager PROPERTIES INSTALL_RPATH "$ORIGIN" BUILD_WITH_INSTALL_RPATH ON)
foreach(module http sog cuda)
  if(TARGET voyager_${module})
    install(TARGETS voyager_${module} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${module})
    set_target_properties(voyager_${module} PROPERTIES INSTALL_RPATH "$ORIGIN" BUILD_WITH_INSTALL_RPATH ON)
  endif()
endforeach()
# As the SONAME, so that packages of two versions share no file.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE COMPONENT runtime
  DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libvoyager${VOYAGER_SERIES})

if(VOYAGER_BUILD_TOOLS)
  file(RELATIVE_PATH library_folder ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  # The build folder has libraries in lib, whatever the installed ones' folder is called.
  set(run_path "$ORIGIN/${library_folder}" "$ORIGIN/../lib")
  list(REMOVE_DUPLICATES run_path)
  set_target_properties(voyager_tool PROPERTIES INSTALL_RPATH "${run_path}" BUILD_WITH_INSTALL_RPATH ON)
  install(TARGETS voyager_tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
endif()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/plugin/include/voyager
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")

# The exported target needs no other package, so that it is the package's configuration, whole.
install(EXPORT voyager NAMESPACE voyager:: FILE voyagerConfig.cmake
  DESTINATION ${cmake_folder} COMPONENT development)
# What voyager.h says of VOY_API_VERSION.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/voyagerConfigVersion.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/voyagerConfigVersion.cmake
  DESTINATION ${cmake_folder} COMPONENT development)

get_filename_component(prefix ${CMAKE_INSTALL_PREFIX} ABSOLUTE)
file(RELATIVE_PATH VOYAGER_PREFIX_FROM_PC ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${prefix})
string(REGEX REPLACE "/$" "" VOYAGER_PREFIX_FROM_PC ${VOYAGER_PREFIX_FROM_PC})
file(RELATIVE_PATH VOYAGER_LIBDIR ${prefix} ${CMAKE_INSTALL_FULL_LIBDIR})
file(RELATIVE_PATH VOYAGER_INCLUDEDIR ${prefix} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(voyager.pc.in ${CMAKE_CURRENT_BINARY_DIR}/voyager.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/voyager.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
