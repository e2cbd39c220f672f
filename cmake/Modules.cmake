# relief_unite(TARGET [NUMBER]): compiles its sources so many at once under RELIEF_UNITY. Names in unnamed namespaces differ
# within a target for that. Six: of more, a change of one file would compile too many others.
function(relief_unite target)
  set(number 6)
  if(ARGC GREATER 1)
    set(number ${ARGV1})
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${RELIEF_UNITY} UNITY_BUILD_BATCH_SIZE ${number})
endfunction()

# relief_module(NAME [SOURCE_DIRECTORY DIR] [EXCLUDE REGEX] [PRECOMPILED HEADERS] MODULES ... LIBRARIES ...): static library
# relief_NAME from src/NAME, without the sources whose path matches REGEX. HEADERS: of relief_precompile, instead of
# relief_library_headers.
function(relief_module name)
  cmake_parse_arguments(ARG "" "SOURCE_DIRECTORY;EXCLUDE;PRECOMPILED" "MODULES;LIBRARIES" ${ARGN})
  set(directory ${PROJECT_SOURCE_DIR}/src/${name})
  if(ARG_SOURCE_DIRECTORY)
    set(directory ${PROJECT_SOURCE_DIR}/src/${ARG_SOURCE_DIRECTORY})
    file(GLOB sources CONFIGURE_DEPENDS ${directory}/*.cpp)
  else()
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${directory}/*.cpp)
  endif()
  if(ARG_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${ARG_EXCLUDE})
  endif()
  if(NOT sources)
    add_library(relief_${name} INTERFACE)
    set(scope INTERFACE)
  else()
    add_library(relief_${name} STATIC ${sources})
    relief_unite(relief_${name})
    set(scope PUBLIC)
  endif()
  if(NOT ARG_PRECOMPILED)
    set(ARG_PRECOMPILED relief_library_headers)
  endif()
  if(sources)
    target_precompile_headers(relief_${name} REUSE_FROM ${ARG_PRECOMPILED})
  endif()
  list(TRANSFORM ARG_MODULES PREPEND relief_ OUTPUT_VARIABLE modules)
  target_link_libraries(relief_${name} ${scope} relief_options ${modules} ${ARG_LIBRARIES})
endfunction()

# relief_precompile(NAME HEADERS... LIBRARIES ...): headers of other projects, compiled once for all targets that say
# target_precompile_headers(TARGET REUSE_FROM NAME): they are most of what a compiler reads. The flags must be those of the
# targets. tests/layout sees to it that files include what they use all the same.
function(relief_precompile name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
  file(CONFIGURE OUTPUT ${name}.cpp CONTENT "" @ONLY)
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE relief_options ${ARG_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
  # ccache compares contents.
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>)
endfunction()
