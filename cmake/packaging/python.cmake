# The package python3-posewright. Debian's tools for Python packages would write the scripts and what it depends on; they
# need a build of their own, so both stand here.
math(EXPR next_minor "${POSEWRIGHT_PYTHON_MINOR} + 1")
posewright_package(python3-posewright debian_python SECTION python
  DEPENDS "python3 (<< 3.${next_minor}), python3 (>= 3.${POSEWRIGHT_PYTHON_MINOR}~), python3-numpy"
  SUMMARY "Python package that plans poses for robot calibration"
  TEXT "Plans, routes, calibrations and the other tasks of posewright as Python
functions on numpy arrays; results show themselves in notebooks.")
set(CPACK_DEBIAN_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
  ${PROJECT_SOURCE_DIR}/cmake/packaging/postinst ${PROJECT_SOURCE_DIR}/cmake/packaging/prerm)
