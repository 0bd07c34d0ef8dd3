# What a colcon workspace (ROS 2) expects of a package. colcon marks its build folder with a file: there posewright is one
# package of many, so it is built fast and without the tests of its developers.
set(POSEWRIGHT_IN_WORKSPACE OFF)
if(PROJECT_IS_TOP_LEVEL AND EXISTS ${PROJECT_BINARY_DIR}/../COLCON_IGNORE)
  set(POSEWRIGHT_IN_WORKSPACE ON)
  option(CMAKE_UNITY_BUILD "Compile many sources as one" ON)
  option(BUILD_TESTING "Register the checks that colcon test runs" ON)
endif()
