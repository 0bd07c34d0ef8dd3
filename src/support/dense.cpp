#include "posewright/support/dense.hpp"

POSEWRIGHT_DENSE_INSTANCES()
