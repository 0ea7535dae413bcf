# `cpack` makes a .deb of each component and one relocatable .tar.gz of all.
set(CPACK_GENERATOR TGZ)
if(NOT CMAKE_CROSSCOMPILING)  # dpkg-shlibdeps asks this machine's packages
  list(APPEND CPACK_GENERATOR DEB)
endif()
set(CPACK_SOURCE_GENERATOR "")
set(CPACK_PACKAGE_CONTACT "Voyager contributors")
set(CPACK_PACKAGE_FILE_NAME voyager-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_STRIP_FILES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Where the tools' libvoyager.so is.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

function(voyager_package component name section description)
  string(TOUPPER ${component} key)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_COMPONENT_${key}_DESCRIPTION "This package has ${description}." PARENT_SCOPE)
  set(CPACK_COMPONENT_${key}_DEPENDS ${ARGN} PARENT_SCOPE)
endfunction()
voyager_package(runtime libvoyager${VOYAGER_SERIES} libs "the library")
voyager_package(development libvoyager-dev libdevel "headers, CMake and pkg-config packages" runtime)
voyager_package(tools voyager-tools graphics "the command line" runtime)
voyager_package(http libvoyager-http libs "the module that reads http:// and https://" runtime)
voyager_package(sog libvoyager-sog libs "the module that reads and writes SOG scenes" runtime)
voyager_package(cuda libvoyager-cuda libs "the module that draws on NVIDIA GPUs" runtime)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "libvoyager-http, libvoyager-sog")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS libvoyager-cuda)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS libvulkan-dev)  # voyager_vulkan.h includes Vulkan's header

include(CPack)
