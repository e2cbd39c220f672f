# relief_shaders(TARGET DIRECTORY HEADER NAMESPACE [VARIANTS NAME:SOURCE:DEFINITIONS...]): compiles DIRECTORY/*.comp to
# SPIR-V and adds it to the target as NAMESPACE::find_shader, which HEADER declares. A variant is SOURCE.comp under
# another name, with macros (A or A=1, separated by commas); a file that has variants is not compiled by itself.
find_program(RELIEF_GLSLC glslc REQUIRED)
find_package(Python3 REQUIRED COMPONENTS Interpreter)

# Adds the SPIR-V file to the list `compiled` of the caller.
function(relief_shader name source)
  list(TRANSFORM ARGN PREPEND -D OUTPUT_VARIABLE definitions)
  add_custom_command(OUTPUT ${folder}/${name}.spv
    COMMAND ${RELIEF_GLSLC} --target-env=vulkan1.3 -O -Werror -I ${PROJECT_SOURCE_DIR}/src ${definitions}
            -MD -MF ${folder}/${name}.d -MT ${folder}/${name}.spv -o ${folder}/${name}.spv ${source}
    MAIN_DEPENDENCY ${source} DEPFILE ${folder}/${name}.d VERBATIM)
  set(compiled ${compiled} ${folder}/${name}.spv PARENT_SCOPE)
endfunction()

function(relief_shaders target directory header namespace)
  cmake_parse_arguments(PARSE_ARGV 4 argument "" "" VARIANTS)
  file(GLOB shaders CONFIGURE_DEPENDS ${directory}/*.comp)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders)
  file(MAKE_DIRECTORY ${folder})
  set(compiled)
  foreach(variant IN LISTS argument_VARIANTS)
    string(REPLACE ":" ";" parts ${variant})
    list(POP_FRONT parts name source definitions)
    string(REPLACE "," ";" definitions "${definitions}")
    list(REMOVE_ITEM shaders ${directory}/${source}.comp)
    relief_shader(${name} ${directory}/${source}.comp ${definitions})
  endforeach()
  foreach(shader IN LISTS shaders)
    get_filename_component(name ${shader} NAME_WE)
    relief_shader(${name} ${shader})
  endforeach()
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_shaders.py)
  add_custom_command(OUTPUT ${folder}/shaders.cpp
    COMMAND Python3::Interpreter ${script} ${folder}/shaders.cpp ${header} ${namespace} ${compiled}
    DEPENDS ${compiled} ${script} VERBATIM)
  target_sources(${target} PRIVATE ${folder}/shaders.cpp)
endfunction()
