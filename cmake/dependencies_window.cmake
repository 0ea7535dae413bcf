# Of a window with Vulkan, which the samples and `voyager view` open.
find_package(Vulkan QUIET)
find_package(glm QUIET)
find_package(glfw3 QUIET)
find_path(IMGUI_INCLUDE_DIR imgui.h PATH_SUFFIXES imgui)
find_library(IMGUI_LIBRARY imgui)
find_library(STB_LIBRARY stb)  # which the distribution's imgui is built on
