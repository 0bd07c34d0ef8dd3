#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "posewright/model/variant_columns.hpp"

namespace posewright {

/// A robot measured in several campaigns: between them an instrument or a tool was moved, the robot is unchanged.
/// Wraps a model with one more coordinate `campaign`, the last. For every campaign but the first, parameters behind the
/// model's own take the place of those of each frame that moved: base@NAME.{x, y, z, rx, ry, rz}, target@NAME.P1.x.
/// @param names  of all campaigns, two at least, no two alike
/// @param moved  frames that stand elsewhere in each, as their parameters begin: "base", "tool", "target.P1"
/// Throws CannotDo for "base" if the model's readings do not depend on it, and if none of the frames has parameters.
std::unique_ptr<IdentificationModel> with_campaigns(std::unique_ptr<IdentificationModel> model,
                                                    const std::vector<std::string>& names,
                                                    const std::vector<std::string>& moved = {"base"});

/// Adds the frames of all campaigns but the first to the columns, as nuisance.
/// @param model    by with_campaigns()
/// @param columns  of the model inside
VariantColumns with_campaign_columns(const IdentificationModel& model, const VariantColumns& columns);

/// Parameters of a campaign's own frames, frame by frame.
std::vector<int> campaign_parameters(const IdentificationModel& model, const std::string& campaign);

/// Pairs of each such parameter and that of the first campaign, which it replaces: {own, the first's}.
std::vector<std::pair<int, int>> campaign_pairs(const IdentificationModel& model, const std::string& campaign);

/// Corrections of all parameters with those of a campaign's own frames in the places that they take.
std::vector<double> correction_in(const IdentificationModel& model, const std::string& campaign,
                                  const std::vector<double>& correction);

/// The name of a campaign's own parameter or frame: "target.P1.x" → "target@NAME.P1.x".
std::string name_in(const std::string& campaign, const std::string& name);

/// Parameters of frames by their names: {"tool", "target.P1"} → tool.x, …, target.P1.z.
std::vector<int> frame_parameters(const IdentificationModel& model, const std::vector<std::string>& frames);

/// The six parameters of the base, base.{x, …, rz}; fewer where the model has none.
std::vector<int> base_parameters(const IdentificationModel& model);

}  // namespace posewright
