# Options of the build and flags that every target has.
option(RELIEF_IO "Build file readers and writers and the relief command" ON)
option(RELIEF_VULKAN "Build the Vulkan engine" ON)
option(RELIEF_TESTS "Build the tests" ON)
option(RELIEF_FUZZ "Build the fuzz targets (clang)" OFF)
option(RELIEF_DCHECKS "Check internal contracts at run time" OFF)
set(RELIEF_SANITIZE "" CACHE STRING "Sanitizers for all targets, e.g. address,undefined")
option(RELIEF_COVERAGE "Instrument for llvm-cov" OFF)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Above -O2 only compile times grow, apart from the kernels of the engine (see the top CMakeLists.txt).
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")

find_program(RELIEF_CCACHE ccache)
if(RELIEF_CCACHE)
  # What ccache asks for before it takes part where headers are precompiled; nothing here names a date or a time.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${RELIEF_CCACHE})
endif()

add_library(relief_options INTERFACE)
# Contraction into fused operations would differ between instruction sets and open cracks at shared edges.
target_compile_options(relief_options INTERFACE
  -ffp-contract=off -fno-math-errno -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wunused -Werror)
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
