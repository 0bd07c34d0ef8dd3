#include "recompute.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/support/json.hpp"

namespace posewright {

double recomputed_log_det(const Problem& problem, const std::string& variant,
                          const std::vector<std::vector<double>>& poses) {
  const VariantSpec& spec = find_variant(problem, variant);
  const auto model = make_model({problem, spec});
  const VariantColumns columns = select_columns(*model, {problem, spec});
  const auto m = Eigen::Index(columns.selected.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(m, m);
  Linearisation scratch;
  for (const std::vector<double>& q : poses) {
    if (!model->linearise(q, {}, columns.selected, scratch)) return std::nan("");
    information += scratch.G.transpose() * scratch.covariance.inverse() * scratch.G;
  }
  const auto log_det = [](const Eigen::MatrixXd& a) {
    const Eigen::VectorXd scale = a.diagonal().cwiseSqrt();
    const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * a * scale.cwiseInverse().asDiagonal();
    return scaled.ldlt().vectorD().array().log().sum() + 2 * scale.array().log().sum();
  };
  return log_det(information) -
         (columns.nuisance > 0 ? log_det(information.topLeftCorner(columns.nuisance, columns.nuisance)) : 0.0);
}

std::vector<std::vector<double>> configurations_of(const Problem& problem, const Plan& plan) {
  const auto model = make_model({problem, find_variant(problem, plan.variant)});
  std::vector<std::vector<double>> poses;
  for (const PlannedPose& pose : plan.poses) {
    std::vector<double> q;
    std::size_t next = 0;
    for (const Coordinate& c : model->coordinates()) {
      if (!c.choice()) {
        q.push_back(pose.configuration.at(next++).value);
        continue;
      }
      const auto at = std::find(c.labels.begin(), c.labels.end(), label_of(pose.choices, c.name));
      q.push_back(at == c.labels.end() ? -1 : c.values[std::size_t(at - c.labels.begin())]);
    }
    poses.push_back(std::move(q));
  }
  return poses;
}

PlanFile read_back(const std::string& text) {
  const auto json = parse_json(text);
  PlanFile plan;
  plan.variant = json.value("variant", "");
  plan.log_det = json.at("criterion").at("log_det");
  plan.log_det_bound = json.at("certificate").at("candidates").at("log_det_bound");
  plan.efficiency = json.at("certificate").at("candidates").at("efficiency");
  for (const auto& pose : json.at("poses")) {
    plan.candidates.push_back(pose.at("candidate").is_null() ? -1 : pose.at("candidate").get<int>());
    if (pose.contains("configuration")) plan.poses.push_back(pose.at("configuration"));
  }
  return plan;
}

std::vector<std::vector<double>> read_back_csv(const std::string& csv, std::size_t columns) {
  std::vector<std::vector<double>> poses;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    poses.emplace_back();
    while (poses.back().size() < columns && std::getline(cells, cell, ',')) poses.back().push_back(std::stod(cell));
  }
  return poses;
}

}  // namespace posewright
