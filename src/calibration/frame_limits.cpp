#include "posewright/calibration/frame_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "posewright/support/dense.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

// 1σ of a limit, m and rad: far beyond what a drawing or a rigid fit may be off.
constexpr double limit = 1.0;
// Of the unit information: double precision tells no direction worse than this.
constexpr double untold = 1e-24;
constexpr double small_share = 0.2;
constexpr int random_configurations = 200;
constexpr std::uint64_t size_stream = 0x512e;

bool stands_anywhere(const std::string& name) {
  constexpr std::array<std::string_view, 3> frames = {"base", "station", "anchor"};
  return std::ranges::count(frames, std::string_view(name).substr(0, name.find_first_of(".@"))) > 0;
}

bool is_free(const Parameter& p, Prior prior) { return p.places && !counts(p, prior); }

/// Covariance in units of tolerance by the readings and the tolerances that count.
Eigen::MatrixXd covariance_of_data(const VariantColumns& columns, Prior prior, const Fit& result) {
  const double noise = result.scale_known ? result.noise_factor : std::max(result.scale, 1e-12);
  Eigen::MatrixXd information = result.root.transpose() * result.root / (noise * noise);
  for (std::size_t j = 0; j < columns.parameters.size(); ++j)
    if (counts(columns.parameters[j], prior))
      information(Eigen::Index(j), Eigen::Index(j)) += std::pow(result.spreads[std::size_t(columns.selected[j])], -2);
  const Eigen::VectorXd unit = information.diagonal().cwiseSqrt().cwiseMax(1e-150).cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(
      Eigen::MatrixXd(unit.asDiagonal() * information * unit.asDiagonal()));
  const Eigen::VectorXd told = principal.eigenvalues().cwiseMax(untold * double(columns.parameters.size()));
  const Eigen::MatrixXd half =
      unit.asDiagonal() * principal.eigenvectors() * told.cwiseSqrt().cwiseInverse().asDiagonal();
  return half * half.transpose();
}

}  // namespace

std::vector<WeakLimit> frame_limits(const IdentificationModel& model, const VariantColumns& columns, Prior prior,
                                    const std::vector<double>& placed) {
  std::vector<WeakLimit> limits;
  for (std::size_t j = 0; j < columns.parameters.size(); ++j) {
    const Parameter& p = columns.parameters[j];
    if (prior == Prior::none || !is_free(p, prior)) continue;
    const auto i = std::size_t(columns.selected[j]);
    if (!stands_anywhere(model.parameters()[i].name)) limits.push_back({int(i), 0.0, limit});
    else if (!placed.empty()) limits.push_back({int(i), placed[i], limit});
  }
  return limits;
}

std::string LooseDirection::text() const {
  std::string text;
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    if (std::abs(direction[k]) < small_share * direction.maxCoeff()) continue;
    const bool negative = direction[k] < 0;
    text += fmt::format("{}{:.2g} {}", text.empty() ? (negative ? "−" : "") : (negative ? " − " : " + "),
                        std::abs(direction[k]), columns[std::size_t(k)]);
  }
  return text;
}

std::optional<LooseDirection> loose_direction(const VariantColumns& columns, Prior prior, const Fit& result,
                                              double size) {
  if (result.root.size() == 0) return std::nullopt;
  const Eigen::VectorXd tolerances = tolerances_of(columns);
  const Eigen::MatrixXd covariance =
      tolerances.asDiagonal() * covariance_of_data(columns, prior, result) * tolerances.asDiagonal();
  std::optional<LooseDirection> loosest;
  double most = 1.0;
  for (const char* unit : {"m", "rad"}) {
    LooseDirection found{unit, 0.0, {}};
    std::vector<Eigen::Index> at;
    for (std::size_t j = 0; j < columns.parameters.size(); ++j) {
      const Parameter& p = columns.parameters[j];
      if (!is_free(p, prior) || p.unit != unit) continue;
      at.push_back(Eigen::Index(j));
      found.columns.push_back(p.name);
    }
    if (at.empty()) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(Eigen::MatrixXd(covariance(at, at)));
    found.sigma = std::sqrt(std::max(0.0, principal.eigenvalues()[Eigen::Index(at.size()) - 1]));
    const double times = found.sigma / (found.unit == "m" ? size : limit);
    if (!(times > most)) continue;
    most = times;
    found.direction = principal.eigenvectors().col(Eigen::Index(at.size()) - 1);
    Eigen::Index main = 0;
    found.direction.cwiseAbs().maxCoeff(&main);
    if (found.direction[main] < 0) found.direction *= -1;
    loosest = std::move(found);
  }
  return loosest;
}

double size_of(const IdentificationModel& model) {
  Random random(0, size_stream);
  std::vector<Eigen::Vector3d> tips;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Linearisation out;
  for (int i = 0; i < random_configurations; ++i) {
    std::vector<double> q;
    for (const Coordinate& c : model.coordinates())
      q.push_back(c.discrete() ? c.values.front() : random.uniform(c.lower, c.upper));
    if (!model.linearise(q, {}, {}, out)) continue;
    tips.push_back(model.tool_pose(q).translation());
    middle += tips.back();
  }
  double size = limit;
  for (const Eigen::Vector3d& tip : tips) size = std::max(size, (tip - middle / double(tips.size())).norm());
  return size;
}

}  // namespace posewright
