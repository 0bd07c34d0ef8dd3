#include "posewright/model/identification_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "posewright/model/pair_names.hpp"
#include "posewright/support/near_words.hpp"

namespace posewright {
namespace {

void require_size(std::size_t given, std::size_t expected, const char* what) {
  if (given != expected)
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(given) + " values instead of " +
                                std::to_string(expected));
}

}  // namespace

void throw_unknown_coordinate(const SourcePlace& place, const std::string& name,
                              const std::vector<Coordinate>& coordinates) {
  std::string names;
  std::vector<std::string> words;
  for (const Coordinate& c : coordinates)
    if (!c.choice() && !is_second(c.name)) {
      names += (names.empty() ? "allowed: " : ", ") + c.name;
      words.push_back(c.name);
    }
  throw InputError(place, "'" + name + "' is not a coordinate of this robot" + meant_instead(name, words), names);
}

Coordinate make_choice(const std::string& name, const std::vector<std::string>& labels) {
  Coordinate c;
  c.name = name;
  c.upper = double(labels.size()) - 1;
  c.labels = labels;
  for (std::size_t i = 0; i < labels.size(); ++i) c.values.push_back(double(i));
  return c;
}

Coordinate make_approach(const std::string& joint, double overrun) {
  Coordinate c = make_choice(joint + ".approach", {"rising", "falling"});
  c.arrives = joint;
  c.overrun = overrun;
  return c;
}

std::string Coordinate::label_at(double value) const {
  const auto at = std::find(values.begin(), values.end(), value);
  return at == values.end() ? fmt::format("{}", value) : labels[std::size_t(at - values.begin())];
}

PoseChoices choices_at(const std::vector<Coordinate>& coordinates, std::span<const double> q) {
  PoseChoices choices;
  for (const ChoiceKey& key : choice_keys)
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      if (coordinates[i].choice() && coordinates[i].name == key.name)
        choices.emplace_back(key.name, coordinates[i].label_at(q[i]));
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (coordinates[i].labels.size() > 1 && choice_key(coordinates[i].name) == nullptr)
      choices.emplace_back(coordinates[i].name, coordinates[i].label_at(q[i]));
  return choices;
}

Chosen chosen_at(const std::vector<Coordinate>& coordinates, std::span<const double> q) {
  static constexpr std::pair<std::string_view, int Chosen::*> members[] = {{"station", &Chosen::station},
                                                                           {"load_case", &Chosen::load_case}};
  Chosen chosen;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (coordinates[i].choice())
      for (const auto& [name, member] : members)
        if (coordinates[i].name == name) chosen.*member = int(q[i]);
  return chosen;
}

void IdentificationModel::set_nominal(int index, double value) {
  if (shift_.empty()) shift_.assign(parameters_.size(), 0.0);
  Parameter& p = parameters_.at(std::size_t(index));
  shift_[std::size_t(index)] += value - p.nominal;
  p.nominal = value;
  do_take_loads_at(shift_);
}

void IdentificationModel::take_loads_at(std::span<const double> correction) {
  std::vector<double> sum;
  do_take_loads_at(total(correction, sum));
}

Point IdentificationModel::nominal_point(std::span<const double> q) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  return point(q, shift_);
}

void IdentificationModel::do_take_loads_at(std::span<const double>) {}

std::span<const double> IdentificationModel::total(std::span<const double> correction,
                                                   std::vector<double>& scratch) const {
  if (!correction.empty()) require_size(correction.size(), parameters_.size(), "corrections");
  if (shift_.empty()) return correction;
  if (correction.empty()) return shift_;
  scratch.resize(shift_.size());
  for (std::size_t i = 0; i < shift_.size(); ++i) scratch[i] = shift_[i] + correction[i];
  return scratch;
}

Point IdentificationModel::point(std::span<const double> q, std::span<const double> total) const {
  return {q, total, chosen_at(coordinates_, q)};
}

bool IdentificationModel::linearise(std::span<const double> q, std::span<const double> correction,
                                    std::span<const int> selected, Linearisation& out) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  if (!do_linearise(point(q, total(correction, out.correction)), selected, out)) return false;
  hide(q, out);
  return true;
}

bool IdentificationModel::linearise_factored(std::span<const double> q, std::span<const double> correction,
                                             std::span<const int> selected, Linearisation& out) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  if (!do_linearise_factored(point(q, total(correction, out.correction)), selected, out)) return false;
  hide(q, out);
  return true;
}

bool IdentificationModel::pull_back(std::span<const double> q, std::span<const int> selected,
                                    const Eigen::MatrixXd& by_G, const Eigen::MatrixXd& by_covariance,
                                    std::span<double> gradient) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  require_size(gradient.size(), coordinates_.size(), "gradient");
  std::fill(gradient.begin(), gradient.end(), 0.0);
  return do_pull_back(point(q, shift_), selected, by_G, by_covariance, gradient);
}

bool IdentificationModel::do_pull_back(const Point&, std::span<const int>, const Eigen::MatrixXd&,
                                       const Eigen::MatrixXd&, std::span<double>) const {
  return false;
}

/// Moves `at` to where the robot stands with its (total) correction, the actuators as they are with nominal parameters.
bool IdentificationModel::settle(Point& at, std::vector<double>& scratch) const {
  if (actuators_.empty() || at.correction.empty()) return true;
  static thread_local std::vector<double> actuators;
  actuators.resize(actuators_.size());
  scratch.resize(at.q.size());
  Point nominal = at;
  nominal.correction = shift_;
  if (!do_actuator_values(nominal, actuators) || !do_configuration_at(actuators, at, scratch)) return false;
  at.q = scratch;
  return true;
}

bool IdentificationModel::settled(std::span<const double> q, std::span<const double> correction,
                                  std::span<double> settled) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  require_size(settled.size(), coordinates_.size(), "configuration");
  static thread_local std::vector<double> sum, scratch;
  Point at = point(q, total(correction, sum));
  if (!settle(at, scratch)) return false;
  std::copy(at.q.begin(), at.q.end(), settled.begin());
  return true;
}

bool IdentificationModel::predict(std::span<const double> q, std::span<const double> correction,
                                  Eigen::VectorXd& y) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  // A model inside another one has neither actuators nor nominal values of its own, so it leaves these alone.
  static thread_local std::vector<double> sum, scratch;
  Point at = point(q, total(correction, sum));
  y.resize(Eigen::Index(readings_.size()));
  return settle(at, scratch) && do_read(at, y);
}

bool IdentificationModel::predict_and_linearise(std::span<const double> q, std::span<const double> correction,
                                                std::span<const int> selected, Linearisation& out,
                                                Eigen::VectorXd& y) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  Point at = point(q, total(correction, out.correction));
  y.resize(Eigen::Index(readings_.size()));
  if (!settle(at, out.settled) || !do_read(at, y) || !do_linearise(at, selected, out)) return false;
  hide(q, out);
  return true;
}

void IdentificationModel::difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                                     Eigen::VectorXd& out) const {
  do_difference(measured, predicted, out);
}

void IdentificationModel::shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change,
                                  Eigen::VectorXd& out) const {
  do_shifted(predicted, change, out);
}

void IdentificationModel::do_shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change,
                                     Eigen::VectorXd& out) const {
  out = predicted + change;
}

bool IdentificationModel::configuration_at(std::span<const double> actuators, std::span<const double> start,
                                           std::span<double> q) const {
  require_size(start.size(), coordinates_.size(), "configuration");
  require_size(actuators.size(), actuators_.size(), "actuators");
  return do_configuration_at(actuators, point(start, shift_), q);
}

void IdentificationModel::do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                                        Eigen::VectorXd& out) const {
  out = measured - predicted;
}

bool IdentificationModel::do_configuration_at(std::span<const double>, const Point& start, std::span<double> q) const {
  std::copy(start.q.begin(), start.q.end(), q.begin());
  return true;
}

/// A hidden target is not read: its rows tell nothing, and its noise is nobody's.
void IdentificationModel::hide(std::span<const double> q, Linearisation& out) const {
  if (visibility_ == nullptr || rows_per_target_ == 0) return;
  out.seen.resize(std::size_t(visibility_->targets()));
  visibility_->visible(q, out.seen);
  for (std::size_t t = 0; t < out.seen.size(); ++t) {
    if (out.seen[t] != 0) continue;
    for (Eigen::Index i = Eigen::Index(t) * rows_per_target_; i < Eigen::Index(t + 1) * rows_per_target_; ++i) {
      if (out.G.rows() == rows_) out.G.row(i).setZero();
      if (out.basis.rows() == rows_) out.basis.row(i).setZero();
      out.covariance.row(i).setZero();
      out.covariance.col(i).setZero();
      out.covariance(i, i) = 1.0;
    }
  }
}

int IdentificationModel::visible_rows(std::span<const double> q) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(rows_);
  blank_hidden(q, y);
  return rows_ - int(y.array().isNaN().count());
}

void IdentificationModel::blank_hidden(std::span<const double> q, Eigen::VectorXd& y) const {
  do_blank_unread(q, y);
  if (visibility_ == nullptr || rows_per_target_ == 0) return;
  std::vector<char> seen(std::size_t(visibility_->targets()));
  visibility_->visible(q, seen);
  for (std::size_t t = 0; t < seen.size(); ++t)
    if (seen[t] == 0)
      y.segment(Eigen::Index(t) * rows_per_target_, rows_per_target_)
          .setConstant(std::numeric_limits<double>::quiet_NaN());
}

void IdentificationModel::do_blank_unread(std::span<const double>, Eigen::VectorXd&) const {}

bool IdentificationModel::reading_twists(std::span<const double> q,
                                         Eigen::Matrix<double, 6, Eigen::Dynamic>& twists) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  return do_reading_twists(point(q, shift_), twists);
}

bool IdentificationModel::measurable(std::span<const double> q, std::span<const double> correction) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  static thread_local std::vector<double> sum;
  return do_measurable(point(q, total(correction, sum)));
}

bool IdentificationModel::measurable_margins_at(std::span<const double> q, std::span<double> out) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  return do_measurable_margins_at(point(q, shift_), out);
}

std::optional<int> IdentificationModel::do_measurable_margins() const {
  return unmeasurable_reason_.empty() ? std::optional(0) : std::nullopt;
}

bool IdentificationModel::do_measurable_margins_at(const Point&, std::span<double>) const { return true; }

bool IdentificationModel::actuator_values(std::span<const double> q, std::span<double> values) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  require_size(values.size(), actuators_.size(), "actuators");
  return do_actuator_values(point(q, shift_), values);
}

Eigen::Isometry3d IdentificationModel::tool_pose(std::span<const double> q) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  return do_tool_pose(point(q, shift_));
}

int IdentificationModel::do_block_rows(std::span<const int>) const { return rows_; }

bool IdentificationModel::do_linearise_factored(const Point&, std::span<const int>, Linearisation&) const {
  throw std::logic_error("this model does not factor its rows");
}

bool IdentificationModel::do_reading_twists(const Point&, Eigen::Matrix<double, 6, Eigen::Dynamic>&) const {
  return false;
}

bool IdentificationModel::do_measurable(const Point&) const { return true; }

bool IdentificationModel::do_actuator_values(const Point&, std::span<double>) const { return true; }

}  // namespace posewright
