# voyager_shaders(TARGET FILE...): compiles each GLSL file to SPIR-V in a header that TARGET
# can include by the file's name: composite.vert is "composite.vert.h", an array of uint32_t
# called composite_vert. The stage is told from the extension.

# All of them; what reads the sources without building them needs these headers.
add_custom_target(shader_headers)

function(voyager_shaders target)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders)
  file(MAKE_DIRECTORY ${folder})
  foreach(file ${ARGN})
    get_filename_component(source ${file} ABSOLUTE)
    get_filename_component(name ${file} NAME)
    string(MAKE_C_IDENTIFIER ${name} variable)
    set(header ${folder}/${name}.h)
    add_custom_command(OUTPUT ${header}
      COMMAND ${VOYAGER_GLSLANG} --quiet --target-env vulkan1.1 --depfile ${header}.d
              --vn ${variable} -o ${header} ${source}
      DEPENDS ${source} DEPFILE ${header}.d VERBATIM COMMENT "SPIR-V of ${name}")
    target_sources(${target} PRIVATE ${header})
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(${target}_shader_headers DEPENDS ${headers})
  add_dependencies(shader_headers ${target}_shader_headers)
  target_include_directories(${target} PRIVATE ${folder})
endfunction()
