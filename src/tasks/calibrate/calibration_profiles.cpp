#include "calibration_profiles.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"

namespace posewright {

ProfileChoice profile_choice(const std::string& text) {
  if (text == "auto") return {};
  if (text == "none") return {ProfileChoice::none};
  if (text == "all") return {ProfileChoice::named, {"*"}};
  ProfileChoice result{ProfileChoice::named};
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end == begin)
      throw InputError({}, "profile: '" + text + "' has an empty name", "auto, none, all, or names of parameters");
    result.names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

const ProfileInterval* ProfiledColumns::of(int column) const {
  const auto at = std::find(columns.begin(), columns.end(), column);
  if (at == columns.end()) return nullptr;
  const auto& interval = profiles.intervals[std::size_t(at - columns.begin())];
  return interval ? &*interval : nullptr;
}

std::vector<int> columns_to_profile(const CalibrateOptions& options, const VariantColumns& columns) {
  std::vector<int> named;
  if (options.profile.choice != ProfileChoice::named) return named;
  for (const std::string& pattern : options.profile.names) {
    const std::vector<int> found = columns_named(columns, pattern);
    if (found.empty()) {
      std::vector<std::string> names;
      for (const Parameter& p : columns.parameters) names.push_back(p.name);
      throw InputError(
          {},
          fmt::format("profile: '{}' matches no parameter that is estimated{}", pattern, meant_instead(pattern, names)),
          fmt::format("estimated: {}", fmt::join(names, ", ")));
    }
    named.insert(named.end(), found.begin(), found.end());
  }
  std::sort(named.begin(), named.end());
  named.erase(std::unique(named.begin(), named.end()), named.end());
  return named;
}

ProfiledColumns profiles_of(const ProfiledFit& fitted, const CalibrateOptions& options, const std::vector<int>& named,
                            double stretch, Calibration& calibration, const Monitor& monitor) {
  ProfiledColumns result;
  const Fit& fit = calibration.fit;
  if (options.profile.choice == ProfileChoice::none || options.weighting == Weighting::robust || !fit.converged)
    return result;
  for (const int j : options.profile.choice == ProfileChoice::named ? named : calibration.curvature.bent) {
    CalibratedParameter parameter;
    parameter.label = fitted.columns.parameters[std::size_t(j)];
    if (turned_frame(calibration, parameter) == nullptr) result.columns.push_back(j);
  }
  if (result.columns.empty()) return result;
  result.profiles = profile_intervals(fitted.model, fitted.columns, fitted.poses, fitted.options, fit, result.columns,
                                      stretch, options.threads, monitor);
  const auto missing = std::count(result.profiles.intervals.begin(), result.profiles.intervals.end(), std::nullopt);
  if (missing == 0) return result;
  calibration.notes.push_back(fmt::format("{}: {} of the {} profile intervals {} linear",
                                          monitor.should_stop() ? "stopped early" : "the fit failed near the estimate",
                                          missing, result.columns.size(), missing == 1 ? "is" : "are"));
  return result;
}

}  // namespace posewright
