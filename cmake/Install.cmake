# cmake --install, in three components: runtime (shared libraries and the module for pictures), development (headers,
# static libraries, CMake and pkg-config files) and command (the program, its manual page and completions).
if(NOT RELIEF_INSTALL)
  return()
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(module_folder ${CMAKE_INSTALL_LIBDIR}/relief)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/relief)

file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/relief/*.h)
if(NOT RELIEF_IO)
  list(FILTER headers EXCLUDE REGEX /io\\.h$)
endif()
install(FILES ${headers} ${RELIEF_VERSION_FOLDER}/relief/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/relief
        COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/NOTICE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)

# relief_build_missing(COMPONENT TARGET [FILE]): the installation builds the target where FILE, by default the target's own, is
# not there yet: after `make render` only the command is.
function(relief_build_missing component target)
  set(file $<TARGET_FILE:${target}>)
  if(ARGC GREATER 2)
    set(file ${ARGV2})
  endif()
  install(CODE "
    if(NOT EXISTS \"${file}\")
      message(STATUS \"Not built yet, and built now: ${target}\")
      execute_process(COMMAND \"${CMAKE_COMMAND}\" --build \"${PROJECT_BINARY_DIR}\" --config Release --target ${target}
                      OUTPUT_QUIET RESULT_VARIABLE failure)
      if(failure)
        message(FATAL_ERROR \"${target} cannot be built: cmake --build ${PROJECT_BINARY_DIR} --target ${target} shows why\")
      endif()
    endif()" COMPONENT ${component})
endfunction()

# Two sets of targets, since the second needs more libraries.
foreach(library IN LISTS relief_packages)
  get_target_property(set ${library} EXPORT_NAME)
  relief_build_missing(runtime ${library})
  relief_build_missing(development ${library})
  install(TARGETS ${library} EXPORT relief-${set}-targets
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT relief-${set}-targets NAMESPACE relief:: DESTINATION ${config_folder} COMPONENT development)
endforeach()


configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/relief-config.cmake.in ${PROJECT_BINARY_DIR}/relief-config.cmake
                              INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/relief-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/relief-config.cmake ${PROJECT_BINARY_DIR}/relief-config-version.cmake
              ${PROJECT_SOURCE_DIR}/cmake/OpenSubdiv.cmake
        DESTINATION ${config_folder} COMPONENT development)

# Who links a static library names also what it was linked with.
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
set(core_libraries)
set(io_libraries)
set(io_requires)
if(NOT BUILD_SHARED_LIBS)
  set(core_libraries "-ltbb -lfmt -lhwy -losdCPU -ldl")
  list(JOIN RELIEF_MESH_LIBRARIES " " mesh_libraries)
  set(io_libraries "-lassimp ${mesh_libraries}")
  set(io_requires "OpenEXR libpng libtiff-4 libjpeg zlib")
endif()
set(pkgconfig_files relief.pc)
if(RELIEF_IO)
  list(APPEND pkgconfig_files relief_io.pc)
endif()
foreach(file IN LISTS pkgconfig_files)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${file}.in ${PROJECT_BINARY_DIR}/${file} @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${file} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endforeach()

if(TARGET relief_pictures)
  relief_build_missing(runtime relief_pictures)
  install(TARGETS relief_pictures LIBRARY DESTINATION ${module_folder} COMPONENT runtime)
  set_target_properties(relief_io_library PROPERTIES INSTALL_RPATH "$ORIGIN;$ORIGIN/relief")
  target_link_options(relief_io_library INTERFACE
    "$<INSTALL_INTERFACE:-Wl,-rpath,$<INSTALL_PREFIX>/${module_folder}>")
endif()
if(TARGET relief)
  file(RELATIVE_PATH module_from_command /${CMAKE_INSTALL_BINDIR} /${module_folder})
  set_target_properties(relief PROPERTIES INSTALL_RPATH $ORIGIN/${module_from_command})
  relief_build_missing(command relief)
  install(TARGETS relief RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  install(FILES ${PROJECT_SOURCE_DIR}/docs/man/relief.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command)

  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  set(completions ${PROJECT_BINARY_DIR}/completions)
  set(script ${PROJECT_SOURCE_DIR}/cmake/make_completions.py)
  add_custom_command(OUTPUT ${completions}/relief ${completions}/_relief ${completions}/relief.fish
    COMMAND Python3::Interpreter ${script} $<TARGET_FILE:relief> ${completions}
    DEPENDS relief ${script} VERBATIM)
  add_custom_target(relief_completions ALL DEPENDS ${completions}/relief)
  relief_build_missing(command relief_completions ${completions}/relief)
  install(FILES ${completions}/relief DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT command)
  install(FILES ${completions}/_relief DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT command)
  install(FILES ${completions}/relief.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
          COMPONENT command)
endif()
if(TARGET relief-bench)
  # Beside the command, which starts it.
  set_target_properties(relief-bench PROPERTIES INSTALL_RPATH $ORIGIN/${module_from_command})
  relief_build_missing(command relief-bench)
  install(TARGETS relief-bench RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  install(PROGRAMS ${PROJECT_SOURCE_DIR}/tools/plot_bench.py DESTINATION ${CMAKE_INSTALL_BINDIR}
          RENAME relief-plot-bench COMPONENT command)
endif()
if(TARGET relief-view)
  set_target_properties(relief-view PROPERTIES INSTALL_RPATH $ORIGIN/${module_from_command})
  relief_build_missing(command relief-view)
  install(TARGETS relief-view RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
endif()
