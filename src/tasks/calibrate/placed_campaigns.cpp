#include "placed_campaigns.hpp"

#include <algorithm>
#include <optional>

#include "posewright/calibration/placing_columns.hpp"
#include "posewright/model/campaigns.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

std::vector<MeasuredPose> of_campaign(const std::vector<MeasuredPose>& all, std::size_t campaign) {
  std::vector<MeasuredPose> poses;
  for (const MeasuredPose& pose : all)
    if (std::size_t(pose.q.back()) == campaign) poses.push_back(pose);
  return poses;
}

/// Nobody knows where an instrument stands now; a tool is somewhere near where it was.
void start_at_the_first(const IdentificationModel& model, const std::string& campaign, std::vector<double>& placed) {
  for (const auto& [own, first] : campaign_pairs(model, campaign))
    if (!model.parameters()[std::size_t(own)].name.starts_with("base@"))
      placed[std::size_t(own)] = placed[std::size_t(first)];
}

/// Frame that moved before another campaign, with everything else where the first one says that it stands.
void place_campaign(const IdentificationModel& model, const VariantColumns& all, const std::vector<MeasuredPose>& poses,
                    const std::string& campaign, const FitOptions& options, std::vector<double>& placed) {
  std::vector<int> kept;
  const std::vector<int> moved = campaign_parameters(model, campaign);
  for (std::size_t j = 0; j < all.selected.size(); ++j)
    if (std::ranges::find(moved, all.selected[j]) != moved.end()) kept.push_back(int(j));
  if (kept.empty()) return;
  start_at_the_first(model, campaign, placed);
  const std::vector<double> found = placed_moved(model, subset(all, kept), poses, options, placed);
  for (const int i : moved) placed[std::size_t(i)] = found[std::size_t(i)];
}

/// The estimate alone; none if it cannot be made.
std::optional<Fit> fit_alone(const Problem& problem, CalibrateOptions options, const Monitor& monitor) {
  options.estimate_alone = true;
  try {
    return calibrate_problem(problem, options, monitor).fit;
  } catch (const CannotDo&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<double> placed_campaigns(const IdentificationModel& model, const VariantColumns& all,
                                     const std::vector<MeasuredPose>& poses, const std::vector<std::string>& campaigns,
                                     const FitOptions& options) {
  if (campaigns.empty()) return placed(model, all, poses, options);
  std::vector<double> result = placed(model, all, of_campaign(poses, 0), options);
  for (std::size_t c = 1; c < campaigns.size(); ++c)
    place_campaign(model, all, of_campaign(poses, c), campaigns[c], options, result);
  return result;
}

bool is_tool_remounted(const Problem& problem, CalibrateOptions options, const Monitor& monitor) {
  constexpr double chance = 1e-4, less = 0.8;
  if (options.weighting != Weighting::weighted) return false;
  const std::optional<Fit> base = fit_alone(problem, options, monitor);
  if (base && base->noise_factor <= 1) return false;
  options.moved = Moved::both;
  const std::optional<Fit> both = fit_alone(problem, options, monitor);
  if (!both || !both->converged) return false;
  if (!base || !base->converged) return true;
  const double added = double(both->covariance.rows() - base->covariance.rows());
  if (!(added > 0) || both->freedom < 1 || !(both->scale < less * base->scale)) return false;
  const double variance = both->chi_square / both->freedom;
  return fisher_exceeded((base->chi_square - both->chi_square) / added / variance, added, both->freedom) < chance;
}

}  // namespace posewright
