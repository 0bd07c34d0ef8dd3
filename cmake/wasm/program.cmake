# The program as WebAssembly, linked twice from the same objects, to the same bytes and different JavaScript, and optimised once:
#   bin/posewright.js    for node: it sees the files of the system, and runs at once
#   page/posewright.js   a module for pages: createPosewright() makes an instance with files in memory; callMain(words) runs it once
function(posewright_wasm target folder)
  add_executable(${target} $<TARGET_OBJECTS:posewright_commands>)
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME posewright RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${folder} LINKER_LANGUAGE CXX)
  target_link_libraries(${target} PRIVATE posewright::posewright ${POSEWRIGHT_LIBRARIES} Boost::program_options)
  # Memory grows up to what 32 bits can address. Deep expressions and trees need the stack of a usual system.
  target_link_options(${target} PRIVATE -O1 -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=4GB -sSTACK_SIZE=8MB ${ARGN})
endfunction()

posewright_wasm(posewright_program bin -sENVIRONMENT=node -sNODERAWFS=1 -sEXIT_RUNTIME=1 --pre-js ${CMAKE_CURRENT_LIST_DIR}/node.js)
posewright_wasm(posewright_page page -sENVIRONMENT=web,worker,node -sMODULARIZE=1 -sEXPORT_ES6=1 -sEXPORT_NAME=createPosewright
  -sFORCE_FILESYSTEM=1 -sINVOKE_RUN=0 -sEXIT_RUNTIME=1 -sEXPORTED_RUNTIME_METHODS=FS,callMain,ENV --pre-js ${CMAKE_CURRENT_LIST_DIR}/page.js)

# The package of npm, whole in one folder: `npm pack` reads it.
set(package ${PROJECT_BINARY_DIR}/npm)
configure_file(${PROJECT_SOURCE_DIR}/npm/package.json.in ${package}/package.json @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/npm/posewright.mjs ${package}/posewright.mjs COPYONLY)
configure_file(${PROJECT_SOURCE_DIR}/npm/README.md ${package}/README.md COPYONLY)
configure_file(${PROJECT_SOURCE_DIR}/LICENSE ${package}/LICENSE COPYONLY)
# Licences of all that is in posewright.wasm; NLopt's parts have their own. emscripten's file has those of its C and C++ libraries.
file(GLOB licences ${wasm_sources}/*/LICENSE* ${wasm_sources}/*/COPYING* ${wasm_sources}/*/BSD-LICENSE ${wasm_sources}/nlopt/src/algs/*/COPY*
  ${PROJECT_SOURCE_DIR}/report/dist/LICENSES.txt
  /usr/share/doc/libeigen3-dev/copyright /usr/share/doc/nlohmann-json3-dev/copyright /usr/share/doc/emscripten/copyright)
file(WRITE ${package}/LICENSES.txt "Licences of the libraries in posewright.wasm\n")
foreach(licence IN LISTS licences)
  file(READ ${licence} text)
  string(REGEX REPLACE "^(${wasm_sources}|${PROJECT_SOURCE_DIR}|/usr/share/doc)/" "" name ${licence})
  file(APPEND ${package}/LICENSES.txt "\n==== ${name}\n\n${text}")
endforeach()
file(COPY ${package}/LICENSES.txt DESTINATION ${PROJECT_BINARY_DIR}/page)
# From -O2 on the linker would optimise each of both, for minutes.
find_program(POSEWRIGHT_WASM_OPT wasm-opt REQUIRED)
add_custom_command(TARGET posewright_program POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_BINARY_DIR}/bin/posewright.js ${package}/posewright.cjs
  COMMAND ${POSEWRIGHT_WASM_OPT} --enable-exception-handling --enable-simd --enable-sign-ext --enable-mutable-globals
    --post-emscripten -O2 --low-memory-unused --strip-debug ${PROJECT_BINARY_DIR}/bin/posewright.wasm -o ${package}/posewright.wasm)
add_dependencies(posewright_page posewright_program)
add_custom_command(TARGET posewright_page POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E compare_files ${PROJECT_BINARY_DIR}/page/posewright.wasm ${PROJECT_BINARY_DIR}/bin/posewright.wasm
  COMMAND ${CMAKE_COMMAND} -E copy ${package}/posewright.wasm ${PROJECT_BINARY_DIR}/page/posewright.wasm)
set_property(TARGET posewright_program APPEND PROPERTY LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/node.js)
set_property(TARGET posewright_page APPEND PROPERTY LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/page.js)
