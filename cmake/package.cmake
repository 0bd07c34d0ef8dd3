# `cpack -G DEB` in the build folder: posewright_VERSION-1_ARCH.deb with the program, its pages, schemas and examples.
set(POSEWRIGHT_MAINTAINER "the posewright developers <posewright@localhost>" CACHE STRING "Name <address> of who builds the package")

# Debian wants compressed pages, a change log of its own and the licence in one form.
file(READ LICENSE license_text)
string(REGEX REPLACE "\n+$" "" license_text "${license_text}")
string(REGEX REPLACE "\n\n" "\n.\n" license_text "${license_text}")
string(REPLACE "\n" "\n " license_text " ${license_text}")
configure_file(cmake/packaging/copyright.in packaging/copyright @ONLY)
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C date -u -d ${POSEWRIGHT_RELEASE_DATE} "+%a, %d %b %Y"
  OUTPUT_VARIABLE release_day OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
configure_file(cmake/packaging/changelog.Debian.in packaging/changelog.Debian @ONLY)
set(packed ${PROJECT_BINARY_DIR}/packaging)
add_custom_command(OUTPUT ${packed}/changelog.gz ${packed}/changelog.Debian.gz
  DEPENDS CHANGELOG.md ${packed}/changelog.Debian
  COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md > ${packed}/changelog.gz
  COMMAND gzip -9nc ${packed}/changelog.Debian > ${packed}/changelog.Debian.gz)
add_custom_target(posewright_packed ALL DEPENDS ${packed}/changelog.gz posewright_pages)

install(FILES ${PROJECT_BINARY_DIR}/src/cli/posewright.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/src/cli/completion.bash RENAME posewright COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${PROJECT_BINARY_DIR}/src/cli/completion.zsh RENAME _posewright COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(DIRECTORY controllers DESTINATION ${CMAKE_INSTALL_DATADIR}/posewright COMPONENT program)
install(DIRECTORY schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/posewright COMPONENT program FILES_MATCHING PATTERN "*.schema.json")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/posewright COMPONENT program
  PATTERN "__pycache__" EXCLUDE PATTERN "plan.json" EXCLUDE PATTERN "poses.csv" EXCLUDE)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png")
install(FILES README.md ${packed}/copyright ${packed}/changelog.gz ${packed}/changelog.Debian.gz
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
# What the program's report page holds of others.
install(FILES report/dist/LICENSES.txt RENAME report-licenses.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_PACKAGE_CONTACT "${POSEWRIGHT_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME posewright)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"Searches for the configurations whose measurement tells most about a robot's
geometric or elastic parameters, proves how near the best possible plan the
result is, and orders the poses into collision-free motions.")
include(CPack)
