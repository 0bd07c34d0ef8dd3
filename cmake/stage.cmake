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

# posewright_parsed(SET header...): the target posewright_parsed_SET, whose precompiled header others reuse: what most sources
# read anyway, parsed once and not in every unit. A set for each level of optimisation and one for the tests with their
# framework, because a compiler takes only what was made with its own options. Every unit pays for what its set holds, so
# JSON, which takes half of the time, is in that of the cold sources alone.
function(posewright_parsed set)
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/parsed/${set}.cpp CONTENT "")
  add_library(posewright_parsed_${set} OBJECT ${PROJECT_BINARY_DIR}/parsed/${set}.cpp)
  target_link_libraries(posewright_parsed_${set} PRIVATE posewright_headers posewright_warnings ${POSEWRIGHT_LIBRARIES})
  target_precompile_headers(posewright_parsed_${set} PRIVATE ${PROJECT_SOURCE_DIR}/include/posewright/support/dense.hpp
    <algorithm> <array> <cmath> <filesystem> <functional> <limits> <map> <memory> <numbers> <numeric> <optional> <set> <span> <sstream>
    <string> <string_view> <thread> <tuple> <utility> <variant> <vector> ${ARGN})
endfunction()
set(read_by_cold <nlohmann/json.hpp> <fmt/format.h>)
posewright_parsed(hot)
posewright_parsed(cold ${read_by_cold})

# posewright_unit_size(TARGET COUNT): so many sources are compiled as one, where CMAKE_UNITY_BUILD asks for it. Large units
# share headers and templates; small ones keep a change of one line, and the memory of one compiler, small.
function(posewright_unit_size target count)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${count})
endfunction()

# posewright_stage(NAME [UNIT n] [COLD] sources...): one stage of the pipeline as an object library, so that a stage and its
# tests build alone; all stages together make the library `posewright`. COLD: no hot loops, so it is optimised less.
function(posewright_stage name)
  cmake_parse_arguments(PARSE_ARGV 1 stage "COLD" "UNIT" "")
  add_library(posewright_${name} OBJECT ${stage_UNPARSED_ARGUMENTS})
  target_link_libraries(posewright_${name} PUBLIC posewright_headers PRIVATE posewright_warnings ${POSEWRIGHT_LIBRARIES})
  if(stage_UNIT)
    posewright_unit_size(posewright_${name} ${stage_UNIT})
  endif()
  if(stage_COLD)
    posewright_cold(posewright_${name})
    target_precompile_headers(posewright_${name} REUSE_FROM posewright_parsed_cold)
  else()
    target_precompile_headers(posewright_${name} REUSE_FROM posewright_parsed_hot)
  endif()
  set_property(GLOBAL APPEND PROPERTY POSEWRIGHT_STAGES ${name})
endfunction()

# posewright_of_platform(TARGET sources...): sources that depend on what the platform has. Where a folder `wasm` beside them has
# a file of the name, WebAssembly takes that; where it has none, the file is left out there.
function(posewright_of_platform target)
  foreach(source IN LISTS ARGN)
    if(NOT EMSCRIPTEN)
      target_sources(${target} PRIVATE ${source})
    elseif(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/wasm/${source})
      target_sources(${target} PRIVATE wasm/${source})
    endif()
  endforeach()
endfunction()

# posewright_cold(TARGET): an optimised build compiles it with -O1.
function(posewright_cold target)
  target_compile_options(${target} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release,RelWithDebInfo>>:-O1>)
endfunction()
posewright_cold(posewright_parsed_cold)

# posewright_instruction_sets(STAGE PREFIX flags...): inner loops of a stage, compiled once for each instruction set from
# PREFIX_sse2.cpp and, on x86, PREFIX_avx2.cpp and PREFIX_avx512.cpp. No contraction, unless the flags want it: every
# set computes the same bits.
function(posewright_instruction_sets stage prefix)
  set(flags -O3 -ffp-contract=off ${ARGN})
  set(sets sse2)
  set(flags_avx2 -mavx2 -mfma)
  set(flags_avx512 -mavx2 -mfma -mavx512f -mavx512vl)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND sets avx2 avx512)
  endif()
  foreach(set IN LISTS sets)
    target_sources(posewright_${stage} PRIVATE ${prefix}_${set}.cpp)
    set_source_files_properties(${prefix}_${set}.cpp PROPERTIES
      COMPILE_OPTIONS "${flags};${flags_${set}}" SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
endfunction()
