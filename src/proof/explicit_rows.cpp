#include "explicit_rows.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

using Kind = HarmonicNoise::Kind;
using RowMatrix = BlockArray::RowMatrix;

// Steps in which the share of a common displacement is searched.
constexpr int share_steps = 1000;

// A share of the deflections: columns by it are odd beyond their first order, and deflections are small, so that the
// central difference is right to rounding.
constexpr double bent_share = 0.01;

struct ExplicitWork : HarmonicRows::Work {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  Twists twists, readings;
  Eigen::MatrixXd rows;  // of the instrument: columns, then joint readings
  Eigen::MatrixXd bent;  // what deflections make of them
  Eigen::VectorXd y;     // what it reads
  RowMatrix all, parts;  // the same by rows; of all parts
};

InverseVariance plus(InverseVariance variance, double more) {
  variance.constant += more;
  return variance;
}

InverseVariance over_square(InverseVariance variance) {
  variance.over_square = true;
  return variance;
}

/// Readings of a tip by an instrument, with what else is random at a pose taken out as well as constants can (theory.md
/// eq. (40), (41)).
class ExplicitRows : public HarmonicRows {
 public:
  ExplicitRows(const TipModel& tip, const MeasurementModel& measurement, const Repeatability& repeatability,
               int tip_parameters, const Point& at, HarmonicColumns columns)
      : tip_(tip),
        measurement_(measurement),
        noise_(measurement.harmonic_noise()),
        instrument_(noise_.instead != nullptr ? *noise_.instead : measurement),
        chosen_(at.chosen),
        correction_(at.correction.begin(), at.correction.end()),
        selected_(std::move(columns.selected)),
        tip_parameters_(tip_parameters) {
    degrees_ = std::move(columns.degrees);
    factors_ = std::move(columns.factors);
    order_ = columns.order;
    bends_ = columns.bends;
    for (const double sigma : tip.reading_noise())
      if (sigma > 0) joints_ = int(tip.reading_noise().size());
    targets_ = noise_.kind == Kind::beams ? instrument_.rows() / 3 : instrument_.rows();
    take_displacement(repeatability);
    if (noise_.kind == Kind::constant) factorise(repeatability);
    list_parts();
    if (noise_.kind == Kind::beams) take_spreads();
    if (bends_) take_remainders(columns.remainders);
    K_.setZero(joints_, Eigen::Index(selected_.size()));
  }

  void tune(const std::vector<std::vector<double>>& configurations, std::span<const double> weights) override;
  std::unique_ptr<Work> work() const override { return std::make_unique<ExplicitWork>(); }
  bool at(std::span<const double> q, std::span<const double> factors, Work& work, RowMatrix& B,
          std::span<double> squares) const override;

 private:
  std::span<const double> own_correction() const {
    return std::span(correction_).subspan(correction_.empty() ? 0 : std::size_t(tip_parameters_));
  }
  void take_displacement(const Repeatability& repeatability);
  void factorise(const Repeatability& repeatability);
  void list_parts();
  void take_spreads();
  void take_remainders(const std::vector<HarmonicColumns::Remainder>& remainders);
  bool read(std::span<const double> q, std::span<const double> factors, ExplicitWork& w) const;
  bool rows_of_tip(std::span<const double> q, const double* share, ExplicitWork& w) const;
  void to_parts(ExplicitWork& w, std::span<double> squares) const;
  void choose_share(double square);

  const TipModel& tip_;
  const MeasurementModel& measurement_;
  HarmonicNoise noise_;
  const MeasurementModel& instrument_;
  Chosen chosen_;
  std::vector<double> correction_;
  std::vector<int> selected_;
  int tip_parameters_;
  int order_ = 1;
  bool bends_ = false;
  int targets_ = 0;
  int joints_ = 0;             // readings with noise; 0: none
  double displacement_ = 0.0;  // 1σ common to several targets of a tracker, m
  double share_ = 0.0;         // of the targets' mean that counts as displacement
  Eigen::LLT<Eigen::MatrixXd> covariance_;
  Eigen::MatrixXd K_;  // what the joints' readings are off by, for each column
};

/// Displacement of a visit: noise of the reading for one target, shared by several targets.
void ExplicitRows::take_displacement(const Repeatability& repeatability) {
  const double alone = repeatability.independent * repeatability.independent;
  const double common = repeatability.translation * repeatability.translation;
  if (noise_.kind == Kind::constant) return;
  const bool own = targets_ == 1 || noise_.kind == Kind::distances;
  noise_.along = plus(noise_.along, alone + (own ? common : 0.0));
  noise_.across = plus(noise_.across, alone + (own ? common : 0.0));
  if (!own) displacement_ = repeatability.translation;
}

void ExplicitRows::factorise(const Repeatability& repeatability) {
  const Eigen::Isometry3d anywhere = Eigen::Isometry3d::Identity();
  const MeasurementModel::Sighting sighting{anywhere, own_correction(), chosen_.station};
  const Eigen::Index rows = instrument_.rows();
  Eigen::MatrixXd covariance(rows, rows), moved(rows, 3);
  instrument_.covariance(sighting, covariance);
  covariance /= noise_.repeats;
  instrument_.rows_of_twists(sighting, Twists::Identity(6, 3), moved);
  covariance += repeatability.translation * repeatability.translation * moved * moved.transpose();
  const Eigen::Index each = std::max(1, instrument_.rows_per_target());
  for (Eigen::Index first = 0; repeatability.independent > 0 && first + each <= rows; first += each) {
    const Eigen::MatrixXd own = repeatability.independent * moved.middleRows(first, each);
    covariance.block(first, first, each, each) += own * own.transpose();
  }
  factorise_covariance(covariance, covariance_);
}

void ExplicitRows::list_parts() {
  const bool shared = displacement_ > 0;
  const auto part = [&](int rows, int turn, int length, int distance, const InverseVariance& more,
                        const InverseVariance& less) {
    parts_.push_back({rows, turn, length, distance, more, less});
  };
  const InverseVariance one{1.0}, none{};
  if (noise_.kind == Kind::constant) part(instrument_.rows(), order_, order_, -1, one, none);
  if (noise_.kind == Kind::beams) {
    distances_ = targets_;
    const InverseVariance across_taken = over_square(noise_.across);
    for (int t = 0; t < targets_; ++t) {
      part(3, 1, 1, t, noise_.across, none);
      // Along the beam (p − s)ᵀG is half the derivative of the squared distance: of degree 1, as that is. Less a share
      // of the mean x̄ it still is: (p − p̄)ᵀx̄ is a product of what is constant on the tip and a twist seen from there.
      part(1, 1, 2, t, over_square(noise_.along), across_taken);
    }
    if (shared) part(3, 1, 1, -1, one, none);
  }
  if (noise_.kind == Kind::distances) {
    distances_ = targets_;
    for (int t = 0; t < targets_; ++t) part(1, 1, 2, t, over_square(noise_.along), none);
  }
  if (joints_ > 0) part(joints_, 0, 0, -1, one, none);
}

/// Targets p_t on a rigid tip, e_t from their mean: r_t = ‖p̄ − s + e_t‖² and r̄ = ‖p̄ − s‖² + mean ‖e‖².
void ExplicitRows::take_spreads() {
  const Eigen::Isometry3d anywhere = Eigen::Isometry3d::Identity();
  Eigen::VectorXd read(instrument_.rows());
  instrument_.read({anywhere, own_correction(), chosen_.station}, read);
  Eigen::Matrix3Xd e = read.reshaped(3, targets_);
  e.colwise() -= e.rowwise().mean().eval();
  const double mean = e.colwise().squaredNorm().mean();
  for (Eigen::Index t = 0; t < targets_; ++t) {
    const double lever = e.col(t).norm();
    spreads_.push_back({2 * lever * (1 + 1e-9), (std::abs(mean - lever * lever) + 2 * lever * lever) * (1 + 1e-9)});
  }
}

/// Remainders of whitened columns: those of the tip, at each point's distance from its origin.
void ExplicitRows::take_remainders(const std::vector<HarmonicColumns::Remainder>& remainders) {
  const Eigen::Isometry3d at_the_tip = Eigen::Isometry3d::Identity();
  const MeasurementModel::Sighting sighting{at_the_tip, own_correction(), chosen_.station};
  const Eigen::Index rows = instrument_.rows();
  Eigen::MatrixXd turned(rows, 3);
  Twists turns = Twists::Zero(6, 3);
  turns.bottomRows<3>().setIdentity();
  instrument_.rows_of_twists(sighting, turns, turned);
  const Eigen::MatrixXd L = covariance_.matrixL();
  const double smallest = Eigen::JacobiSVD<Eigen::MatrixXd>(L).singularValues().minCoeff();
  for (const HarmonicColumns::Remainder& remainder : remainders) {
    double square = 0;
    for (Eigen::Index first = 0; first < rows; first += 3) {
      const double lever = turned.middleRows(first, 3).norm() / std::sqrt(2.0);
      const double off = remainder.constant + remainder.lever * lever;
      square += off * off;
    }
    remainders_.push_back(std::sqrt(square) / smallest * (1 + 1e-9));
  }
}

/// The instrument's rows along every column and every joint reading, and what it reads.
bool ExplicitRows::read(std::span<const double> q, std::span<const double> factors, ExplicitWork& w) const {
  if (!bends_) {
    if (!rows_of_tip(q, nullptr, w)) return false;
  } else {
    for (const double share : {-bent_share, bent_share}) {
      if (!rows_of_tip(q, &share, w)) return false;
      if (share < 0) w.bent = w.rows;
      else w.bent = (w.rows - w.bent) / (2 * bent_share);
    }
    const double share = 0;
    if (!rows_of_tip(q, &share, w)) return false;
    w.rows += w.bent;
  }
  for (std::size_t f = 0; f < factors_.size(); ++f) w.rows.col(factors_[f].column) *= factors[f];
  return true;
}

/// Columns without their factors, of the arm bent by a share of its deflections; null: as it stands.
bool ExplicitRows::rows_of_tip(std::span<const double> q, const double* share, ExplicitWork& w) const {
  const std::size_t tip = correction_.empty() ? 0 : std::size_t(tip_parameters_);
  const Point at{q.first(tip_.coordinates().size()), std::span(correction_).first(tip), chosen_};
  if (!(share != nullptr ? tip_.linearise_bent(at, *share, selected_, w.X, w.twists)
                         : tip_.linearise(at, selected_, w.X, w.twists, joints_ > 0 ? &w.readings : nullptr)))
    return false;
  const MeasurementModel::Sighting sighting{w.X, own_correction(), chosen_.station};
  const auto columns = Eigen::Index(selected_.size());
  w.rows.resize(instrument_.rows(), columns + joints_);
  for (Eigen::Index c = 0; c < columns; ++c) {
    const int own = selected_[std::size_t(c)] - tip_parameters_;
    if (own < 0) continue;
    Twist twist = Twist::Zero();
    measurement_.motion(sighting, own, &twist);
    w.twists.col(c) = twist;
  }
  instrument_.rows_of_twists(sighting, w.twists, w.rows.leftCols(columns));
  for (Eigen::Index c = 0; c < columns; ++c) {
    const int own = selected_[std::size_t(c)] - tip_parameters_;
    if (own >= 0 && !measurement_.motion(sighting, own, nullptr)) measurement_.own_column(sighting, own, w.rows.col(c));
  }
  for (int j = 0; j < joints_; ++j) w.readings.col(j) *= tip_.reading_noise()[std::size_t(j)];
  if (joints_ > 0) instrument_.rows_of_twists(sighting, w.readings, w.rows.rightCols(joints_));
  if (noise_.kind == Kind::constant) return true;
  w.y.resize(instrument_.rows());
  instrument_.read(sighting, w.y);
  return true;
}

void ExplicitRows::to_parts(ExplicitWork& w, std::span<double> squares) const {
  Eigen::Index rows = 0;
  for (const HarmonicPart& part : parts_) rows += part.rows;
  w.parts.resize(rows, w.rows.cols());
  if (noise_.kind == Kind::constant) {
    covariance_.matrixL().solveInPlace(w.rows);
    w.parts.topRows(w.rows.rows()) = w.rows;
    return;
  }
  if (noise_.kind == Kind::distances) {
    for (Eigen::Index t = 0; t < targets_; ++t) {
      w.parts.row(t) = w.y[t] * w.rows.row(t);
      squares[std::size_t(t)] = w.y[t] * w.y[t];
    }
    return;
  }
  Eigen::Index next = 0;
  RowMatrix& mean = w.all;
  if (displacement_ > 0) {
    mean.setZero(3, w.rows.cols());
    for (Eigen::Index t = 0; t < targets_; ++t) mean += w.rows.middleRows(3 * t, 3) / double(targets_);
  }
  for (Eigen::Index t = 0; t < targets_; ++t) {
    const Eigen::Vector3d p = w.y.segment<3>(3 * t);
    squares[std::size_t(t)] = p.squaredNorm();
    auto own = w.parts.middleRows(next, 3);
    own = w.rows.middleRows(3 * t, 3);
    if (displacement_ > 0) own -= share_ * mean;
    w.parts.row(next + 3).noalias() = p.transpose() * own;
    next += 4;
  }
  if (displacement_ > 0) w.parts.middleRows(next, 3) = share_ / displacement_ * mean;
}

bool ExplicitRows::at(std::span<const double> q, std::span<const double> factors, Work& work, RowMatrix& B,
                      std::span<double> squares) const {
  auto& w = static_cast<ExplicitWork&>(work);
  if (!read(q, factors, w)) return false;
  to_parts(w, squares);
  const auto columns = Eigen::Index(selected_.size());
  B = w.parts.leftCols(columns);
  if (joints_ == 0) return true;
  const Eigen::Index instrument = B.rows() - joints_;
  B.topRows(instrument).noalias() -= w.parts.topRightCorner(instrument, joints_) * K_;
  B.bottomRows(joints_) = K_;
  return true;
}

/// The share k of the mean is the same along and across the beam: as good as it can be for both (theory.md eq. (40)).
void ExplicitRows::choose_share(double square) {
  const double common = double(targets_) * displacement_ * displacement_;
  const double along = common * noise_.along.value(square), across = common * noise_.across.value(square);
  const auto loss = [](double k, double a) { return (k * k + a * (1 - k) * (1 - k)) * (1 + a) / a; };
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= share_steps; ++i) {
    const double k = double(i) / share_steps, worst = std::max(loss(k, along), loss(k, across));
    if (worst >= best) continue;
    best = worst;
    share_ = k;
  }
}

void ExplicitRows::tune(const std::vector<std::vector<double>>& configurations, std::span<const double> weights) {
  ExplicitWork w;
  std::vector<double> squares, factors(factors_.size());
  squares.resize(std::size_t(distances_));
  const auto each = [&](const auto& use) {
    for (std::size_t i = 0; i < configurations.size(); ++i) {
      for (std::size_t f = 0; f < factors_.size(); ++f)
        factors[f] = value_of(factors_[f], configurations[i][std::size_t(factors_[f].coordinate)]);
      if (!read(configurations[i], factors, w)) continue;
      to_parts(w, squares);
      use(weights[i]);
    }
  };
  if (displacement_ > 0) {
    double sum = 0, total = 0;
    each([&](double weight) {
      for (const double r : squares) sum += weight * r;
      total += weight * double(distances_);
    });
    if (total > 0) choose_share(sum / total);
  }
  if (joints_ == 0) return;
  const auto columns = Eigen::Index(selected_.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(joints_, joints_), right = Eigen::MatrixXd::Zero(joints_, columns);
  each([&](double weight) {
    normal.diagonal().array() += weight;
    Eigen::Index first = 0;
    for (std::size_t k = 0; k + 1 < parts_.size(); ++k) {
      const HarmonicPart& part = parts_[k];
      const double factor = weight * part.factor(part.distance < 0 ? 0.0 : squares[std::size_t(part.distance)]);
      const Eigen::MatrixXd Z = w.parts.block(first, columns, part.rows, joints_);
      normal.noalias() += factor * Z.transpose() * Z;
      right.noalias() += factor * Z.transpose() * w.parts.block(first, 0, part.rows, columns);
      first += part.rows;
    }
  });
  K_ = normal.llt().solve(right);
}

/// True if an instrument's rows are changes of points, three a point, in all directions alike.
bool reads_points(const MeasurementModel& measurement, const HarmonicNoise& noise) {
  const MeasurementModel& instrument = noise.instead != nullptr ? *noise.instead : measurement;
  const Eigen::Index rows = instrument.rows();
  if (rows % 3 != 0) return false;
  const Eigen::Isometry3d anywhere = Eigen::Isometry3d::Identity();
  Eigen::MatrixXd moved(rows, 3);
  instrument.rows_of_twists({anywhere, {}, 0}, Twists::Identity(6, 3), moved);
  for (Eigen::Index first = 0; first < rows; first += 3) {
    const Eigen::Matrix3d own = moved.middleRows(first, 3);
    if (!(own * own.transpose()).isIdentity(1e-12)) return false;
  }
  return true;
}

}  // namespace

double value_of(const ColumnFactor& factor, double x) {
  if (factor.kind == ColumnFactor::Kind::linear) return x - factor.constant;
  return factor.kind == ColumnFactor::Kind::cosine ? std::cos(factor.constant * x) : std::sin(factor.constant * x);
}

std::unique_ptr<HarmonicRows> explicit_rows(const TipModel& tip, const MeasurementModel& measurement,
                                            const Repeatability& repeatability, int tip_parameters, const Point& at,
                                            std::span<const int> selected, std::string& why_not) {
  const HarmonicNoise noise = measurement.harmonic_noise();
  if (noise.kind == Kind::unknown) why_not = "readings that are not linear in where the tip is";
  else if (repeatability.rotation > 0) why_not = "turns of each visit, which move targets by where they point";
  else if (noise.kind == Kind::distances && repeatability.translation > 0 && measurement.rows() > 1)
    why_not = "distances that share the displacement of a visit";
  std::vector<int> of_tip;
  for (const int i : selected) {
    // Beyond the tip's own parameters columns are the instrument's: the tip gives zeros there.
    of_tip.push_back(i < tip_parameters ? i : int(tip.parameters().size()) + i);
    if (std::find(noise.excluded.begin(), noise.excluded.end(), i - tip_parameters) != noise.excluded.end())
      why_not = "the column of " + measurement.parameters()[std::size_t(i - tip_parameters)].name;
  }
  if (!why_not.empty()) return nullptr;
  const std::size_t in_use = at.correction.empty() ? 0 : std::size_t(tip_parameters);
  Point of_the_tip = at;
  of_the_tip.correction = at.correction.first(in_use);
  HarmonicColumns columns = tip.harmonic_columns(of_tip, of_the_tip);
  why_not = columns.why_not;
  if (columns.bends || columns.order > 1) {
    if (noise.kind != Kind::constant || !reads_points(measurement, noise))
      why_not = "an elastic arm whose readings are not of points with one noise";
    for (const int i : selected)
      if (i >= tip_parameters && columns.bends &&
          measurement.motion({Eigen::Isometry3d::Identity(), {}, 0}, i - tip_parameters, nullptr))
        why_not = "stations of an elastic arm";
  }
  if (!why_not.empty()) return nullptr;
  for (std::size_t c = 0; c < selected.size(); ++c)
    if (selected[c] >= tip_parameters) columns.selected[c] = selected[c];
  return std::make_unique<ExplicitRows>(tip, measurement, repeatability, tip_parameters, at, std::move(columns));
}

}  // namespace posewright
