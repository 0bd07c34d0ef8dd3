#include "posewright/calibration/leave_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "posewright/calibration/gain_in_range.hpp"
#include "posewright/calibration/placing_columns.hpp"
#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr int most_single = 30, groups_above = 10;
// A combination that the readings tell worse than this many tolerances is worth a name.
constexpr double weak = 3.0;
constexpr double negligible = 0.2;
constexpr std::size_t most_named = 6;
// Squares that differ by less, relatively, are the same.
constexpr double rounding_of_squares = 1e-7;

/// Mean square of the whitened residuals of every pose.
void add_squares(const IdentificationModel& model, const std::vector<double>& correction,
                 const std::vector<MeasuredPose>& poses, std::vector<double>& squares) {
  const std::vector<Eigen::VectorXd> residuals = residuals_of(model, correction, poses);
  Linearisation at;
  Eigen::VectorXd y;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::vector<int> read = judging(model, poses[k].y);
    if (!linearise_at(model, poses[k], correction, {}, at, y)) throw CannotDo("a pose is out of reach");
    factorise_covariance(at.covariance(read, read), at.factor);
    Eigen::VectorXd r = residuals[k](read);
    at.factor.matrixL().solveInPlace(r);
    squares.push_back(r.squaredNorm() / double(read.size()));
  }
}

double summary(std::vector<double> squares, Weighting weighting) {
  if (weighting != Weighting::robust)
    return std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / double(squares.size()));
  const auto middle = squares.begin() + std::ptrdiff_t(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return std::sqrt(*middle);
}

/// Mean of placed − estimated in standard errors of that mean; robust: how many gain, beyond half of them. Where both
/// predict the same but for rounding there is no gain.
double gain_of(const std::vector<double>& estimated, const std::vector<double>& placed, Weighting weighting) {
  const auto n = double(estimated.size());
  double better = 0;
  std::vector<double> gains;
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    const double gain = placed[k] - estimated[k];
    if (!std::isfinite(gain)) return -std::numeric_limits<double>::infinity();
    gains.push_back(std::abs(gain) > rounding_of_squares * (placed[k] + estimated[k]) ? gain : 0.0);
    better += gains.back() > 0 ? 1 : 0;
  }
  if (weighting == Weighting::robust) return (better - n / 2) / std::sqrt(n / 4);
  return mean_in_standard_errors(gains);
}

/// Estimates from `rest` and adds how far the others are off; false, and why, if there is no estimate.
bool predict_others(const IdentificationModel& model, const VariantColumns& columns, const FitOptions& options,
                    const std::vector<MeasuredPose>& rest, const std::vector<MeasuredPose>& others,
                    std::vector<double>& squares, std::string& why_not) {
  try {
    const Fit result = fit(model, columns, rest, options);
    if (!result.converged) throw CannotDo("the estimate does not converge without some of the poses");
    add_squares(model, result.correction, others, squares);
    return true;
  } catch (const CannotDo& error) {
    why_not = error.what();
    return false;
  }
}

std::size_t groups_of(std::size_t poses) { return poses > most_single ? groups_above : poses; }

/// One pose hardly tells how large the tolerances of all parameters are: they count as in the whole estimate.
FitOptions as_estimated(FitOptions options, const Fit& whole) {
  options.start = whole.correction;
  options.components = false;
  options.spreads = whole.spreads;
  return options;
}

/// Help of instrument k; none where nothing is left to judge by.
std::optional<InstrumentHelp> help_of(double k, std::size_t at, const IdentificationModel& model,
                                      const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
                                      FitOptions options, const Fit& whole, const LeaveOut& judged,
                                      const Monitor& monitor) {
  std::vector<MeasuredPose> kept;
  for (const MeasuredPose& pose : poses)
    if (pose.q[at] != k) kept.push_back(pose);
  const std::size_t groups = groups_of(poses.size());
  InstrumentHelp help;
  const VariantColumns left = determined(model, columns, kept, whole.correction, options.prior);
  for (std::size_t j = 0; j < columns.selected.size(); ++j) {
    if (std::ranges::count(left.selected, columns.selected[j]) > 0) continue;
    // Nominal, as if this instrument had told nothing of them.
    options.start[std::size_t(columns.selected[j])] = 0.0;
    if (columns.parameters[j].role != Role::nuisance) help.alone.push_back(columns.parameters[j].name);
  }
  std::vector<double> with, without;
  std::string none;
  std::size_t n = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    if (monitor.should_stop()) return std::nullopt;
    std::vector<MeasuredPose> rest, others;
    for (std::size_t i = g; i < poses.size(); i += groups, ++n) {
      if (poses[i].q[at] == k || poses[i].noise_factor > 1) continue;
      others.push_back(poses[i]);
      with.push_back(judged.squares[n]);
    }
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (i % groups != g && poses[i].q[at] != k) rest.push_back(poses[i]);
    if (others.empty()) continue;
    if (!predict_others(model, left, options, rest, others, without, none))
      without.resize(with.size(), std::numeric_limits<double>::infinity());
  }
  if (with.size() < 2) return std::nullopt;
  help.with = summary(with, options.weighting);
  help.without = summary(without, options.weighting);
  help.gain =
      std::isfinite(help.without) ? gain_of(with, without, options.weighting) : std::numeric_limits<double>::infinity();
  return help;
}

}  // namespace

void judge_help(const IdentificationModel& model, const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
                const FitOptions& options, const Fit& whole, const LeaveOut& judged, const Monitor& monitor,
                std::vector<InstrumentResiduals>& instruments) {
  const std::optional<std::size_t> at = instrument_index(model.coordinates());
  if (!at || judged.squares.size() != poses.size()) return;
  for (std::size_t k = 0; k < instruments.size(); ++k)
    if (instruments[k].poses > 0)
      instruments[k].help =
          help_of(double(k), *at, model, columns, poses, as_estimated(options, whole), whole, judged, monitor);
}

LeaveOut leave_out(const IdentificationModel& model, const VariantColumns& columns,
                   const std::vector<MeasuredPose>& poses, const FitOptions& options, const std::vector<double>& start,
                   const Fit& whole, const Monitor& monitor) {
  LeaveOut result;
  VariantColumns place = placing_columns(columns);
  if (place.selected.size() == columns.selected.size()) {
    result.why_not = "only base, tool and targets are estimated";
    return result;
  }
  place = place.selected.empty() ? place : determined(model, place, poses, start, options.prior);
  const std::size_t groups = groups_of(poses.size());
  if (groups < 2) {
    result.why_not = "a single pose";
    return result;
  }
  std::vector<double> estimated, placed;
  FitOptions place_options = options;
  for (std::size_t g = 0; g < groups; ++g) {
    if (monitor.should_stop()) {
      result.why_not = "stopped early";
      return result;
    }
    std::vector<MeasuredPose> rest, others;
    for (std::size_t k = 0; k < poses.size(); ++k) (k % groups == g ? others : rest).push_back(poses[k]);
    std::string none;
    place_options.start = start;
    if (place.selected.empty()) add_squares(model, start, others, placed);
    else if (!predict_others(model, place, place_options, rest, others, placed, none)) continue;
    if (!predict_others(model, columns, as_estimated(options, whole), rest, others, estimated, result.why_not))
      estimated.resize(placed.size(), std::numeric_limits<double>::infinity());
    monitor.report({"leaving poses out", double(g + 1), double(groups), {}, {}, {}});
  }
  if (placed.size() < 2) {
    result.why_not = "too few poses to leave one out";
    return result;
  }
  result.groups = int(groups);
  result.estimated = summary(estimated, options.weighting);
  result.placed = summary(placed, options.weighting);
  result.gain = gain_of(estimated, placed, options.weighting);
  result.gain_in_range = gain_in_range(model, columns, poses, start, whole);
  result.squares = std::move(estimated);
  return result;
}

std::string weakest_combination(const Fit& result, const VariantColumns& columns) {
  if (result.root.size() == 0) return "";
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(result.root, Eigen::ComputeFullV);
  const Eigen::Index m = result.root.cols();
  const double least = result.root.rows() < m ? 0.0 : svd.singularValues()[m - 1];
  if (least * weak > 1) return "";
  const Eigen::VectorXd v = svd.matrixV().col(m - 1);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(m));
  std::iota(order.begin(), order.end(), Eigen::Index(0));
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return std::abs(v[a]) > std::abs(v[b]); });
  std::string names;
  for (std::size_t i = 0; i < std::min(order.size(), most_named); ++i) {
    const double share = v[order[i]];
    if (std::abs(share) < negligible * std::abs(v[order[0]])) break;
    names += fmt::format("{}{:.2g} {}", i == 0 ? (share < 0 ? "−" : "") : (share < 0 ? " − " : " + "), std::abs(share),
                         columns.parameters[std::size_t(order[i])].name);
  }
  return names + (least > 0 ? fmt::format(" (in tolerances) has σ of {:.3g} tolerances", 1 / least)
                            : " (in tolerances) is not determined");
}

}  // namespace posewright
