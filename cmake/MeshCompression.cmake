# Libraries that decompress meshes of glTF. Without them a build refuses such files, and says what to export instead.
find_library(DRACO_LIBRARY draco)
find_path(DRACO_FOLDER draco/compression/decode.h)
find_library(MESHOPT_LIBRARY meshoptimizer)
find_path(MESHOPT_FOLDER meshoptimizer.h)
mark_as_advanced(DRACO_LIBRARY DRACO_FOLDER MESHOPT_LIBRARY MESHOPT_FOLDER)

set(RELIEF_MESH_LIBRARIES)
set(definitions)
if(DRACO_LIBRARY AND DRACO_FOLDER)
  list(APPEND RELIEF_MESH_LIBRARIES ${DRACO_LIBRARY})
  list(APPEND definitions RELIEF_DRACO)
endif()
if(MESHOPT_LIBRARY AND MESHOPT_FOLDER)
  list(APPEND RELIEF_MESH_LIBRARIES ${MESHOPT_LIBRARY})
  list(APPEND definitions RELIEF_MESHOPT)
endif()
# Each is compiled by itself: its definitions are not those of the headers that the others have precompiled.
set_source_files_properties(src/io/mesh/gltf_draco.cpp src/io/mesh/gltf_meshopt.cpp PROPERTIES
                            COMPILE_DEFINITIONS "${definitions}"
                            SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
