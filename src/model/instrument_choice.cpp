#include "posewright/model/instrument_choice.hpp"

#include <algorithm>
#include <limits>

#include "posewright/model/campaigns.hpp"

namespace posewright {

/// A point and selected parameters as one instrument's model has them.
struct InstrumentChoice::Inside {
  const Part& part;
  Eigen::Index rows;
  std::vector<double> q, correction;
  std::vector<int> selected;              ///< those that it has
  std::vector<Eigen::Index> selected_at;  ///< where these are among all that are selected
};

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
    const ExplicitModel& model = *one.model;
    names.push_back(one.name);
    if (!one.moving.empty()) moving_coordinates_.push_back(std::move(one.moving));
    const int own = int(parameters_.size());
    for (const Preference& preference : model.geometric_parameters())
      if (preference.parameter >= model.tip_parameters())
        geometric_.push_back({own + preference.parameter - model.tip_parameters(), preference.tier});
    for (std::size_t i = std::size_t(model.tip_parameters()); i < model.parameters().size(); ++i) {
      parameters_.push_back(model.parameters()[i]);
      parameters_.back().name = name_in(one.name, parameters_.back().name);
    }
    for (const Reading& reading : model.readings()) readings_.push_back({one.name + "." + reading.name, reading.unit});
    if (const std::string& reason = model.unmeasurable_reason();
        !reason.empty() && unmeasurable_reason_.find(reason) == std::string::npos)
      unmeasurable_reason_ += (unmeasurable_reason_.empty() ? "" : " or ") + reason;
    const int first_row = rows_;
    rows_ += model.rows();
    parts_.push_back({std::move(one.model), first_row, own, one.noise_factor * one.noise_factor});
  }
  coordinates_.push_back(make_choice(instrument_coordinate, names));
}

std::vector<double> InstrumentChoice::correction_of(const Part& part, std::span<const double> correction) const {
  std::vector<double> own;
  if (correction.empty()) return own;
  const auto of_tip = std::size_t(part.model->tip_parameters()), all = part.model->parameters().size();
  const auto first = correction.begin() + part.own;
  own.assign(correction.begin(), correction.begin() + std::ptrdiff_t(of_tip));
  own.insert(own.end(), first, first + std::ptrdiff_t(all - of_tip));
  return own;
}

/// −1: this instrument's readings do not depend on it.
int InstrumentChoice::index_in(const Part& part, int index) const {
  const ExplicitModel& model = *part.model;
  if (const int k = index - tip_column(0, 0); k >= 0) return model.tip_column(0, k);
  if (index < model.tip_parameters()) return index;
  const int own = index - part.own;
  return own >= 0 && own < int(model.parameters().size()) - model.tip_parameters() ? model.tip_parameters() + own : -1;
}

InstrumentChoice::Inside InstrumentChoice::inside(const Point& at, std::span<const int> selected) const {
  const Part& part = part_at(at.q);
  Inside there{part, part.model->rows(), {at.q.begin(), at.q.end() - 1}, correction_of(part, at.correction), {}, {}};
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
void share_of_rows(const Eigen::MatrixXd& all, Eigen::Index first, Eigen::Index rows, Eigen::MatrixXd& own) {
  if (all.size() > 0) own = all.block(first, first, rows, rows);
  else own.resize(0, 0);
}

/// Unit noise of all rows but those of one instrument.
void spread_covariance(const Eigen::MatrixXd& own, double variance, Eigen::Index first, Eigen::Index rows,
                       Eigen::MatrixXd& all) {
  all.setIdentity(rows, rows);
  all.block(first, first, own.rows(), own.rows()) = variance * own;
}

}  // namespace

bool InstrumentChoice::do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const {
  static thread_local Linearisation own;
  const Inside there = inside(at, selected);
  const Eigen::Index first = there.part.first_row;
  share_of_rows(out.reading_share, first, there.rows, own.reading_share);
  if (!there.part.model->linearise(there.q, there.correction, there.selected, own)) return false;
  out.G.setZero(rows_, Eigen::Index(selected.size()));
  for (std::size_t j = 0; j < there.selected.size(); ++j)
    out.G.col(there.selected_at[j]).segment(first, there.rows) = own.G.col(Eigen::Index(j));
  spread_covariance(own.covariance, there.part.variance, first, rows_, out.covariance);
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
  const ExplicitModel& model = *there.part.model;
  const Eigen::Index first = there.part.first_row, width = do_block_rows(selected);
  share_of_rows(out.reading_share, first, there.rows, own.reading_share);
  const int own_width = model.block_rows(there.selected);
  out.basis.setZero(rows_, width);
  out.coefficients.setZero(width, Eigen::Index(selected.size()));
  if (own_width < model.rows()) {
    if (!model.linearise_factored(there.q, there.correction, there.selected, own)) return false;
    out.basis.block(first, 0, there.rows, own_width) = own.basis;
    for (std::size_t j = 0; j < there.selected.size(); ++j)
      out.coefficients.col(there.selected_at[j]).head(own_width) = own.coefficients.col(Eigen::Index(j));
    out.random_coefficients.setZero(width, own.random_coefficients.cols());
    out.random_coefficients.topRows(own_width) = own.random_coefficients;
  } else {
    if (!model.linearise(there.q, there.correction, there.selected, own)) return false;
    out.basis.block(first, 0, there.rows, there.rows).setIdentity();
    for (std::size_t j = 0; j < there.selected.size(); ++j)
      out.coefficients.col(there.selected_at[j]).head(there.rows) = own.G.col(Eigen::Index(j));
    out.random_coefficients.resize(width, 0);
  }
  spread_covariance(own.covariance, there.part.variance, first, rows_, out.covariance);
  return true;
}

bool InstrumentChoice::do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                                    const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const {
  // Nominal values of their own are this model's, and those inside would differentiate where they are not.
  if (!at.correction.empty()) return false;
  const Inside there = inside(at, selected);
  const Eigen::Index first = there.part.first_row;
  const Eigen::MatrixXd rows = by_G.middleRows(first, there.rows);
  std::vector<double> own(there.q.size());
  if (!there.part.model->pull_back(there.q, there.selected, rows(Eigen::all, there.selected_at),
                                   there.part.variance * by_covariance.block(first, first, there.rows, there.rows),
                                   own))
    return false;
  std::copy_n(own.begin(), gradient.size() - 1, gradient.begin());
  return true;
}

/// By robot and instrument themselves: the model around them has settled the robot already.
bool InstrumentChoice::do_read(const Point& at, Eigen::VectorXd& y) const {
  static thread_local Twists none;
  const Part& part = part_at(at.q);
  const Point tip = tip_point(part, at);
  Eigen::Isometry3d X;
  if (!part.model->tip().linearise(tip, {}, X, none, nullptr)) return false;
  const std::vector<double> correction = correction_of(part, at.correction);
  y.setConstant(rows_, std::numeric_limits<double>::quiet_NaN());
  part.model->measurement().read({X, std::span(correction).subspan(tip.correction.size()), 0},
                                 y.segment(part.first_row, part.model->rows()));
  return true;
}

template <class Apply>
void InstrumentChoice::segment_by_segment(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& out,
                                          const Apply& apply) const {
  Eigen::VectorXd all(rows_), own;
  for (const Part& part : parts_) {
    const auto segment = Eigen::seqN(part.first_row, part.model->rows());
    apply(*part.model, a(segment), b(segment), own);
    all(segment) = own;
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
  return there.part.model->measurable(there.q, there.correction);
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
  const auto segment = Eigen::seqN(reads.first_row, reads.model->rows());
  const Eigen::VectorXd own = y(segment);
  y.setConstant(std::numeric_limits<double>::quiet_NaN());
  y(segment) = own;
}

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
