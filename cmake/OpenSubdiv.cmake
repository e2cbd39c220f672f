# OpenSubdiv::osdCPU. The CMake file of Debian's OpenSubdiv asks for a static library that its package does not hold.
# Also installed, beside relief-config.cmake: what links the static library needs it.
if(NOT TARGET OpenSubdiv::osdCPU)
  find_library(OPENSUBDIV_LIBRARY osdCPU REQUIRED)
  find_path(OPENSUBDIV_FOLDER opensubdiv/version.h REQUIRED)
  add_library(OpenSubdiv::osdCPU UNKNOWN IMPORTED)
  set_target_properties(OpenSubdiv::osdCPU PROPERTIES IMPORTED_LOCATION ${OPENSUBDIV_LIBRARY}
                        INTERFACE_INCLUDE_DIRECTORIES ${OPENSUBDIV_FOLDER})
endif()
