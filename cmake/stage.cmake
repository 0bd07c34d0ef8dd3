# Public headers and the libraries that appear in them.
add_library(posewright_headers INTERFACE)
target_include_directories(posewright_headers INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
  $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/posewright>)   # planners/…
target_compile_features(posewright_headers INTERFACE cxx_std_20)
target_link_libraries(posewright_headers INTERFACE Eigen3::Eigen)

# posewright_stage(NAME sources...): one stage of the pipeline as an object library, so that a stage and its
# tests build alone; all stages together make the library `posewright`.
function(posewright_stage name)
  add_library(posewright_${name} OBJECT ${ARGN})
  target_link_libraries(posewright_${name} PUBLIC posewright_headers PRIVATE posewright_warnings ${POSEWRIGHT_LIBRARIES})
  set_property(GLOBAL APPEND PROPERTY POSEWRIGHT_STAGES ${name})
endfunction()
