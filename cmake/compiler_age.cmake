# Compilers that are too old end here, in one line.
foreach(oldest IN ITEMS "GNU 12" "Clang 14")
  separate_arguments(oldest)
  list(POP_FRONT oldest id)
  if(CMAKE_CXX_COMPILER_ID STREQUAL id AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS oldest)
    message(FATAL_ERROR "posewright is compiled by g++ 12 or clang 14 or later, not by ${id} ${CMAKE_CXX_COMPILER_VERSION}; "
      "without compiling: pip install posewright-*.whl (docs/install.md)")
  endif()
endforeach()
