# Options of the build and flags that every target of Relief has, and none of those that use the library.
include(CMakeDependentOption)
option(RELIEF_IO "Build file readers and writers" ON)
option(RELIEF_PICTURE_MODULE "Build the module that reads what neither OpenEXR nor libpng reads (OpenImageIO)" ON)
option(RELIEF_PYTHON "Build the Python module" OFF)
option(RELIEF_VULKAN "Build the Vulkan engine" ON)
option(RELIEF_APPS "Build the programs; the relief command needs RELIEF_IO" ${PROJECT_IS_TOP_LEVEL})
cmake_dependent_option(RELIEF_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL} RELIEF_APPS OFF)
option(RELIEF_FUZZ "Build the fuzz targets (clang)" OFF)
option(RELIEF_INSTALL "Make rules that install the library and the command" ${PROJECT_IS_TOP_LEVEL})
option(RELIEF_WERROR "Treat warnings of Relief's own sources as errors" ${PROJECT_IS_TOP_LEVEL})
option(BUILD_SHARED_LIBS "Build librelief as a shared library" OFF)
option(RELIEF_DCHECKS "Check internal contracts at run time" OFF)
option(RELIEF_UNITY "Compile several sources of a module as one: a whole build takes two thirds of the time" OFF)
set(RELIEF_SANITIZE "" CACHE STRING "Sanitizers for all targets, e.g. address,undefined")
option(RELIEF_COVERAGE "Instrument for llvm-cov" OFF)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(BUILD_SHARED_LIBS OR RELIEF_PYTHON)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
if(CMAKE_POSITION_INDEPENDENT_CODE)
  # Programs as libraries: they share precompiled headers.
  set(CMAKE_CXX_COMPILE_OPTIONS_PIE ${CMAKE_CXX_COMPILE_OPTIONS_PIC})
endif()

# What follows is the business of whoever builds the whole: not of a project that Relief is a part of.
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
  endif()
  # Above -O2 only compile times grow, apart from the kernels of the engine (see the top CMakeLists.txt). Flags that
  # somebody chose stay.
  if(CMAKE_CXX_FLAGS_RELEASE STREQUAL "-O3 -DNDEBUG")
    set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
  endif()
  find_program(RELIEF_CCACHE ccache)
  if(RELIEF_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # What ccache asks for before it takes part where headers are precompiled; nothing here names a date or a time.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${RELIEF_CCACHE})
  endif()
endif()

add_library(relief_options INTERFACE)
# Contraction into fused operations would differ between instruction sets and open cracks at shared edges.
target_compile_options(relief_options INTERFACE
  -ffp-contract=off -fno-math-errno -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wunused
  $<$<BOOL:${RELIEF_WERROR}>:-Werror>)
target_include_directories(relief_options INTERFACE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
find_program(RELIEF_LLD ld.lld)
if(RELIEF_LLD)
  target_link_options(relief_options INTERFACE -fuse-ld=lld)
endif()
if(RELIEF_DCHECKS)
  target_compile_definitions(relief_options INTERFACE RELIEF_DCHECKS)
endif()
if(RELIEF_SANITIZE)
  target_compile_options(relief_options INTERFACE -fsanitize=${RELIEF_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  target_link_options(relief_options INTERFACE -fsanitize=${RELIEF_SANITIZE})
endif()
if(RELIEF_COVERAGE)
  target_compile_options(relief_options INTERFACE -fprofile-instr-generate -fcoverage-mapping)
  target_link_options(relief_options INTERFACE -fprofile-instr-generate)
endif()
