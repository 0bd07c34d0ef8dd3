#include "posewright/model/campaigns.hpp"

#include <algorithm>
#include <array>

#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr std::array<const char*, 6> components = {".x", ".y", ".z", ".rx", ".ry", ".rz"};

class Campaigns : public IdentificationModel {
 public:
  Campaigns(std::unique_ptr<IdentificationModel> inside, const std::vector<std::string>& names,
            const std::vector<std::string>& moved)
      : inside_(std::move(inside)), moved_(frame_parameters(*inside_, moved)) {
    if (std::ranges::count(moved, "base") > 0 && base_parameters(*inside_).size() < components.size())
      throw CannotDo(
          "several files are campaigns with a base each, and these readings do not depend on where a base is");
    if (moved_.empty() && !moved.empty())
      throw CannotDo("nothing that these readings depend on is on the tool: no file has one of its own");
    parameters_ = inside_->parameters();
    own_ = int(parameters_.size());
    coordinates_ = inside_->coordinates();
    coordinates_.push_back(make_choice("campaign", names));
    geometric_ = inside_->geometric_parameters();
    unmeasurable_reason_ = inside_->unmeasurable_reason();
    readings_ = inside_->readings();
    rows_ = inside_->rows();
    rows_per_target_ = inside_->rows_per_target();
    tips_ = inside_->tips();
    tip_coordinates_ = inside_->tip_coordinates();
    for (std::size_t c = 1; c < names.size(); ++c)
      for (const int i : moved_) {
        parameters_.push_back(inside_->parameters()[std::size_t(i)]);
        parameters_.back().name = name_in(names[c], parameters_.back().name);
        parameters_.back().role = Role::nuisance;
      }
  }

 private:
  /// Its configuration and correction inside.
  struct Inside {
    std::span<const double> q;
    std::span<const double> correction;
  };
  Inside inside(const Point& at) const {
    static thread_local std::vector<double> correction;
    const std::span<const double> q = at.q.first(at.q.size() - 1);
    if (at.correction.empty()) return {q, {}};
    correction.assign(at.correction.begin(), at.correction.begin() + own_);
    if (const int campaign = int(at.q.back()); campaign > 0)
      for (std::size_t k = 0; k < moved_.size(); ++k)
        correction[std::size_t(moved_[k])] = at.correction[std::size_t(first_of(campaign)) + k];
    return {q, correction};
  }
  int first_of(int campaign) const { return own_ + int(moved_.size()) * (campaign - 1); }

  /// Parameter of the inner model with the same effect on a campaign's readings; −1: none.
  int moves(int index, int campaign) const {
    if (index >= int(parameters_.size())) return index - int(parameters_.size()) + own_;  // along the tip's twists
    if (index >= own_) {
      const int first = first_of(campaign);
      return campaign > 0 && index >= first && index < first + int(moved_.size()) ? moved_[std::size_t(index - first)]
                                                                                  : -1;
    }
    return campaign > 0 && std::ranges::count(moved_, index) > 0 ? -1 : index;
  }

  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override {
    static thread_local std::vector<int> own;
    static thread_local Eigen::VectorXd y;
    const int campaign = int(at.q.back());
    own.clear();
    for (const int i : selected) {
      const int moved = moves(i, campaign);
      own.push_back(moved < 0 ? moved_.front() : moved);
    }
    const Inside there = inside(at);
    // Parallel robots stand elsewhere with their corrections: the model inside finds where.
    if (!inside_->predict_and_linearise(there.q, there.correction, own, out, y)) return false;
    for (std::size_t j = 0; j < selected.size(); ++j)
      if (moves(selected[j], campaign) < 0) out.G.col(Eigen::Index(j)).setZero();
    return true;
  }
  bool do_read(const Point& at, Eigen::VectorXd& y) const override {
    const Inside there = inside(at);
    return inside_->predict(there.q, there.correction, y);
  }
  void do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                     Eigen::VectorXd& out) const override {
    inside_->difference(measured, predicted, out);
  }
  void do_shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change,
                  Eigen::VectorXd& out) const override {
    inside_->shifted(predicted, change, out);
  }
  void do_take_loads_at(std::span<const double> correction) override {
    inside_->take_loads_at(correction.empty() ? correction : correction.first(std::size_t(own_)));
  }
  bool do_measurable(const Point& at) const override {
    const Inside there = inside(at);
    return inside_->measurable(there.q, there.correction);
  }
  bool do_reading_twists(const Point& at, Eigen::Matrix<double, 6, Eigen::Dynamic>& twists) const override {
    return inside_->reading_twists(at.q.first(at.q.size() - 1), twists);
  }
  Eigen::Isometry3d do_tool_pose(const Point& at) const override {
    return inside_->tool_pose(at.q.first(at.q.size() - 1));
  }

  std::unique_ptr<IdentificationModel> inside_;
  std::vector<int> moved_;
  int own_ = 0;  ///< parameters of the model inside
};

}  // namespace

std::string name_in(const std::string& campaign, const std::string& name) {
  const std::size_t end = std::min(name.find('.'), name.size());
  return name.substr(0, end) + "@" + campaign + name.substr(end);
}

std::vector<int> frame_parameters(const IdentificationModel& model, const std::vector<std::string>& frames) {
  std::vector<int> found;
  for (const std::string& frame : frames)
    for (const char* component : components)
      for (std::size_t i = 0; i < model.parameters().size(); ++i)
        if (model.parameters()[i].name == frame + component) found.push_back(int(i));
  return found;
}

std::vector<int> base_parameters(const IdentificationModel& model) { return frame_parameters(model, {"base"}); }

std::vector<int> campaign_parameters(const IdentificationModel& model, const std::string& campaign) {
  std::vector<int> found;
  for (std::size_t i = 0; i < model.parameters().size(); ++i) {
    const std::string& name = model.parameters()[i].name;
    const std::size_t at = name.find('@');
    // A campaign is called as its file, which may have dots.
    if (at != std::string::npos && name.compare(at + 1, campaign.size() + 1, campaign + ".") == 0)
      found.push_back(int(i));
  }
  return found;
}

std::vector<std::pair<int, int>> campaign_pairs(const IdentificationModel& model, const std::string& campaign) {
  std::vector<std::pair<int, int>> pairs;
  for (const int own : campaign_parameters(model, campaign))
    for (std::size_t i = 0; i < model.parameters().size(); ++i)
      if (name_in(campaign, model.parameters()[i].name) == model.parameters()[std::size_t(own)].name)
        pairs.emplace_back(own, int(i));
  return pairs;
}

std::vector<double> correction_in(const IdentificationModel& model, const std::string& campaign,
                                  const std::vector<double>& correction) {
  std::vector<double> there = correction;
  for (const auto& [own, first] : campaign_pairs(model, campaign))
    there[std::size_t(first)] = correction[std::size_t(own)];
  return there;
}

std::unique_ptr<IdentificationModel> with_campaigns(std::unique_ptr<IdentificationModel> model,
                                                    const std::vector<std::string>& names,
                                                    const std::vector<std::string>& moved) {
  return std::make_unique<Campaigns>(std::move(model), names, moved);
}

VariantColumns with_campaign_columns(const IdentificationModel& model, const VariantColumns& columns) {
  const Coordinate& campaign = model.coordinates().back();
  VariantColumns all = columns;
  all.selected.clear();
  all.parameters.clear();
  all.tiers.clear();
  for (std::size_t c = 1; c < campaign.labels.size(); ++c)
    for (const int i : campaign_parameters(model, campaign.labels[c])) {
      all.selected.push_back(i);
      all.parameters.push_back(model.parameters()[std::size_t(i)]);
      all.parameters.back().places = true;
      all.tiers.push_back(0);
    }
  all.nuisance = columns.nuisance + int(all.selected.size());
  all.selected.insert(all.selected.end(), columns.selected.begin(), columns.selected.end());
  all.parameters.insert(all.parameters.end(), columns.parameters.begin(), columns.parameters.end());
  all.tiers.insert(all.tiers.end(), columns.tiers.begin(), columns.tiers.end());
  return all;
}

}  // namespace posewright
