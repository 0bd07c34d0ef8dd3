# The package libposewright-dev: headers, static library and CMake files, in the folders of Debian's architecture. What
# `cmake --install` writes by itself lies where its prefix has it, so these are components of their own.
execute_process(COMMAND dpkg-architecture -qDEB_HOST_MULTIARCH OUTPUT_VARIABLE multiarch OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT multiarch)
  set(multiarch ${CMAKE_LIBRARY_ARCHITECTURE})
endif()
set(debian_dir lib/${multiarch}/cmake/posewright)
set(to COMPONENT debian_development EXCLUDE_FROM_ALL)

install(TARGETS posewright posewright_headers EXPORT posewright-debian ARCHIVE DESTINATION lib/${multiarch} ${to})
install(DIRECTORY include/posewright ${PROJECT_BINARY_DIR}/include/posewright DESTINATION include ${to} FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY planners DESTINATION include/posewright ${to} FILES_MATCHING PATTERN "*.hpp")
install(EXPORT posewright-debian FILE posewright-targets.cmake NAMESPACE posewright:: DESTINATION ${debian_dir} ${to})
install(FILES ${package_files} DESTINATION ${debian_dir} ${to})

# What cmake/dependencies.cmake finds.
posewright_package(libposewright-dev debian_development SECTION libdevel
  DEPENDS "libeigen3-dev, libompl-dev, libboost-dev, libboost-program-options-dev, libtinyxml2-dev, \
libyaml-cpp-dev, nlohmann-json3-dev, libfmt-dev, libnlopt-dev, libnlopt-cxx-dev, libfcl-dev, libassimp-dev, \
zlib1g-dev, libqhull-dev"
  SUMMARY "library that plans poses for robot calibration (development files)"
  TEXT "Headers, static library and CMake files: find_package(posewright) gives the
target posewright::posewright. Whole tasks as the program has them, and their
parts: models, criteria, planners and certificates.")
