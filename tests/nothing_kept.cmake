# Read by ctest before it runs tests.
set(ENV{POSEWRIGHT_CACHE} off)
