# OpenImageIO brings some 250 shared libraries, OpenColorIO among them. They are loaded when a picture needs them: not for
# EXR.
set(CMAKE_MESSAGE_LOG_LEVEL WARNING) # as for OpenEXR
find_package(OpenImageIO REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
# Debian installs its CMake file where CMake does not look.
find_library(OPENCOLORIO_LIBRARY OpenColorIO REQUIRED)
find_path(OPENCOLORIO_FOLDER OpenColorIO/OpenColorIO.h REQUIRED)
# Debian's package names the headers of OpenCV, which nothing here includes and which need not be installed.
get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER oiio_includes EXCLUDE REGEX opencv)
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_includes}")
add_library(relief_pictures MODULE src/io/picture/module/picture_library_oiio.cpp
            src/io/picture/module/color_transform_ocio.cpp)
target_link_libraries(relief_pictures PRIVATE relief_options OpenImageIO::OpenImageIO ${OPENCOLORIO_LIBRARY})
target_include_directories(relief_pictures SYSTEM PRIVATE ${OPENCOLORIO_FOLDER})
set_target_properties(relief_pictures PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
target_compile_definitions(relief_io PRIVATE RELIEF_PICTURES="$<TARGET_FILE_NAME:relief_pictures>")
add_dependencies(relief_io relief_pictures)
# Where programs of this build look for the module; what is installed has paths of its own.
set(CMAKE_BUILD_RPATH $<TARGET_FILE_DIR:relief_pictures>)
