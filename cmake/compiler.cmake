# How the compiler is called: what an optimised build means, how many run at once, and a cache where there is one.
include(${CMAKE_CURRENT_LIST_DIR}/compiler_age.cmake)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
# -O2 for everybody, so that figures do not depend on the kind of build; line numbers for developers only.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1 -DNDEBUG")

# The compiler collects its memory later: less of its time goes there (3.6 of 38 s of one unit before).
add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=400000>)

# One compiler may take 2.2 GB: as many at once as there are processors and as memory holds.
cmake_host_system_information(RESULT posewright_cores QUERY NUMBER_OF_LOGICAL_CORES)
cmake_host_system_information(RESULT posewright_memory QUERY TOTAL_PHYSICAL_MEMORY)   # MiB
math(EXPR posewright_jobs "${posewright_memory} / 2400")
if(posewright_jobs GREATER posewright_cores)
  set(posewright_jobs ${posewright_cores})
elseif(posewright_jobs LESS 1)
  set(posewright_jobs 1)
endif()
set_property(GLOBAL PROPERTY JOB_POOLS compilers=${posewright_jobs})
set(CMAKE_JOB_POOL_COMPILE compilers)
set(CMAKE_JOB_POOL_LINK compilers)

# A build folder goes on as it began: a compiler called in another way would compile everything again.
if(NOT DEFINED CCACHE_PROGRAM)
  find_program(CCACHE_PROGRAM ccache)
endif()
mark_as_advanced(CCACHE_PROGRAM)
if(CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths are made relative, so that another clone finds what this one compiled; what a precompiled header defines and the
  # time it was written count for nothing.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE_PROGRAM})
endif()
