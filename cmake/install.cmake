include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/posewright)

install(TARGETS posewright posewright_headers EXPORT posewright-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS posewright_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(DIRECTORY include/posewright ${PROJECT_BINARY_DIR}/include/posewright
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY planners DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/posewright FILES_MATCHING PATTERN "*.hpp")
install(EXPORT posewright-targets NAMESPACE posewright:: DESTINATION ${package_dir})

configure_package_config_file(cmake/posewright-config.cmake.in posewright-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(posewright-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/posewright-config.cmake ${PROJECT_BINARY_DIR}/posewright-config-version.cmake
  cmake/dependencies.cmake DESTINATION ${package_dir})

include(cmake/package.cmake)
