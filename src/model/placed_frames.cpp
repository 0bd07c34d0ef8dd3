#include "posewright/model/placed_frames.hpp"

#include <optional>

#include "posewright/model/instrument_view.hpp"
#include "posewright/model/nominal_placement.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/model/urdf_reader.hpp"

namespace posewright {
namespace {

/// None: nothing of the robot is stated in a measurement frame.
std::optional<Eigen::Isometry3d> base_of(const Problem& problem, const VariantSpec& variant,
                                         const std::vector<CalibratedValue>& values, const std::vector<Parameter>& at) {
  // Denavit–Hartenberg parameters displace the base about a frame of their own.
  if (const auto* arm = std::get_if<SerialArmSpec>(&problem.robot)) {
    const ChainDescription chain = read_urdf_chain(*arm, problem.at(arm->line));
    return chain.X_MeasureBase * chain_correction(chain, variant.convention, values).base.X;
  }
  return std::visit(
      [&](const auto& robot) -> std::optional<Eigen::Isometry3d> {
        if constexpr (requires { robot.placement; }) return nominal_placement(at, "base", isometry(robot.placement));
        else return std::nullopt;
      },
      problem.robot);
}

}  // namespace

std::vector<PlacedFrame> placed_frames(const Problem& problem, const VariantSpec& variant,
                                       const std::vector<CalibratedValue>& values) {
  std::vector<Parameter> at;
  at.reserve(values.size());
  for (const CalibratedValue& v : values) at.push_back({v.name, v.unit, v.value, 0.0, Role::interest});
  std::vector<PlacedFrame> frames;
  if (const auto base = base_of(problem, variant, values, at)) frames.push_back({"base", false, *base});
  const InstrumentView view = view_of(problem.measurement);
  if (view.has_places)
    for (const InstrumentView::Place& place : view.places)
      frames.push_back({place.parameters, view.places_on_tip,
                        nominal_placement(at, place.parameters, isometry(place.station.placement))});
  if (!view.points_parameters.empty())
    frames.push_back({view.points_parameters, view.points_on_tip,
                      nominal_placement(at, view.points_parameters, isometry(view.points_at))});
  return frames;
}

}  // namespace posewright
