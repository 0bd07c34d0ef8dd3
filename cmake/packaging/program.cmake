# The package posewright: program, manual page, completion, schemas, controllers, examples and pages.
install(FILES ${PROJECT_BINARY_DIR}/src/cli/posewright.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/src/cli/completion.bash RENAME posewright COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${PROJECT_BINARY_DIR}/src/cli/completion.zsh RENAME _posewright COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(DIRECTORY controllers DESTINATION ${CMAKE_INSTALL_DATADIR}/posewright COMPONENT program)
install(DIRECTORY schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/posewright COMPONENT program FILES_MATCHING PATTERN "*.schema.json")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/posewright COMPONENT program
  PATTERN "__pycache__" EXCLUDE PATTERN "plan.json" EXCLUDE PATTERN "poses.csv" EXCLUDE PATTERN "reproduc*" EXCLUDE)   # that compares pages, in the source folder
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png")
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
# The page that plans, where scripts/wasm has made it: for `init --show`.
install(FILES build/wasm-package/posewright.html DESTINATION ${CMAKE_INSTALL_DATADIR}/posewright COMPONENT program OPTIONAL)
# What the program's report page holds of others.
install(FILES report/dist/LICENSES.txt RENAME report-licenses.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
if(POSEWRIGHT_MUSL)
  cmake_path(GET POSEWRIGHT_MUSL PARENT_PATH musl_place)
  install(FILES ${musl_place}/../../share/doc/musl-dev/copyright RENAME musl-licenses.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
endif()

posewright_package(posewright program SECTION science
  SUMMARY "plans which poses to measure before a robot is calibrated"
  TEXT "Searches for the configurations whose measurement tells most about a robot's
geometric or elastic parameters, proves how near the best possible plan the
result is, and orders the poses into collision-free motions. Calibrates from
the readings and writes programs for the robot as it is.")
