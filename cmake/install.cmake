include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/posewright)

# Three components: program, development, python. `cmake --install BUILD --component NAME` installs one of them.
install(TARGETS posewright posewright_headers EXPORT posewright-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(TARGETS posewright_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(DIRECTORY include/posewright ${PROJECT_BINARY_DIR}/include/posewright
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY planners DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/posewright COMPONENT development
  FILES_MATCHING PATTERN "*.hpp")
install(EXPORT posewright-targets NAMESPACE posewright:: DESTINATION ${package_dir} COMPONENT development)

configure_package_config_file(cmake/posewright-config.cmake.in posewright-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(posewright-config-version.cmake COMPATIBILITY SameMinorVersion)
set(package_files ${PROJECT_BINARY_DIR}/posewright-config.cmake ${PROJECT_BINARY_DIR}/posewright-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/dependencies.cmake)
install(FILES ${package_files} DESTINATION ${package_dir} COMPONENT development)

# ROS 2 finds packages by the ament index: an empty file of the package's name.
file(WRITE ${PROJECT_BINARY_DIR}/ament_index/posewright "")
install(FILES ${PROJECT_BINARY_DIR}/ament_index/posewright COMPONENT development
  DESTINATION ${CMAKE_INSTALL_DATADIR}/ament_index/resource_index/packages)
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/posewright COMPONENT development)

include(cmake/package.cmake)
