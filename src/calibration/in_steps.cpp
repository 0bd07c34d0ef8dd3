#include "posewright/calibration/in_steps.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/calibration/placing_columns.hpp"

namespace posewright {
namespace {

// The published study went through its two steps 280 times; a thousandth of σ is reached or out of reach by then.
constexpr int most_rounds = 300;
constexpr double small_move = 1e-3;

/// Parameters of stiffness: units with a force.
bool gives_way(const Parameter& p) { return p.unit.find('N') != std::string::npos; }

struct Stage {
  std::string name;
  VariantColumns columns;
};

std::vector<Stage> stages_of(const VariantColumns& all) {
  std::vector<int> place, geometry, stiffness;
  for (std::size_t j = 0; j < all.parameters.size(); ++j) {
    const Parameter& p = all.parameters[j];
    (p.places || p.role == Role::nuisance ? place : gives_way(p) ? stiffness : geometry).push_back(int(j));
  }
  std::vector<Stage> stages;
  for (const auto& [name, columns] :
       {std::pair{"base and tool", &place}, std::pair{"geometry", &geometry}, std::pair{"stiffness", &stiffness}})
    if (!columns->empty()) stages.push_back({name, subset(all, *columns)});
  return stages;
}

/// Largest move of a column in units of its σ.
double largest_move(const VariantColumns& columns, const Fit& joint, const std::vector<double>& from,
                    const std::vector<double>& to) {
  double largest = 0;
  for (std::size_t j = 0; j < columns.selected.size(); ++j) {
    const auto i = std::size_t(columns.selected[j]);
    const double sigma = std::sqrt(joint.covariance(Eigen::Index(j), Eigen::Index(j)));
    largest = std::max(largest, std::abs(to[i] - from[i]) / sigma);
  }
  return largest;
}

}  // namespace

StepwiseFit fit_in_steps(const IdentificationModel& model, const VariantColumns& columns,
                         const std::vector<MeasuredPose>& poses, const FitOptions& options, const Fit& joint) {
  const std::vector<Stage> stages = stages_of(columns);
  StepwiseFit result;
  result.correction = options.start;
  result.correction.resize(model.parameters().size(), 0.0);
  while (!result.settled && result.rounds < most_rounds) {
    const std::vector<double> before = result.correction;
    for (const Stage& stage : stages) {
      FitOptions step = options;
      step.start = result.correction;
      step.components = false;
      step.spreads = joint.spreads;
      const Fit fitted = fit(model, stage.columns, poses, step);
      result.correction = fitted.correction;
      if (result.rounds == 0)
        result.steps.push_back({stage.name, int(stage.columns.selected.size()),
                                std::sqrt(fitted.chi_square / std::max(1, fitted.readings))});
    }
    ++result.rounds;
    result.settled = stages.size() == 1 || largest_move(columns, joint, before, result.correction) < small_move;
  }
  return result;
}

}  // namespace posewright
