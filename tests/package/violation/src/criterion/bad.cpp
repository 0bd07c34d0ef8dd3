// What the layer check must find.

#include "posewright/model/six_pus.hpp"
