# One interface target carries the warnings, so that they reach our code and nobody else's.
add_library(posewright_warnings INTERFACE)
target_compile_options(posewright_warnings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wno-sign-conversion;-Wshadow;-Wnon-virtual-dtor>
  # Sources that are compiled as one are included ones.
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>)

# Debian's libompl allocates Eigen matrices with plain malloc; a translation unit built for AVX frees them
# with its own aligned allocator and crashes. Kernels that profit from AVX carry their own flags.
if(CMAKE_CXX_FLAGS MATCHES "-march=(native|x86-64-v[34]|haswell|skylake|znver)")
  message(WARNING "posewright: ${CMAKE_MATCH_0} in CMAKE_CXX_FLAGS crashes Debian's OMPL; "
                  "the kernels already choose AVX2 or AVX-512 at run time")
endif()
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=[a-z,]*address")
  # AddressSanitizer flips the same allocator switch in Eigen.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
