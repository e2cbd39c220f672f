# What other projects link: relief::relief, one library of all the modules of src/ but io, and relief::io. They are made of
# the modules' objects, static or, with BUILD_SHARED_LIBS, shared; compile and link flags of the modules stay with these.

# relief_package(TARGET NAME MODULES... LIBRARIES ...): libNAME, relief::NAME without the prefix relief_.
function(relief_package target name)
  cmake_parse_arguments(PARSE_ARGV 2 ARG "" "" "MODULES;LIBRARIES")
  list(TRANSFORM ARG_MODULES REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
  add_library(${target} ${objects})
  string(REGEX REPLACE "^relief_" "" short ${name})
  add_library(relief::${short} ALIAS ${target})
  # Not the folders of the modules' own archives, which have the same names.
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME ${name} EXPORT_NAME ${short} LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES})
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_include_directories(${target} INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${RELIEF_VERSION_FOLDER}>)
  if(BUILD_SHARED_LIBS)
    set(exports ${PROJECT_SOURCE_DIR}/cmake/exports.map)
    target_link_options(${target} PRIVATE LINKER:--version-script=${exports} LINKER:-z,defs)
    if(RELIEF_LLD)
      target_link_options(${target} PRIVATE -fuse-ld=lld)
    endif()
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${exports})
  endif()
endfunction()

# All static libraries of the top folder are modules.
get_property(modules DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
set(core_modules)
foreach(module IN LISTS modules)
  get_target_property(type ${module} TYPE)
  if(type STREQUAL STATIC_LIBRARY AND NOT module STREQUAL relief_io)
    list(APPEND core_modules ${module})
  endif()
endforeach()
relief_package(relief_library relief MODULES ${core_modules}
               LIBRARIES TBB::tbb fmt::fmt hwy::hwy OpenSubdiv::osdCPU ${CMAKE_DL_LIBS})
set(relief_packages relief_library)

if(RELIEF_IO)
  relief_package(relief_io_library relief_io MODULES relief_io
                 LIBRARIES fmt::fmt OpenEXR::OpenEXR PNG::PNG TIFF::TIFF JPEG::JPEG ZLIB::ZLIB assimp::assimp
                           ${RELIEF_MESH_LIBRARIES} ${CMAKE_DL_LIBS})
  target_link_libraries(relief_io_library PUBLIC relief_library)
  if(TARGET relief_pictures)
    add_dependencies(relief_io_library relief_pictures)
    # A program finds the module for pictures by its own run path, a shared librelief_io by the library's.
    target_link_options(relief_io_library INTERFACE
      "$<BUILD_INTERFACE:-Wl,-rpath,$<TARGET_FILE_DIR:relief_pictures>>")
  endif()
  list(APPEND relief_packages relief_io_library)
endif()
