#include "posewright/report/judge_poses.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/lists/read_poses.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/study/setup.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"
#include "posewright/tasks/planned_pose.hpp"
#include "report_scene.hpp"

namespace posewright {
namespace {

/// The columns of the variant that the plan estimates.
VariantColumns planned_columns(const Variant& variant, const WrittenPlan& plan) {
  const VariantColumns all = all_columns(variant);
  const auto found = plan.parameters.find(variant.spec->name);
  const std::vector<std::string> names = found == plan.parameters.end() ? std::vector<std::string>{} : found->second;
  std::vector<int> kept;
  for (std::size_t j = 0; j < all.parameters.size(); ++j)
    if (std::find(names.begin(), names.end(), all.parameters[j].name) != names.end()) kept.push_back(int(j));
  if (kept.size() != names.size())
    throw InputError({plan.file.string(), 0}, "has parameters that the problem does not have", "plan again");
  return subset(all, kept);
}

class PoseJudge {
 public:
  PoseJudge(const Problem& problem, const WrittenPlan& plan, const Monitor& monitor)
      : problem_(as_written(problem, plan)),
        setup_(resolve(problem_, {}, monitor, Purpose::list)),
        columns_(planned_columns(setup_.first(), plan)),
        drawing_(problem_, *setup_.cell),
        tolerance_(tolerances_of(columns_)) {}

  const std::vector<Coordinate>& coordinates() const { return setup_.first().workspace->coordinates(); }

  JudgedPose judge(const std::vector<double>& q) {
    const IdentificationModel& model = *setup_.first().model;
    JudgedPose judged{pose_of(model, q), reason(q), keyframe_at(drawing_, q), information(q), {}};
    judged.pose.sights = sights_of(*setup_.cell, q);
    judged.pose.nearest = nearest_at(*setup_.cell, q);
    for (const DrawnCamera& camera : drawing_.cameras())
      if (judged.pixels.empty()) judged.pixels = predicted_pixels(model, camera.instrument, camera.points.size(), q);
    return judged;
  }

 private:
  std::string reason(std::span<const double> q) const {
    for (const Variant& variant : setup_.variants)
      if (const int found = variant.workspace->violation(q); found >= 0)
        return variant.workspace->reasons()[std::size_t(found)];
    return {};
  }

  Eigen::MatrixXd information(const std::vector<double>& q) {
    const IdentificationModel& model = *setup_.first().model;
    const std::vector<int>& selected = columns_.selected;
    BlockArray::RowMatrix rows(model.block_rows(selected), Eigen::Index(selected.size()));
    if (!whitened_block(model, q, {}, selected, scratch_, rows.data(), int(rows.cols())) || !rows.allFinite())
      return {};
    const Eigen::MatrixXd scaled = rows * tolerance_.asDiagonal();
    return scaled.transpose() * scaled;
  }

  const Problem problem_;
  const Setup setup_;
  const VariantColumns columns_;
  const Drawing drawing_;
  const Eigen::VectorXd tolerance_;
  Linearisation scratch_;
};

}  // namespace

JudgedPoses judge_poses(const Problem& problem, const std::filesystem::path& plan, const std::filesystem::path& list,
                        const Monitor& monitor) {
  PoseJudge judge(problem, read_written_plan(plan), monitor);
  JudgedPoses result;
  int written = 0;
  for (const Coordinate& c : judge.coordinates()) {
    if (c.choice()) continue;
    if (!c.discrete()) result.ranges.push_back({written, c.lower, c.upper});
    ++written;
  }
  const PoseList poses = read_poses(list, judge.coordinates());
  for (const std::vector<double>& q : poses.configurations) {
    if (monitor.should_stop()) throw CannotDo("stopped before all poses were judged");
    result.poses.push_back(judge.judge(q));
    result.poses.back().pose.id = int(result.poses.size());
  }
  return result;
}

std::string judged_text(const JudgedPoses& judged) {
  std::string text;
  for (const JudgedPose& one : judged.poses) {
    text += fmt::format("Pose {}: {}", one.pose.id, one.reason.empty() ? "feasible" : "not feasible: " + one.reason);
    if (const auto& nearest = one.pose.nearest)
      text +=
          fmt::format("; {} and {} are {} apart", nearest->first, nearest->second, shown_value(nearest->distance, "m"));
    text += "\n";
  }
  return text;
}

}  // namespace posewright
