#include "posewright/controller/axis_names.hpp"

namespace posewright {

const std::vector<std::string>& krl_axis_names() {
  static const std::vector<std::string> names = {"A1", "A2", "A3", "A4", "A5", "A6",
                                                 "E1", "E2", "E3", "E4", "E5", "E6"};
  return names;
}

const std::vector<std::string>& rapid_axis_names() {
  static const std::vector<std::string> names = {"rax_1", "rax_2", "rax_3", "rax_4", "rax_5", "rax_6",
                                                 "eax_a", "eax_b", "eax_c", "eax_d", "eax_e", "eax_f"};
  return names;
}

const std::vector<std::string>& tp_axis_names() {
  static const std::vector<std::string> names = {"J1", "J2", "J3", "J4",     "J5",     "J6",
                                                 "E1", "E2", "E3", "GP2.J1", "GP2.J2", "GP2.J3"};
  return names;
}

const std::vector<std::string>& urscript_axis_names() {
  static const std::vector<std::string> names = {"base", "shoulder", "elbow", "wrist1", "wrist2", "wrist3"};
  return names;
}

const std::vector<std::string>& inform_axis_names() {
  static const std::vector<std::string> names = {"S", "L", "U", "R", "B", "T"};
  return names;
}

const std::vector<std::string>& val3_axis_names() {
  static const std::vector<std::string> names = {"j1", "j2", "j3", "j4", "j5", "j6"};
  return names;
}

}  // namespace posewright
