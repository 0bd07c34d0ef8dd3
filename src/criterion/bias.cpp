#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bias_state.hpp"
#include "effect_mix.hpp"
#include "posewright/criterion/effect_criteria.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

/// φ and its parts at one M.
struct MeanSquare {
  Eigen::LLT<Eigen::MatrixXd> factor;  // of M_aa
  Eigen::MatrixXd spread;              // M_aa⁻¹ Lᵀ
  Eigen::MatrixXd error;               // by each effect
  double value = infinity;

  MeanSquare(const Eigen::MatrixXd& information, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& mix,
             const Eigen::MatrixXd& offset)
      : factor(information.topLeftCorner(rows.cols(), rows.cols())) {
    if (!is_regular(factor)) return;
    spread = factor.solve(rows.transpose());
    error = spread.transpose() * (information.topRightCorner(rows.cols(), mix.rows()) * mix) - offset;
    value = rows.transpose().cwiseProduct(spread).sum() + error.squaredNorm();
  }
};

}  // namespace

BiasFunction::BiasFunction(const Eigen::MatrixXd& rows, Eigen::MatrixXd mix, const Eigen::MatrixXd& offset)
    : rows_(rows), mix_(std::move(mix)), offset_(offset) {
  // Many places, few columns: only the triangle of [L b] counts.
  const Eigen::Index m = rows.cols(), all = m + offset.cols();
  if (rows.rows() <= all) return;
  Eigen::MatrixXd both(rows.rows(), all);
  both << rows, offset;
  const Eigen::MatrixXd R =
      Eigen::HouseholderQR<Eigen::MatrixXd>(both).matrixQR().topRows(all).triangularView<Eigen::Upper>();
  rows_ = R.leftCols(m);
  offset_ = R.rightCols(offset.cols());
}

double BiasFunction::value(const Eigen::MatrixXd& information) const {
  return -std::log(MeanSquare(information, rows_, mix_, offset_).value);
}

/// dφ = −tr(L V dM V Lᵀ) + 2 tr(Qᵀ L V (dM_af Z − dM_aa V M_af Z)), V = M_aa⁻¹, Q the errors.
Eigen::MatrixXd BiasFunction::gradient(const Eigen::MatrixXd& information) const {
  const Eigen::Index m = rows_.cols(), k = mix_.rows();
  const MeanSquare at(information, rows_, mix_, offset_);
  const Eigen::MatrixXd taken = at.factor.solve(information.topRightCorner(m, k) * mix_);
  const Eigen::MatrixXd weighted = at.spread * at.error;
  const Eigen::MatrixXd product = weighted * taken.transpose();
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(m + k, m + k);
  S.topLeftCorner(m, m) = at.spread * at.spread.transpose() + product + product.transpose();
  S.topRightCorner(m, k) = -weighted * mix_.transpose();
  S.bottomLeftCorner(k, m) = S.topRightCorner(m, k).transpose();
  return S / at.value;
}

namespace {

class BiasCriterion : public Criterion {
 public:
  explicit BiasCriterion(std::shared_ptr<const BiasFunction> function) : function_(std::move(function)) {}
  std::string name() const override { return "bias"; }
  const InformationFunction& function() const override { return *function_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override {
    return start_bias(view, std::move(members), function_);
  }

 private:
  std::shared_ptr<const BiasFunction> function_;
};

}  // namespace

std::unique_ptr<Criterion> make_bias_criterion(const CriterionData& data) {
  require_effects(data);
  const EffectGroup& effects = data.effects;
  const Eigen::Index k = effects.columns, m = data.R.cols() - k;
  Eigen::MatrixXd rows = effects.error_rows;
  data.R.topLeftCorner(m, m).triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(rows);
  // The raw trailing columns hold R_af of the whitened fitted ones: that share is taken up whatever the plan.
  const Eigen::MatrixXd offset = effects.error_offset - rows * (data.R.topRightCorner(m, k) * effects.mix);
  return std::make_unique<BiasCriterion>(std::make_shared<BiasFunction>(rows, whitened_mix(data), offset));
}

}  // namespace posewright
