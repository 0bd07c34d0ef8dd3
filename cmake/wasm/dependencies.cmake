# Libraries for WebAssembly, in the place of cmake/dependencies.cmake: no distribution has them compiled. Debian 13's headers, and
# the files that are needed of Debian's source packages, unpacked by scripts/wasm.
set(POSEWRIGHT_WASM_SOURCES ${PROJECT_SOURCE_DIR}/build/wasm-sources CACHE PATH "Sources that scripts/wasm unpacked")
set(wasm_sources ${POSEWRIGHT_WASM_SOURCES})
if(NOT EXISTS ${wasm_sources}/fcl)
  message(FATAL_ERROR "${wasm_sources} does not hold the libraries' sources: scripts/wasm gets them")
endif()
enable_language(C)

# One set of instructions for everything: SSE2's order of operations gives the figures of a processor; exceptions of the platform.
# Eigen takes pointers of 32 bits for a processor of eight registers, and sums products in another order there.
add_compile_definitions(EIGEN_ARCH_DEFAULT_NUMBER_OF_REGISTERS=16)
add_compile_options(-msimd128 -msse2 -fwasm-exceptions -isystem ${CMAKE_CURRENT_LIST_DIR}/include)
add_link_options(-fwasm-exceptions)
set(CMAKE_POSITION_INDEPENDENT_CODE OFF)
set(CMAKE_C_FLAGS_RELEASE "-O2 -DNDEBUG")

# Headers of /usr/include one by one: those of the C library there are another system's.
set(wasm_headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${wasm_headers})
foreach(folder IN ITEMS boost nlohmann)
  if(NOT EXISTS /usr/include/${folder})
    message(FATAL_ERROR "/usr/include/${folder} is missing: scripts/setup wasm installs it")
  endif()
  file(CREATE_LINK /usr/include/${folder} ${wasm_headers}/${folder} SYMBOLIC)
endforeach()

# wasm_headers_of(TARGET folder...): a library without code.
function(wasm_headers_of target)
  add_library(${target} INTERFACE IMPORTED)
  target_include_directories(${target} SYSTEM INTERFACE ${ARGN})
endfunction()
# Eigen's minimum and maximum are assembly of x86 for compilers that call themselves an old GCC, as clang does; the others' way here.
set(wasm_eigen ${wasm_headers}/eigen3)
if(NOT EXISTS ${wasm_eigen}/Eigen)
  file(COPY /usr/include/eigen3/Eigen /usr/include/eigen3/unsupported DESTINATION ${wasm_eigen})
  file(READ ${wasm_eigen}/Eigen/src/Core/arch/SSE/PacketMath.h text)
  string(REPLACE "#if EIGEN_COMP_GNUC && EIGEN_COMP_GNUC < 63" "#if 0" text "${text}")
  file(WRITE ${wasm_eigen}/Eigen/src/Core/arch/SSE/PacketMath.h "${text}")
endif()
wasm_headers_of(Eigen3::Eigen ${wasm_eigen})
wasm_headers_of(Boost::headers ${wasm_headers})
wasm_headers_of(nlohmann_json::nlohmann_json ${wasm_headers})
add_library(Threads::Threads INTERFACE IMPORTED)

# wasm_library(NAME FOLDER INCLUDE folder... SOURCES pattern...): an archive of sources below a folder, so that the program
# takes what it uses, without their tests, variants and FCL's motions; without warnings, which are their authors'.
function(wasm_library target folder)
  cmake_parse_arguments(PARSE_ARGV 2 library "" "" "INCLUDE;SOURCES")
  list(TRANSFORM library_SOURCES PREPEND ${wasm_sources}/${folder}/)
  file(GLOB sources CONFIGURE_DEPENDS ${library_SOURCES})
  list(FILTER sources EXCLUDE REGEX "/(tst[a-z]*|[a-z0-9]*_test|DIRparallel|PlannerDataStorage|StateStorage|[a-z_]*(continuous|conservative)[a-z_]*)[.]c")
  if(NOT sources)
    message(FATAL_ERROR "${wasm_sources}/${folder} has none of the sources of ${target}")
  endif()
  list(TRANSFORM library_INCLUDE PREPEND ${wasm_sources}/${folder}/)
  add_library(${target} STATIC EXCLUDE_FROM_ALL ${sources})
  target_compile_options(${target} PRIVATE -w)
  target_include_directories(${target} SYSTEM PUBLIC ${library_INCLUDE})
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
endfunction()
function(wasm_configured target in out)
  configure_file(${in} ${PROJECT_BINARY_DIR}/configured/${target}/${out})
  target_include_directories(${target} SYSTEM PUBLIC ${PROJECT_BINARY_DIR}/configured/${target})
endfunction()

wasm_library(fmt fmt INCLUDE include SOURCES src/format.cc src/os.cc)
wasm_library(tinyxml2 tinyxml2 INCLUDE . SOURCES tinyxml2.cpp)
wasm_library(yaml-cpp yaml-cpp INCLUDE include SOURCES src/*.cpp)
target_compile_definitions(yaml-cpp PUBLIC YAML_CPP_STATIC_DEFINE)
wasm_library(boost_program_options boost SOURCES
  libs/program_options/src/[ceopsuv]*.cpp)
target_link_libraries(boost_program_options PUBLIC Boost::headers)
wasm_library(qhull qhull INCLUDE src SOURCES src/libqhull_r/*_r.c)

wasm_library(nlopt nlopt INCLUDE src/api SOURCES src/api/*.c src/util/[!q]*.c src/algs/*/*.c)
target_sources(nlopt PRIVATE ${CMAKE_CURRENT_LIST_DIR}/qsort_r.c)
set(NLOPT_MAJOR_VERSION 2)
set(NLOPT_BUGFIX_VERSION 0)
set(NLOPT_MINOR_VERSION 7)
set(THREADLOCAL __thread)
set(SIZEOF_UNSIGNED_INT 4)
set(SIZEOF_UNSIGNED_LONG 4)
foreach(name IN ITEMS COPYSIGN FPCLASSIFY GETPID GETTIMEOFDAY ISINF ISNAN STDINT_H SYS_TIME_H TIME UINT32_T UNISTD_H)
  set(HAVE_${name} ON)
endforeach()
set(TIME_WITH_SYS_TIME ON)
wasm_configured(nlopt ${wasm_sources}/nlopt/nlopt_config.h.in nlopt_config.h)
file(GLOB nlopt_folders ${wasm_sources}/nlopt/src/util ${wasm_sources}/nlopt/src/algs/*)
target_include_directories(nlopt PRIVATE ${nlopt_folders})
if(NOT EXISTS ${PROJECT_BINARY_DIR}/configured/nlopt/nlopt.hpp)
  execute_process(WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/configured/nlopt COMMAND_ERROR_IS_FATAL ANY
    COMMAND ${CMAKE_COMMAND} -DAPI_SOURCE_DIR=${wasm_sources}/nlopt/src/api -P ${wasm_sources}/nlopt/cmake/generate-cpp.cmake)
endif()

wasm_library(ccd ccd INCLUDE src SOURCES src/*.c)
set(CCD_DOUBLE ON)
wasm_configured(ccd ${wasm_sources}/ccd/src/ccd/config.h.cmake.in ccd/config.h)
target_compile_definitions(ccd PUBLIC CCD_STATIC_DEFINE)

wasm_library(fcl fcl INCLUDE include SOURCES src/common/*.cpp src/geometry/*.cpp src/geometry/shape/*.cpp src/geometry/bvh/*.cpp
  src/geometry/bvh/detail/*.cpp src/math/*.cpp src/math/bv/*.cpp src/math/detail/*.cpp
  src/narrowphase/co[ln]*.cpp src/narrowphase/cost*.cpp src/narrowphase/distance*.cpp src/narrowphase/detail/*.cpp
  src/narrowphase/detail/*algorithm/*.cpp src/narrowphase/detail/traversal/*.cpp src/narrowphase/detail/traversal/*/*.cpp)
set(FCL_VERSION 0.7.0)
set(FCL_MAJOR_VERSION 0)
set(FCL_MINOR_VERSION 7)
set(FCL_PATCH_VERSION 0)
wasm_configured(fcl ${wasm_sources}/fcl/include/fcl/config.h.in fcl/config.h)
include(GenerateExportHeader)
generate_export_header(fcl EXPORT_FILE_NAME ${PROJECT_BINARY_DIR}/configured/fcl/fcl/export.h)
target_compile_definitions(fcl PUBLIC FCL_STATIC_DEFINE)
target_link_libraries(fcl PUBLIC ccd Eigen3::Eigen)
# Each source is a few lines behind the same headers.
set_target_properties(fcl PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)

# The planners' base classes name the spaces of cars and constraints, and archives of their graphs.
wasm_library(boost_serialization boost SOURCES libs/serialization/src/archive*.cpp libs/serialization/src/basic_[ips]*.cpp
  libs/serialization/src/basic_o*.cpp libs/serialization/src/extended_type_info*.cpp libs/serialization/src/void_cast.cpp)
target_link_libraries(boost_serialization PUBLIC Boost::headers)
wasm_library(ompl ompl INCLUDE src SOURCES src/ompl/util/src/[!P]*.cpp src/ompl/util/src/Pro*.cpp src/ompl/base/src/*.cpp
  src/ompl/base/samplers/src/*ValidStateSampler.cpp src/ompl/base/samplers/src/Informed*.cpp src/ompl/base/samplers/informed/src/[!O]*.cpp
  src/ompl/base/spaces/src/RealVector*.cpp src/ompl/base/spaces/src/S[EO]2*.cpp src/ompl/base/spaces/src/Dubins*.cpp
  src/ompl/base/spaces/src/Reeds*.cpp src/ompl/base/spaces/src/Wrap*.cpp src/ompl/base/spaces/constraint/src/Constrained*.cpp
  src/ompl/base/goals/src/GoalStat*.cpp src/ompl/base/goals/src/GoalRegion.cpp src/ompl/base/objectives/src/PathLength*.cpp
  src/ompl/geometric/src/Path[GS]*.cpp src/ompl/geometric/planners/prm/src/PRM.cpp
  src/ompl/geometric/planners/rrt/src/RRTConnect.cpp src/ompl/tools/config/src/*.cpp)
wasm_configured(ompl ${wasm_sources}/ompl/src/ompl/config.h.in ompl/config.h)
target_link_libraries(ompl PUBLIC boost_serialization Eigen3::Eigen)

foreach(alias IN ITEMS fmt::fmt=fmt tinyxml2::tinyxml2=tinyxml2 yaml-cpp::yaml-cpp=yaml-cpp NLopt::nlopt=nlopt Qhull::qhull_r=qhull
    OMPL::ompl=ompl Boost::program_options=boost_program_options)
  string(REPLACE "=" ";" pair ${alias})
  list(GET pair 0 name)
  list(GET pair 1 target)
  add_library(${name} ALIAS ${target})
endforeach()

set(POSEWRIGHT_LIBRARIES
  Boost::headers OMPL::ompl tinyxml2::tinyxml2 yaml-cpp::yaml-cpp nlohmann_json::nlohmann_json fmt::fmt NLopt::nlopt fcl Qhull::qhull_r Threads::Threads)
