# relief/version.h, from the version that the top CMakeLists.txt gives the project: the only place that holds it.
set(RELIEF_VERSION_FOLDER ${PROJECT_BINARY_DIR}/include)
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.h.in ${RELIEF_VERSION_FOLDER}/relief/version.h @ONLY)
