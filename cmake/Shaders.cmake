# relief_shaders(TARGET DIRECTORY HEADER NAMESPACE): compiles DIRECTORY/*.comp to SPIR-V and adds it to the target as
# NAMESPACE::find_shader, which HEADER declares.
find_program(RELIEF_GLSLC glslc REQUIRED)
find_package(Python3 REQUIRED COMPONENTS Interpreter)

function(relief_shaders target directory header namespace)
  file(GLOB shaders CONFIGURE_DEPENDS ${directory}/*.comp)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders)
  file(MAKE_DIRECTORY ${folder})
  set(compiled)
  foreach(shader IN LISTS shaders)
    get_filename_component(name ${shader} NAME_WE)
    add_custom_command(OUTPUT ${folder}/${name}.spv
      COMMAND ${RELIEF_GLSLC} --target-env=vulkan1.3 -O -Werror -I ${PROJECT_SOURCE_DIR}/src
              -MD -MF ${folder}/${name}.d -MT ${folder}/${name}.spv -o ${folder}/${name}.spv ${shader}
      MAIN_DEPENDENCY ${shader} DEPFILE ${folder}/${name}.d VERBATIM)
    list(APPEND compiled ${folder}/${name}.spv)
  endforeach()
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_shaders.py)
  add_custom_command(OUTPUT ${folder}/shaders.cpp
    COMMAND Python3::Interpreter ${script} ${folder}/shaders.cpp ${header} ${namespace} ${compiled}
    DEPENDS ${compiled} ${script} VERBATIM)
  target_sources(${target} PRIVATE ${folder}/shaders.cpp)
endfunction()
