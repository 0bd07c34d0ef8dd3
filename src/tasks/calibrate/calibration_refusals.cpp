#include "calibration_refusals.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/calibration/gross_errors.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

constexpr std::size_t most_listed = 8;

}  // namespace

void refuse_gross_poses(const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& placed, FitOptions options,
                        const std::vector<std::string>& notes) {
  if (options.weighting == Weighting::robust) return;
  options.start = placed;
  const std::vector<GrossPose> gross = gross_poses(model, columns, poses, options);
  if (gross.empty()) return;
  std::string list;
  for (std::size_t k = 0; k < std::min(most_listed, gross.size()); ++k)
    list += fmt::format("{}{} ({:.3g} times the stated noise)", k == 0 ? "" : ", ", gross[k].id, gross[k].size);
  if (gross.size() > most_listed) list += fmt::format(" and {} more", gross.size() - most_listed);
  std::string noted;
  for (const std::string& note : notes) noted += "; " + note;
  throw CannotDo(
      fmt::format("gross errors at pose{} {}; noise and tolerances explain {:.3g} times, and the other poses fit: "
                  "check for a lost target or a wrong row. Leave it out, or use --weights robust{}",
                  gross.size() == 1 ? "" : "s", list, gross.front().explained, noted));
}

void refuse_conventions(const Problem& problem, const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& placed,
                        const OrientationForm& orientation) {
  const ResidualSize size{residual_rms(model, poses, placed), explained_rms(model, columns, poses, placed)};
  if (!size.unusual()) return;
  const ConventionSearch search = find_conventions(problem, model, poses, orientation);
  if (search.found.empty()) return;
  std::string list;
  for (const Convention& convention : search.found)
    list += fmt::format("{}{} if {}: {}", list.empty() ? "" : "; or ", shown_value(convention.left, "m"),
                        convention.condition, convention.remedy);
  throw CannotDo(fmt::format("base and tool alone leave {}, too much for errors of a robot, and {}",
                             shown_value(search.left, "m"), list));
}

}  // namespace posewright
