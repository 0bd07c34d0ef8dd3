# `cpack -G DEB` in the build folder: the packages posewright, libposewright-dev and, with POSEWRIGHT_BUILD_PYTHON,
# python3-posewright, with POSEWRIGHT_MPI posewright-mpi. scripts/apt-repository makes a repository of them.
set(POSEWRIGHT_MAINTAINER "the posewright developers <developers@posewright.example>" CACHE STRING "Name <address> of who builds the package")

# Debian wants compressed pages, a change log of its own and the licence in one form.
file(READ LICENSE license_text)
string(REGEX REPLACE "\n+$" "" license_text "${license_text}")
string(REGEX REPLACE "\n\n" "\n.\n" license_text "${license_text}")
string(REPLACE "\n" "\n " license_text " ${license_text}")
configure_file(cmake/packaging/copyright.in packaging/copyright @ONLY)
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C date -u -d ${POSEWRIGHT_RELEASE_DATE} "+%a, %d %b %Y"
  OUTPUT_VARIABLE release_day OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
# Not from the Debian archive, whose first one would be 1; the systems' packages differ, and an upgrade takes the later one's.
cmake_host_system_information(RESULT system QUERY DISTRIB_ID DISTRIB_VERSION_ID DISTRIB_VERSION_CODENAME)
list(GET system 2 debian_suite)
list(REMOVE_AT system 2)
list(JOIN system "" system)
set(debian_revision 0local1+${system})
configure_file(cmake/packaging/changelog.Debian.in packaging/changelog.Debian @ONLY)
set(packed ${PROJECT_BINARY_DIR}/packaging)
add_custom_command(OUTPUT ${packed}/changelog.gz ${packed}/changelog.Debian.gz
  DEPENDS CHANGELOG.md ${packed}/changelog.Debian
  COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md > ${packed}/changelog.gz
  COMMAND gzip -9nc ${packed}/changelog.Debian > ${packed}/changelog.Debian.gz)
add_custom_target(posewright_packed ALL DEPENDS ${packed}/changelog.gz posewright_pages)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL "")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")   # each package has its own
set(CPACK_PACKAGE_CONTACT "${POSEWRIGHT_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${debian_revision})
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# posewright_package(NAME COMPONENT SECTION section SUMMARY line [DEPENDS list] TEXT lines): the component as a Debian
# package, with the files that every package has.
function(posewright_package name component)
  cmake_parse_arguments(PARSE_ARGV 2 package "" "SECTION;SUMMARY;DEPENDS;TEXT" "")
  install(FILES ${packed}/copyright ${packed}/changelog.gz ${packed}/changelog.Debian.gz
    DESTINATION share/doc/${name} COMPONENT ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${package_SECTION} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${package_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${package_SUMMARY}\n${package_TEXT}" PARENT_SCOPE)
endfunction()

include(cmake/packaging/program.cmake)
include(cmake/packaging/development.cmake)
if(POSEWRIGHT_BUILD_PYTHON)
  include(cmake/packaging/python.cmake)
endif()
if(POSEWRIGHT_MPI)
  include(cmake/packaging/processes.cmake)
endif()
include(CPack)
