#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posewright/model/variant.hpp"

namespace posewright {

/// A robot measured in several campaigns: between them the instrument was moved, the robot is unchanged. Wraps a
/// model with one more coordinate `campaign`, the last, and for every campaign but the first six more parameters behind
/// the model's own, base@NAME.{x, y, z, rx, ry, rz}, which take the place of base.* there.
/// @param names  of all campaigns, two at least, no two alike
/// Throws CannotDo if the model's readings know of no base.
std::unique_ptr<IdentificationModel> with_campaigns(std::unique_ptr<IdentificationModel> model,
                                                    const std::vector<std::string>& names);

/// Adds the bases of all campaigns but the first to the columns, as nuisance.
/// @param model    by with_campaigns()
/// @param columns  of the model inside
VariantColumns with_campaign_bases(const IdentificationModel& model, const VariantColumns& columns);

/// The six parameters of a base: base.{x, …, rz}, of a campaign base@NAME.{x, …, rz}; fewer where the model has none.
std::vector<int> base_parameters(const IdentificationModel& model, const std::string& campaign = "");

}  // namespace posewright
