# Every package is one of Debian 12 and 13; docs/dependencies.md gives the reason for each, package.xml its key of rosdep.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost 1.74 REQUIRED CONFIG COMPONENTS program_options)
find_package(tinyxml2 REQUIRED CONFIG)   # 9 and 11: its CMake file refuses any other number than its own
find_package(yaml-cpp 0.7 REQUIRED CONFIG)
find_package(nlohmann_json 3.11 REQUIRED CONFIG)
find_package(fmt 9 REQUIRED CONFIG)
find_package(NLopt 2.7 REQUIRED CONFIG)
find_package(fcl 0.7 REQUIRED CONFIG)
find_package(assimp 5.2 REQUIRED CONFIG)
find_package(Qhull REQUIRED CONFIG)
find_package(Threads REQUIRED)

if(NOT TARGET yaml-cpp::yaml-cpp)   # so called since version 0.8
  add_library(yaml-cpp::yaml-cpp ALIAS yaml-cpp)
endif()

# Debian's omplConfig.cmake names Boost libraries that libompl-dev does not depend on: take only libompl.so.
find_package(ompl 1.5 REQUIRED CONFIG)
if(NOT TARGET OMPL::ompl)
  find_library(OMPL_CORE_LIBRARY NAMES ompl REQUIRED)
  add_library(OMPL::ompl UNKNOWN IMPORTED)
  set_target_properties(OMPL::ompl PROPERTIES
    IMPORTED_LOCATION "${OMPL_CORE_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OMPL_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES Eigen3::Eigen)
endif()

set(POSEWRIGHT_LIBRARIES
  Boost::headers OMPL::ompl tinyxml2::tinyxml2 yaml-cpp::yaml-cpp nlohmann_json::nlohmann_json fmt::fmt NLopt::nlopt fcl assimp::assimp Qhull::qhull_r Threads::Threads)
