# Toolchain file for 64-bit Arm Linux (NVIDIA Orin among them), with the
# distribution's cross compiler; programs run here under qemu-user.
# VOYAGER_AARCH64_SYSROOT is the target's file system, or as much of it as the
# libraries need: by default what scripts/setup_aarch64.sh unpacks.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

if(NOT VOYAGER_AARCH64_SYSROOT)
  get_filename_component(VOYAGER_AARCH64_SYSROOT
    ${CMAKE_CURRENT_LIST_DIR}/../build/aarch64-sysroot ABSOLUTE)
endif()
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VOYAGER_AARCH64_SYSROOT)
set(CMAKE_SYSROOT ${VOYAGER_AARCH64_SYSROOT})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L ${CMAKE_SYSROOT})

# Nothing of this machine but its programs.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
