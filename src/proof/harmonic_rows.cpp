#include "posewright/proof/harmonic_rows.hpp"

#include <cmath>
#include <utility>

#include "explicit_rows.hpp"
#include "posewright/model/explicit_model.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/load_difference.hpp"

namespace posewright {
namespace {

std::unique_ptr<HarmonicRows> rows_of_difference(const LoadDifference& model, std::span<const double> q,
                                                 std::span<const int> selected, std::string& why_not) {
  auto loaded = harmonic_expansion(model.inside(), q, selected, why_not);
  auto unloaded =
      loaded != nullptr ? harmonic_expansion(model.inside(), model.unloaded(q), selected, why_not) : nullptr;
  if (unloaded == nullptr) return nullptr;
  if (loaded->parts().size() != 1 || loaded->parts().front().distance >= 0 || unloaded->parts().size() != 1) {
    why_not = "loaded minus unloaded readings whose noise is not the same everywhere";
    return nullptr;
  }
  return harmonic_difference(std::move(loaded), std::move(unloaded));
}

/// Rows of the instrument of a list that reads: zero in the columns of the others' parameters.
class RowsOfChoice : public HarmonicRows {
 public:
  /// @param there  of the choice
  /// @param coordinates, columns  of the list's model
  RowsOfChoice(std::unique_ptr<HarmonicRows> inside, const InstrumentChoice::Inside& there, std::size_t coordinates,
               std::size_t columns)
      : inside_(std::move(inside)), columns_at_(there.selected_at), columns_(Eigen::Index(columns)) {
    factor_ = 1.0 / std::sqrt(there.variance);
    parts_ = inside_->parts();
    factors_ = inside_->factors();
    for (ColumnFactor& factor : factors_) factor.column = int(columns_at_[std::size_t(factor.column)]);
    degrees_ = inside_->degrees();
    degrees_.resize(coordinates, 0);
    distances_ = inside_->distances();
    spreads_ = inside_->spreads();
    if (!inside_->remainders().empty()) remainders_.assign(columns, 0.0);
    for (std::size_t j = 0; j < inside_->remainders().size(); ++j)
      remainders_[std::size_t(columns_at_[j])] = factor_ * inside_->remainders()[j];
  }

  void tune(const std::vector<std::vector<double>>& configurations, std::span<const double> weights) override {
    inside_->tune(configurations, weights);
  }
  std::unique_ptr<Work> work() const override { return inside_->work(); }
  bool at(std::span<const double> q, std::span<const double> factors, Work& work, BlockArray::RowMatrix& B,
          std::span<double> squares) const override {
    static thread_local BlockArray::RowMatrix own;
    if (!inside_->at(q, factors, work, own, squares)) return false;
    B.setZero(own.rows(), columns_);
    for (std::size_t j = 0; j < columns_at_.size(); ++j) B.col(columns_at_[j]) = factor_ * own.col(Eigen::Index(j));
    return true;
  }

 private:
  std::unique_ptr<HarmonicRows> inside_;
  std::vector<Eigen::Index> columns_at_;
  Eigen::Index columns_;
  double factor_;
};

/// @param at  of the model
std::unique_ptr<HarmonicRows> rows_of_tip(const ExplicitModel& model, const Point& at, std::span<const int> selected,
                                          std::string& why_not) {
  return explicit_rows(model.tip(), model.measurement(), model.repeatability(), model.tip_parameters(), at, selected,
                       why_not);
}

std::unique_ptr<HarmonicRows> rows_of_choice(const InstrumentChoice& model, std::span<const double> q,
                                             std::span<const int> selected, std::string& why_not) {
  const InstrumentChoice::Inside there = model.inside(model.nominal_point(q), selected);
  Point at = there.model.nominal_point(there.q);
  at.correction = there.correction;
  auto rows = rows_of_tip(there.model, at, there.selected, why_not);
  if (rows == nullptr) {
    const Coordinate& instrument = model.coordinates().back();
    why_not = instrument.labels[std::size_t(q.back())] + ": " + why_not;
    return nullptr;
  }
  return std::make_unique<RowsOfChoice>(std::move(rows), there, q.size(), selected.size());
}

}  // namespace

std::unique_ptr<HarmonicRows> harmonic_expansion(const IdentificationModel& model, std::span<const double> q,
                                                 std::span<const int> selected, std::string& why_not) {
  if (const auto* difference = dynamic_cast<const LoadDifference*>(&model))
    return rows_of_difference(*difference, q, selected, why_not);
  if (const auto* of_a_tip = dynamic_cast<const ExplicitModel*>(&model))
    return rows_of_tip(*of_a_tip, model.nominal_point(q), selected, why_not);
  if (const auto* choice = dynamic_cast<const InstrumentChoice*>(&model))
    return rows_of_choice(*choice, q, selected, why_not);
  if (model.tips() > 1) why_not = "readings of two configurations at a time, which have twice as many joints";
  else if (!model.actuators().empty()) why_not = "sensors in the joints of a parallel robot";
  else why_not = "readings that are not of one tip alone";
  return nullptr;
}

std::unique_ptr<HarmonicRows> harmonic_rows(const IdentificationModel& model, std::span<const double> q,
                                            std::span<const int> selected, std::string& why_not) {
  auto rows = harmonic_expansion(model, q, selected, why_not);
  if (rows == nullptr || rows->remainders().empty()) return rows;
  return with_remainders(std::move(rows));
}

}  // namespace posewright
