#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/support/error.hpp"

namespace posewright {

/// One value of a parameters file.
struct ParameterEntry {
  Located<std::string> name;        ///< the model's name of the parameter, or the user's
  std::string unit;                 ///< as written; empty: not written
  double value = 0.0;               ///< SI
  std::optional<double> nominal{};  ///< of the robot that was calibrated, SI, where the file has it
};

/// A smooth effect that the residuals of the calibration showed.
struct CalibratedEffect {
  double size = 0.0;    ///< 1σ along each axis, m
  double length = 0.0;  ///< rad
};

/// A parameters file (docs/parameters-file.md): where the parameters of a robot are after calibration.
struct CalibratedParameters {
  std::filesystem::path file;
  std::string sha256;            ///< of the file's bytes
  Located<std::string> variant;  ///< that was calibrated
  /// Whose names they are, as VariantSpec::Convention is written: frames, dh, mdh; empty: the variant's.
  std::string convention;
  std::vector<ParameterEntry> values;
  std::optional<CalibratedEffect> unmodelled{};

  SourcePlace at(int line) const { return {file.string(), line}; }
};

/// Reads a parameters file (YAML, at most 10 MB). Throws InputError with the line of the first thing that is wrong.
CalibratedParameters read_calibrated_parameters(const std::filesystem::path& file);

/// Overload for text in memory; `file` names it in messages.
CalibratedParameters parse_calibrated_parameters(const std::string& text, const std::filesystem::path& file);

}  // namespace posewright
