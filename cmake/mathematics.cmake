# One set of mathematical functions for every processor. glibc has sin, exp and the like with fused multiplication and without, and
# picks by the processor; WebAssembly has musl's. Their last digits differ, and a search that moves poses ends elsewhere. Debian's
# musl-dev has musl's compiled, without fused multiplication: these objects become part of the library and so stand before glibc's.
if(EMSCRIPTEN)
  set(POSEWRIGHT_MATHEMATICS "musl")
  return()
endif()
string(REPLACE "-gnu" "-musl" musl_folder "${CMAKE_LIBRARY_ARCHITECTURE}")
find_file(POSEWRIGHT_MUSL libc.a PATHS /usr/lib/${musl_folder} NO_DEFAULT_PATH
  DOC "libc.a of musl, whose mathematical functions the program takes; OFF: those of the system")
if(NOT POSEWRIGHT_MUSL)
  set(POSEWRIGHT_MATHEMATICS "of the system, whose last digits depend on the processor")
  message(STATUS "Mathematical functions: ${POSEWRIGHT_MATHEMATICS} (musl-dev is not installed or not wanted)")
  return()
endif()
set(POSEWRIGHT_MATHEMATICS "musl")
message(STATUS "Mathematical functions: ${POSEWRIGHT_MUSL}")

# Functions, and what they call of each other. A program takes those that it uses.
set(musl_functions sin cos tan sincos asin acos atan atan2 sinh cosh tanh asinh acosh atanh hypot cbrt exp exp2 expm1 log log2 log10 log1p pow erf
  __sin __cos __tan __rem_pio2 __rem_pio2_large __expo2 exp_data log_data log2_data pow_data
  __math_divzero __math_invalid __math_oflow __math_uflow __math_xflow)
set(musl_objects ${PROJECT_BINARY_DIR}/musl)
execute_process(COMMAND ${CMAKE_AR} t ${POSEWRIGHT_MUSL} OUTPUT_VARIABLE musl_members COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" musl_members "${musl_members}")
set(POSEWRIGHT_MUSL_OBJECTS)
foreach(name IN LISTS musl_functions)
  if(NOT ${name}.lo IN_LIST musl_members)
    message(FATAL_ERROR "${POSEWRIGHT_MUSL} has no ${name}.lo: it is not the libc.a of Debian's musl-dev (-DPOSEWRIGHT_MUSL=OFF takes the system's functions)")
  endif()
  list(APPEND POSEWRIGHT_MUSL_OBJECTS ${musl_objects}/${name}.o)
endforeach()
if(${POSEWRIGHT_MUSL} IS_NEWER_THAN ${musl_objects}/sin.o)
  file(MAKE_DIRECTORY ${musl_objects})
  list(TRANSFORM musl_functions APPEND .lo)
  execute_process(COMMAND ${CMAKE_AR} x ${POSEWRIGHT_MUSL} ${musl_functions} WORKING_DIRECTORY ${musl_objects} COMMAND_ERROR_IS_FATAL ANY)
  foreach(member IN LISTS musl_functions)
    string(REPLACE ".lo" ".o" object ${member})
    file(RENAME ${musl_objects}/${member} ${musl_objects}/${object})
  endforeach()
endif()
