#include "language.hpp"

#include <algorithm>

#include "posewright/controller/axis_names.hpp"

namespace posewright::programs {

const std::vector<Language>& languages() {
  static const std::vector<Language> table = {
      {"kuka-krl",
       {".dat", ".src"},
       ".src",
       krl_axis_names(),
       Angle::degrees,
       5,
       false,
       Scope::stem,
       true,
       'X',
       read_krl,
       krl_pose},
      {"abb-rapid",
       {".mod", ".prg"},
       "",
       rapid_axis_names(),
       Angle::degrees,
       4,
       true,
       Scope::all,
       true,
       0,
       read_rapid,
       rapid_pose},
      {"fanuc-tp", {".ls"}, "", tp_axis_names(), Angle::degrees, 5, true, Scope::file, true, 0, read_tp, tp_pose},
      {"urscript",
       {".script"},
       "",
       urscript_axis_names(),
       Angle::radians,
       6,
       false,
       Scope::file,
       false,
       0,
       read_urscript,
       urscript_pose},
      {"yaskawa-inform",
       {".jbi"},
       "",
       inform_axis_names(),
       Angle::pulses,
       0,
       true,
       Scope::file,
       true,
       0,
       read_inform,
       inform_pose},
      {"staubli-val3",
       {".dtx", ".pgx"},
       ".pgx",
       val3_axis_names(),
       Angle::degrees,
       4,
       false,
       Scope::folder,
       false,
       0,
       read_val3,
       val3_pose},
      {"joint-trajectory", {}, "", {}, Angle::radians, -1, false, Scope::file, false, 0, read_trajectory, nullptr}};
  return table;
}

const Language* language_of(std::string_view format) {
  const auto at =
      std::find_if(languages().begin(), languages().end(), [&](const Language& l) { return l.format == format; });
  return at == languages().end() ? nullptr : &*at;
}

}  // namespace posewright::programs
