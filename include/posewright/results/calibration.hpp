#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/model/dh_table.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// ols, wls or robust, as in files and on the command line.
std::string weighting_word(Weighting weighting);
/// Its inverse; weighted for an empty word. The word is one of these.
Weighting weighting_of(std::string_view word);

/// "use it", "gain not shown", "do not use".
std::string verdict_word(Verdict verdict);

/// Text for the terminal: parameters with intervals, residuals before and after, tests of the model.
std::string calibration_text(const Calibration& calibration);
/// Complete JSON: schema posewright/calibration/1.
/// @param table  of the calibrated arm; empty: none was asked for
nlohmann::ordered_json calibration_json(const Problem& problem, const CalibrateOptions& options,
                                        const Calibration& calibration, const std::optional<DhTable>& table = {});

/// Several models of one robot, judged on the same data; schema posewright/calibrations/1.
std::string models_text(const std::vector<Calibration>& models);
nlohmann::ordered_json models_json(const Problem& problem, const CalibrateOptions& options,
                                   const std::vector<Calibration>& models);

/// Constants of a compensator from listed compliances; schema posewright/compensator/1.
std::string compensator_text(const CompensatorConstants& constants);
nlohmann::ordered_json compensator_json(const Problem& problem, const CalibrateOptions& options,
                                        const CompensatorConstants& constants);

/// The map of a platform's deformation as a picture: displacement of every joint centre over its own actuator,
/// measured, by κ and by K.
std::string platform_svg(const PlatformDeformation& platform);

}  // namespace posewright
