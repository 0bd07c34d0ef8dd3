#include "posewright/study/space.hpp"

#include <algorithm>

#include "posewright/criterion/divide_rows.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/proof/bounded_space.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

class StudyProbe : public ConfigurationSpace::Probe {
 public:
  StudyProbe(const std::vector<SpacePart>& parts, const Configurations& measured, const Spacing& spacing,
             const Eigen::MatrixXd& R)
      : parts_(parts), measured_(measured), spacing_(spacing), rows_of_R_(R), divisor_(R), scratch_(parts.size()) {
    int rows = 0;
    for (const SpacePart& part : parts) {
      first_row_.push_back(rows);
      rows += part.model->block_rows(part.selected);
      linearised_.push_back(part.selected);
      if (part.features == nullptr) continue;
      const std::vector<int>& twists = part.features->effect().columns();
      linearised_.back().insert(linearised_.back().end(), twists.begin(), twists.end());
    }
    raw_ = BlockArray::RowMatrix::Zero(rows, R.cols());
    for (std::size_t v = 0; v < parts.size(); ++v)
      own_.emplace_back(parts[v].model->block_rows(parts[v].selected),
                        is_direct(parts[v]) ? 0 : Eigen::Index(linearised_[v].size()));
  }

  bool feasible(std::span<const double> q) override {
    return is_new(q) && std::all_of(parts_.begin(), parts_.end(),
                                    [&](const auto& part) { return part.workspace->violation(q) < 0; });
  }

  std::string forbidden_by(std::span<const double> q) override {
    for (const SpacePart& part : parts_)
      if (const int reason = part.workspace->violation(q); reason >= 0)
        return part.workspace->reasons()[std::size_t(reason)];
    return is_new(q) ? "" : "poses that are measured already";
  }

  bool perhaps_feasible(std::span<const double> q) override {
    return is_new(q) &&
           std::all_of(parts_.begin(), parts_.end(), [&](const auto& part) { return part.workspace->is_free_at(q); });
  }

  bool block(std::span<const double> q, double* rows, int stride) override {
    if (!fill(q)) return false;
    BlockArray::Map(rows, white_.rows(), white_.cols(), Eigen::OuterStride<>(stride)) = white_;
    return true;
  }

  bool margins(std::span<const double> q, std::span<double> out) override {
    std::size_t first = 0;
    for (const SpacePart& part : parts_) {
      const auto own = std::size_t(part.workspace->margins().value_or(0));
      if (!part.workspace->margins_at(q, out.subspan(first, own))) return false;
      first += own;
    }
    return true;
  }

  bool gradient(std::span<const double> q, const BlockArray::RowMatrix& slope, std::span<double> result) override {
    // What features leave at q is noise that depends on q in ways of its own.
    for (const SpacePart& part : parts_)
      if (part.features != nullptr) return false;
    if (!std::equal(q.begin(), q.end(), filled_.begin(), filled_.end()) && !fill(q)) return false;
    slope_ = slope;
    divide_by_transpose(slope_);
    std::fill(result.begin(), result.end(), 0.0);
    of_part_.resize(result.size());
    Eigen::Index column = 0;
    for (std::size_t v = 0; v < parts_.size(); ++v) {
      const SpacePart& part = parts_[v];
      const Eigen::Index rows = own_[v].rows(),
                         width = is_direct(part) ? Eigen::Index(part.selected.size()) : part.mix.cols();
      const auto raw_slope = slope_.block(first_row_[v], column, rows, width);
      if (is_direct(part)) {
        own_block_ = raw_.block(first_row_[v], column, rows, width);
        own_slope_ = raw_slope;
      } else {
        own_block_ = own_[v];
        own_slope_.noalias() = raw_slope * part.mix.transpose();
      }
      if (!whitened_gradient(*part.model, q, linearised_[v], own_block_, own_slope_, scratch_[v], of_part_))
        return false;
      for (std::size_t k = 0; k < result.size(); ++k) result[k] += of_part_[k];
      column += width;
    }
    return true;
  }

 private:
  /// The block at q in raw and in the task's columns.
  bool fill(std::span<const double> q) {
    filled_.clear();
    Eigen::Index column = 0;
    for (std::size_t v = 0; v < parts_.size(); ++v) {
      const SpacePart& part = parts_[v];
      const bool direct = is_direct(part);
      double* out = direct ? &raw_(first_row_[v], column) : own_[v].data();
      if (!whitened_block(*part.model, q, {}, linearised_[v], scratch_[v], out,
                          int(direct ? raw_.cols() : own_[v].cols())))
        return false;
      const Eigen::Index width = part.features != nullptr
                                     ? Eigen::Index(part.features->columns() + part.selected.size())
                                 : direct ? Eigen::Index(part.selected.size())
                                          : part.mix.cols();
      if (part.features != nullptr)
        part.features->expand(q, own_[v], raw_.block(first_row_[v], column, own_[v].rows(), width));
      else if (!direct) raw_.block(first_row_[v], column, own_[v].rows(), width).noalias() = own_[v] * part.mix;
      column += width;
    }
    white_ = raw_;
    divisor_.divide(white_);
    if (!white_.allFinite()) return false;
    filled_.assign(q.begin(), q.end());
    return true;
  }

  /// Far enough from every pose that is measured.
  bool is_new(std::span<const double> q) const {
    for (std::size_t i = 0; i < measured_.count(); ++i)
      if (spacing_.too_near(measured_[i], q)) return false;
    return true;
  }

  /// X R⁻ᵀ.
  void divide_by_transpose(BlockArray::RowMatrix& X) const {
    const Eigen::Index m = X.cols();
    for (Eigen::Index i = 0; i < X.rows(); ++i) {
      double* x = X.row(i).data();
      for (Eigen::Index j = m; j-- > 0;) {
        const double* r = rows_of_R_.row(j).data();
        double value = x[j];
        for (Eigen::Index k = j + 1; k < m; ++k) value -= r[k] * x[k];
        x[j] = value / r[j];
      }
    }
  }

  static bool is_direct(const SpacePart& part) { return part.mix.size() == 0 && part.features == nullptr; }

  const std::vector<SpacePart>& parts_;
  const Configurations& measured_;
  const Spacing& spacing_;
  const BlockArray::RowMatrix rows_of_R_;
  RowDivisor divisor_;
  std::vector<Linearisation> scratch_;
  std::vector<int> first_row_;
  std::vector<std::vector<int>> linearised_;  // columns of each part as its model gives them
  std::vector<BlockArray::RowMatrix> own_;    // of parts that are mixed or have features
  BlockArray::RowMatrix raw_, white_;
  std::vector<double> filled_;  // q that these and scratch_ are of; empty: of none
  BlockArray::RowMatrix slope_, own_slope_, own_block_;
  std::vector<double> of_part_;
};

class StudySpace : public BoundedSpace {
 public:
  StudySpace(std::vector<SpacePart> parts, const Configurations& candidates, Configurations measured,
             const Spacing& spacing, Eigen::MatrixXd R)
      : parts_(std::move(parts)),
        candidates_(candidates),
        measured_(std::move(measured)),
        spacing_(spacing),
        R_(std::move(R)) {
    for (const Coordinate& c : parts_.front().workspace->proposed())
      axes_.push_back({c.lower, c.upper, !c.discrete(), c.unit == "rad", c.values});
    // Poses that are there already are holes in the box.
    box_ = measured_.count() == 0 || !spacing.keeps_distance();
    for (const SpacePart& part : parts_) box_ = box_ && part.workspace->reasons().size() == 1;
  }

  const std::vector<Axis>& axes() const override { return axes_; }
  bool is_box() const override { return box_; }
  std::optional<int> margins() const override {
    if (measured_.count() > 0 && spacing_.keeps_distance()) return std::nullopt;
    int count = 0;
    for (const SpacePart& part : parts_) {
      const auto own = part.workspace->margins();
      if (!own) return std::nullopt;
      count += *own;
    }
    return count;
  }
  HarmonicForms harmonic_forms(const WeightedConfigurations& where) const override {
    return harmonic_forms_of(parts_, axes_, R_, where);
  }
  std::unique_ptr<Enclosure> enclosure(const Eigen::MatrixXd& T) const override { return enclosure_of(parts_, R_, T); }
  const Spacing& spacing() const override { return spacing_; }
  std::span<const double> candidate(int index) const override { return candidates_[std::size_t(index)]; }
  std::unique_ptr<Probe> probe() const override {
    return std::make_unique<StudyProbe>(parts_, measured_, spacing_, R_);
  }

 private:
  std::vector<SpacePart> parts_;
  const Configurations& candidates_;
  Configurations measured_;
  Spacing spacing_;
  Eigen::MatrixXd R_;
  std::vector<Axis> axes_;
  bool box_ = true;  // limits are the only check
};

}  // namespace

std::unique_ptr<ConfigurationSpace> make_configuration_space(std::vector<SpacePart> parts,
                                                             const Configurations& candidates,
                                                             const Configurations& measured, const Spacing& spacing,
                                                             Eigen::MatrixXd R) {
  return std::make_unique<StudySpace>(std::move(parts), candidates, measured, spacing, std::move(R));
}

}  // namespace posewright
