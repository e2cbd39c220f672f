# relief_shaders(TARGET DIRECTORY HEADER NAMESPACE [VARIANTS NAME:SOURCE:DEFINITIONS...] [FULL_SCREEN NAME...]
# [OPTIMISED NAME...]): compiles the shaders of DIRECTORY to SPIR-V and adds them to the target as NAMESPACE::find_shader,
# which HEADER declares. A variant is SOURCE.comp under another name, with macros (A or A=1, separated by commas); a file
# that has variants is not compiled by itself. The compute shaders and variants named after FULL_SCREEN are also there as
# fragment shaders, NAME_fragment. Drivers optimise by themselves, and better: behind glslc -O the variables of inlined
# functions keep their registers from one turn of a loop to the next. Those named after OPTIMISED get it all the same:
# without it drivers take long to read them.
find_program(RELIEF_GLSLC glslc REQUIRED)
find_package(Python3 REQUIRED COMPONENTS Interpreter)

# relief_shader(NAME SOURCE FLAGS...) adds the SPIR-V file to the list `compiled` of the caller.
function(relief_shader name source)
  add_custom_command(OUTPUT ${folder}/${name}.spv
    COMMAND ${RELIEF_GLSLC} --target-env=vulkan1.3 -std=460 -Werror -I ${PROJECT_SOURCE_DIR}/src ${ARGN}
            -MD -MF ${folder}/${name}.d -MT ${folder}/${name}.spv -o ${folder}/${name}.spv ${source}
    DEPENDS ${source} DEPFILE ${folder}/${name}.d VERBATIM)
  set(compiled ${compiled} ${folder}/${name}.spv PARENT_SCOPE)
endfunction()

function(relief_shaders target directory header namespace)
  cmake_parse_arguments(PARSE_ARGV 4 argument "" "" "VARIANTS;FULL_SCREEN;OPTIMISED")
  file(GLOB shaders CONFIGURE_DEPENDS ${directory}/*.comp ${directory}/*.vert ${directory}/*.frag)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders)
  file(MAKE_DIRECTORY ${folder})
  set(compiled)
  foreach(name IN LISTS argument_OPTIMISED)
    set(flags_${name} -O)
  endforeach()
  foreach(variant IN LISTS argument_VARIANTS)
    string(REPLACE ":" ";" parts ${variant})
    list(POP_FRONT parts name source definitions)
    string(REPLACE "," ";" definitions "${definitions}")
    list(TRANSFORM definitions PREPEND -D)
    list(APPEND flags_${name} ${definitions})
    set(source_${name} ${directory}/${source}.comp)
    list(REMOVE_ITEM shaders ${source_${name}})
    relief_shader(${name} ${source_${name}} ${flags_${name}})
  endforeach()
  foreach(shader IN LISTS shaders)
    get_filename_component(name ${shader} NAME_WE)
    set(source_${name} ${shader})
    relief_shader(${name} ${shader} ${flags_${name}})
  endforeach()
  foreach(name IN LISTS argument_FULL_SCREEN)
    relief_shader(${name}_fragment ${source_${name}} ${flags_${name}} -fshader-stage=fragment -DFULL_SCREEN)
  endforeach()
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_shaders.py)
  add_custom_command(OUTPUT ${folder}/shaders.cpp
    COMMAND Python3::Interpreter ${script} ${folder}/shaders.cpp ${header} ${namespace} ${compiled}
    DEPENDS ${compiled} ${script} VERBATIM)
  target_sources(${target} PRIVATE ${folder}/shaders.cpp)
endfunction()
