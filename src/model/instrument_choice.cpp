#include "posewright/model/instrument_choice.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "posewright/model/campaigns.hpp"

namespace posewright {

InstrumentChoice::InstrumentChoice(std::vector<InstrumentOfList> instruments) {
  // Of the same robot: without tool.*, which are its last, where all targets stand for the tool.
  const ExplicitModel& whole = *std::ranges::max_element(instruments, {}, [](const InstrumentOfList& one) {
                                  return one.model->tip_parameters();
                                })->model;
  parameters_.assign(whole.parameters().begin(), whole.parameters().begin() + whole.tip_parameters());
  for (const Preference& preference : whole.geometric_parameters())
    if (preference.parameter < whole.tip_parameters()) geometric_.push_back(preference);
  coordinates_ = whole.tip().coordinates();
  actuators_ = whole.tip().actuators();
  tips_ = 1;
  tip_coordinates_ = coordinates_.size();
  std::vector<std::string> names;
  for (InstrumentOfList& one : instruments) {
    names.push_back(one.name);
    Part part{nullptr, one.noise_factor * one.noise_factor, one.together, {}, {}, {}};
    part.parameters.resize(std::size_t(one.model->tip_parameters()));
    std::iota(part.parameters.begin(), part.parameters.end(), 0);
    if (one.together) find_own(one, part);
    else add_own(one, part);
    if (!one.moving.empty()) moving_coordinates_.push_back(std::move(one.moving));
    part.model = std::move(one.model);
    parts_.push_back(std::move(part));
  }
  for (Part& part : parts_) {
    part.inside.assign(parameters_.size(), -1);
    for (std::size_t i = 0; i < part.parameters.size(); ++i) part.inside[std::size_t(part.parameters[i])] = int(i);
  }
  coordinates_.push_back(make_choice(instrument_coordinate, names));
}

/// Appends its parameters, readings and rows.
void InstrumentChoice::add_own(const InstrumentOfList& instrument, Part& part) {
  const ExplicitModel& model = *instrument.model;
  const int own = int(parameters_.size());
  for (const Preference& preference : model.geometric_parameters())
    if (preference.parameter >= model.tip_parameters())
      geometric_.push_back({own + preference.parameter - model.tip_parameters(), preference.tier});
  for (std::size_t i = std::size_t(model.tip_parameters()); i < model.parameters().size(); ++i) {
    part.parameters.push_back(int(parameters_.size()));
    parameters_.push_back(model.parameters()[i]);
    parameters_.back().name = name_in(instrument.name, parameters_.back().name);
  }
  for (const Reading& reading : model.readings())
    readings_.push_back({reading_in(instrument.name, reading.name), reading.unit});
  if (const std::string& reason = model.unmeasurable_reason();
      !reason.empty() && unmeasurable_reason_.find(reason) == std::string::npos)
    unmeasurable_reason_ += (unmeasurable_reason_.empty() ? "" : " or ") + reason;
  for (int i = 0; i < model.rows(); ++i) part.rows.push_back(rows_++);
}

/// Finds them among those of the instruments before it.
void InstrumentChoice::find_own(const InstrumentOfList& instrument, Part& part) const {
  const ExplicitModel& model = *instrument.model;
  const auto index_of = [](const auto& all, const std::string& name) {
    return std::ranges::find(all, name, [](const auto& one) { return one.name; }) - all.begin();
  };
  for (std::size_t i = std::size_t(model.tip_parameters()); i < model.parameters().size(); ++i)
    part.parameters.push_back(int(index_of(parameters_, model.parameters()[i].name)));
  for (const Reading& reading : model.readings()) part.rows.push_back(index_of(readings_, reading.name));
}

std::vector<double> InstrumentChoice::correction_of(const Part& part, std::span<const double> correction) const {
  std::vector<double> own;
  if (correction.empty()) return own;
  for (const int i : part.parameters) own.push_back(correction[std::size_t(i)]);
  return own;
}

/// −1: this instrument's readings do not depend on it.
int InstrumentChoice::index_in(const Part& part, int index) const {
  if (const int k = index - tip_column(0, 0); k >= 0) return part.model->tip_column(0, k);
  return part.inside[std::size_t(index)];
}

InstrumentChoice::Inside InstrumentChoice::inside(const Point& at, std::span<const int> selected) const {
  const Part& part = part_at(at.q);
  Inside there{
      *part.model, part.variance, part.rows, {at.q.begin(), at.q.end() - 1}, correction_of(part, at.correction), {},
      {}};
  // A single station is a choice without a choice.
  there.q.resize(part.model->coordinates().size(), 0.0);
  for (std::size_t j = 0; j < selected.size(); ++j)
    if (const int own = index_in(part, selected[j]); own >= 0) {
      there.selected.push_back(own);
      there.selected_at.push_back(Eigen::Index(j));
    }
  return there;
}

Point InstrumentChoice::tip_point(const Part& part, const Point& at) const {
  const std::size_t count = at.correction.empty() ? 0 : std::size_t(part.model->tip_parameters());
  return {at.q.first(at.q.size() - 1), at.correction.first(count), at.chosen};
}

namespace {

/// Its rows' part of what all rows are given with.
void share_of_rows(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& rows, Eigen::MatrixXd& own) {
  if (all.size() > 0) own = all(rows, rows);
  else own.resize(0, 0);
}

/// Unit noise of all rows but those of one instrument.
void spread_covariance(const Eigen::MatrixXd& own, double variance, const std::vector<Eigen::Index>& rows,
                       Eigen::Index count, Eigen::MatrixXd& all) {
  all.setIdentity(count, count);
  all(rows, rows) = variance * own;
}

}  // namespace

bool InstrumentChoice::do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const {
  static thread_local Linearisation own;
  const Inside there = inside(at, selected);
  const std::vector<Eigen::Index>& rows = there.rows;
  share_of_rows(out.reading_share, rows, own.reading_share);
  if (!there.model.linearise(there.q, there.correction, there.selected, own)) return false;
  out.G.setZero(rows_, Eigen::Index(selected.size()));
  for (std::size_t j = 0; j < there.selected.size(); ++j)
    out.G(rows, there.selected_at[j]) = own.G.col(Eigen::Index(j));
  spread_covariance(own.covariance, there.variance, rows, rows_, out.covariance);
  return true;
}

int InstrumentChoice::do_block_rows(std::span<const int> selected) const {
  int most = 0;
  for (const Part& part : parts_) {
    std::vector<int> own;
    for (const int i : selected)
      if (const int inside = index_in(part, i); inside >= 0) own.push_back(inside);
    most = std::max(most, part.model->block_rows(own));
  }
  return most;
}

/// An instrument that does not factor its rows has them as a basis of themselves.
bool InstrumentChoice::do_linearise_factored(const Point& at, std::span<const int> selected, Linearisation& out) const {
  static thread_local Linearisation own;
  const Inside there = inside(at, selected);
  const ExplicitModel& model = there.model;
  const std::vector<Eigen::Index>& rows = there.rows;
  const Eigen::Index width = do_block_rows(selected);
  share_of_rows(out.reading_share, rows, own.reading_share);
  const int own_width = model.block_rows(there.selected);
  out.basis.setZero(rows_, width);
  out.coefficients.setZero(width, Eigen::Index(selected.size()));
  if (own_width < model.rows()) {
    if (!model.linearise_factored(there.q, there.correction, there.selected, own)) return false;
    out.basis(rows, Eigen::seqN(0, own_width)) = own.basis;
    for (std::size_t j = 0; j < there.selected.size(); ++j)
      out.coefficients.col(there.selected_at[j]).head(own_width) = own.coefficients.col(Eigen::Index(j));
    out.random_coefficients.setZero(width, own.random_coefficients.cols());
    out.random_coefficients.topRows(own_width) = own.random_coefficients;
  } else {
    if (!model.linearise(there.q, there.correction, there.selected, own)) return false;
    for (Eigen::Index i = 0; i < model.rows(); ++i) out.basis(rows[std::size_t(i)], i) = 1.0;
    for (std::size_t j = 0; j < there.selected.size(); ++j)
      out.coefficients.col(there.selected_at[j]).head(model.rows()) = own.G.col(Eigen::Index(j));
    out.random_coefficients.resize(width, 0);
  }
  spread_covariance(own.covariance, there.variance, rows, rows_, out.covariance);
  return true;
}

bool InstrumentChoice::do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                                    const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const {
  // Nominal values of their own are this model's, and those inside would differentiate where they are not.
  if (!at.correction.empty()) return false;
  const Inside there = inside(at, selected);
  const std::vector<Eigen::Index>& rows = there.rows;
  std::vector<double> own(there.q.size());
  if (!there.model.pull_back(there.q, there.selected, by_G(rows, there.selected_at),
                             there.variance * by_covariance(rows, rows), own))
    return false;
  std::copy_n(own.begin(), gradient.size() - 1, gradient.begin());
  return true;
}

/// By robot and instrument themselves: the model around them has settled the robot already.
bool InstrumentChoice::do_read(const Point& at, Eigen::VectorXd& y) const {
  const Part& part = part_at(at.q);
  const std::vector<double> correction = correction_of(part, at.correction);
  Eigen::VectorXd own(part.model->rows());
  if (!part.model->read_settled({at.q.first(at.q.size() - 1), correction, at.chosen}, own)) return false;
  y.setConstant(rows_, std::numeric_limits<double>::quiet_NaN());
  y(part.rows) = own;
  return true;
}

template <class Apply>
void InstrumentChoice::segment_by_segment(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& out,
                                          const Apply& apply) const {
  Eigen::VectorXd all(rows_), own;
  for (const Part& part : parts_) {
    if (part.together) continue;
    apply(*part.model, a(part.rows), b(part.rows), own);
    all(part.rows) = own;
  }
  out = std::move(all);
}

void InstrumentChoice::do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                                     Eigen::VectorXd& out) const {
  segment_by_segment(measured, predicted, out, [](const ExplicitModel& model, const auto& a, const auto& b, auto& own) {
    model.difference(a, b, own);
  });
}

void InstrumentChoice::do_shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change,
                                  Eigen::VectorXd& out) const {
  segment_by_segment(predicted, change, out, [](const ExplicitModel& model, const auto& a, const auto& b, auto& own) {
    model.shifted(a, b, own);
  });
}

bool InstrumentChoice::do_configuration_at(std::span<const double> actuators, const Point& start,
                                           std::span<double> q) const {
  std::copy(start.q.begin(), start.q.end(), q.begin());
  const Part& part = part_at(start.q);
  return part.model->tip().configuration_at(actuators, tip_point(part, start), q.first(q.size() - 1));
}

void InstrumentChoice::do_take_loads_at(std::span<const double> correction) {
  for (const Part& part : parts_) part.model->take_loads_at(correction_of(part, correction));
}

bool InstrumentChoice::do_measurable(const Point& at) const {
  const Inside there = inside(at, {});
  return there.model.measurable(there.q, there.correction);
}

bool InstrumentChoice::do_actuator_values(const Point& at, std::span<double> values) const {
  const Part& part = part_at(at.q);
  return part.model->tip().actuator_values(tip_point(part, at), values);
}

Eigen::Isometry3d InstrumentChoice::do_tool_pose(const Point& at) const {
  const Part& part = part_at(at.q);
  Twists none;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  part.model->tip().linearise(tip_point(part, at), {}, X, none, nullptr);
  return X;
}

bool InstrumentChoice::do_reading_twists(const Point& at, Twists& twists) const {
  const Part& part = part_at(at.q);
  Twists none;
  Eigen::Isometry3d X;
  return part.model->tip().linearise(tip_point(part, at), {}, X, none, &twists);
}

void InstrumentChoice::do_blank_unread(std::span<const double> q, Eigen::VectorXd& y) const {
  const Part& reads = part_at(q);
  const Eigen::VectorXd own = y(reads.rows);
  y.setConstant(std::numeric_limits<double>::quiet_NaN());
  y(reads.rows) = own;
}

std::string reading_in(const std::string& instrument, const std::string& reading) { return instrument + "." + reading; }

const MeasurementSpec& instrument_at(const MeasurementSpec& measurement, const std::vector<Coordinate>& coordinates,
                                     std::span<const double> q) {
  const std::vector<MeasurementSpec>* instruments = instruments_of(measurement);
  if (instruments == nullptr) return measurement;
  return (*instruments)[std::size_t(q[*instrument_index(coordinates)])];
}

std::optional<std::size_t> instrument_index(const std::vector<Coordinate>& coordinates) {
  const auto at = std::ranges::find(coordinates, instrument_coordinate, &Coordinate::name);
  if (at == coordinates.end()) return std::nullopt;
  return std::size_t(at - coordinates.begin());
}

Eigen::Index pose_row(const std::vector<Coordinate>& coordinates, std::span<const double> q) {
  const auto instrument = instrument_index(coordinates);
  return instrument ? 6 * Eigen::Index(q[*instrument]) : 0;
}

}  // namespace posewright
