#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "instruments.hpp"
#include "posewright/model/campaigns.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/measurement_factory.hpp"

namespace posewright {
namespace {

/// Instruments of a list that read the same visit: the rows of one after those of the other, with independent noise.
/// Parameters and readings have the names that the list gives them ("target@NAME.P1.x", "NAME.P1.x").
class TogetherModel : public MeasurementModel {
 public:
  /// @param spec  with TogetherMeasurement, whose members have targets that stand for the tool, all or none
  explicit TogetherModel(const MeasurementSpec& spec) {
    for (const MeasurementSpec& one : std::get<TogetherMeasurement>(spec.instrument).members) {
      // What residuals of the visits that all read have shown says it of each.
      const double factor = spec.noise_factor > 1.0 ? 1.0 : one.noise_factor;
      members_.push_back({make_measurement(one), rows_, int(parameters_.size()), factor * factor});
      const Member& member = members_.back();
      const MeasurementModel& model = *member.model;
      for (Parameter parameter : model.parameters()) {
        parameter.name = name_in(one.name, parameter.name);
        parameters_.push_back(std::move(parameter));
      }
      for (const IdentificationModel::Preference& preference : model.preferences())
        preferences_.push_back({member.own + preference.parameter, preference.tier});
      for (const Reading& reading : model.readings())
        readings_.push_back({reading_in(one.name, reading.name), reading.unit});
      rows_ += model.rows();
      if (!model.unseen_reason().empty())
        unseen_reason_ += (unseen_reason_.empty() ? "" : " or ") + model.unseen_reason();
    }
    replaces_tool_ = members_.front().model->replaces_tool();
  }

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override {
    for (const Member& member : members_)
      member.model->read(of(member, sighting), y.segment(member.first_row, member.model->rows()));
  }

  bool reads_from_nominal() const override {
    return std::ranges::any_of(members_, [](const Member& member) { return member.model->reads_from_nominal(); });
  }

  void difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                  Eigen::VectorXd& out) const override {
    member_by_member(
        measured, predicted, out,
        [](const MeasurementModel& model, const auto& a, const auto& b, auto& own) { model.difference(a, b, own); });
  }

  void shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const override {
    member_by_member(
        predicted, change, out,
        [](const MeasurementModel& model, const auto& a, const auto& b, auto& own) { model.shifted(a, b, own); });
  }

  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override {
    for (const Member& member : members_)
      member.model->rows_of_twists(of(member, sighting), twists,
                                   rows.middleRows(member.first_row, member.model->rows()));
  }

  /// A station that moves does so for its own instrument alone: no motion of the tip, which all would see.
  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override {
    column.setZero();
    for (const Member& member : members_) {
      const int own = index - member.own;
      if (own < 0 || own >= int(member.model->parameters().size())) continue;
      auto rows = column.segment(member.first_row, member.model->rows());
      if (Twist twist; member.model->motion(of(member, sighting), own, &twist))
        member.model->rows_of_twists(of(member, sighting), twist, rows);
      else member.model->own_column(of(member, sighting), own, rows);
    }
  }

  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override {
    covariance.setZero();
    for (const Member& member : members_) {
      auto own = covariance.block(member.first_row, member.first_row, member.model->rows(), member.model->rows());
      member.model->covariance(of(member, sighting), own);
      own *= member.variance;
    }
  }

  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override {
    Twist sum = Twist::Zero();
    for (const Member& member : members_) {
      const Sighting own = of(member, sighting);
      sum += member.model->pull_back(own, adjoint_of(member, own, f));
    }
    return sum;
  }

  bool sees(const Sighting& sighting) const override {
    return std::ranges::all_of(members_,
                               [&](const Member& member) { return member.model->sees(of(member, sighting)); });
  }

  std::optional<int> margins() const override {
    int sum = 0;
    for (const Member& member : members_) {
      const std::optional<int> own = member.model->margins();
      if (!own) return std::nullopt;
      sum += *own;
    }
    return sum;
  }

  void margins_at(const Sighting& sighting, std::span<double> out) const override {
    std::size_t first = 0;
    for (const Member& member : members_) {
      const auto own = std::size_t(member.model->margins().value_or(0));
      member.model->margins_at(of(member, sighting), out.subspan(first, own));
      first += own;
    }
  }

 private:
  struct Member {
    std::unique_ptr<MeasurementModel> model;
    int first_row = 0, own = 0;  ///< `own`: index of its first own parameter
    double variance = 1.0;       ///< of its readings, times that of the model
  };
  /// The sighting as it is one of the member.
  static Sighting of(const Member& member, const Sighting& sighting) {
    Sighting own = sighting;
    if (!own.correction.empty())
      own.correction = sighting.correction.subspan(std::size_t(member.own), member.model->parameters().size());
    return own;
  }
  template <class Apply>

  void member_by_member(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& out,
                        const Apply& apply) const {
    Eigen::VectorXd own;
    out.resize(rows_);
    for (const Member& member : members_) {
      const auto rows = Eigen::seqN(member.first_row, member.model->rows());
      apply(*member.model, a(rows), b(rows), own);
      out(rows) = own;
    }
  }

  /// A column Y t of a motion t makes f depend on the rows Y by c tᵀ and on the twist by Yᵀ c, c = ∂f/∂(column).
  Adjoint adjoint_of(const Member& member, const Sighting& sighting, const Adjoint& f) const {
    const int first = member.first_row, rows = member.model->rows();
    Adjoint own;
    own.twist_rows = f.twist_rows.middleRows(first, rows);
    own.covariance = member.variance * f.covariance.block(first, first, rows, rows);
    own.own_columns.setZero(rows, Eigen::Index(f.own.size()));
    own.own_motions.setZero(6, Eigen::Index(f.own.size()));
    Eigen::MatrixXd unit_rows(rows, 6);
    member.model->rows_of_twists(sighting, Twists::Identity(6, 6), unit_rows);
    for (std::size_t i = 0; i < f.own.size(); ++i) {
      const int index = f.own[i] - member.own;
      if (index < 0 || index >= int(member.model->parameters().size())) continue;
      const Eigen::VectorXd by_column = f.own_columns.col(Eigen::Index(i)).segment(first, rows);
      const auto at = Eigen::Index(own.own.size());
      own.own.push_back(index);
      own.own_columns.col(at) = by_column;
      Twist twist;
      if (!member.model->motion(sighting, index, &twist)) continue;
      own.twist_rows += by_column * twist.transpose();
      own.own_motions.col(at) = unit_rows.transpose() * by_column;
    }
    return own;
  }

  std::vector<Member> members_;
};

}  // namespace

std::unique_ptr<MeasurementModel> model_of(const TogetherMeasurement&, const MeasurementSpec& spec) {
  return std::make_unique<TogetherModel>(spec);
}

}  // namespace posewright
