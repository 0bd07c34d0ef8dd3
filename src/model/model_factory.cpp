#include "posewright/model/model_factory.hpp"

#include <algorithm>

#include "compensator_geometry.hpp"
#include "posewright/model/delta.hpp"
#include "posewright/model/dh_chain.hpp"
#include "posewright/model/elastic_chain.hpp"
#include "posewright/model/five_bar.hpp"
#include "posewright/model/forked_chain.hpp"
#include "posewright/model/given_poses.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/joint_effects.hpp"
#include "posewright/model/load_difference.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/six_legs.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/model/variant_columns.hpp"

namespace posewright {
namespace {

/// One overload a robot: a new robot is one file and one row here.
struct MakeTip {
  const Problem& problem;
  const VariantSpec& variant;

  std::unique_ptr<TipModel> operator()(const SerialArmSpec& arm) const {
    std::unique_ptr<TipModel> chain = chain_of(arm);
    if (arm.joint_effects.empty()) return chain;
    return std::make_unique<JointEffects>(std::move(chain), arm, problem.file.string());
  }
  std::unique_ptr<TipModel> chain_of(const SerialArmSpec& arm) const {
    using Convention = VariantSpec::Convention;
    ChainDescription chain = read_urdf_chain(arm, problem.at(arm.line));
    if (variant.convention != Convention::frames) {
      if (arm.elastostatic)
        throw CannotDo("variant '" + variant.name +
                       "': parameters dh and mdh are geometric; list frame parameters together with elastostatic ones");
      const bool distal = variant.convention == Convention::dh;
      return std::make_unique<DhChain>(
          denavit_hartenberg(chain, distal ? DhConvention::distal : DhConvention::proximal));
    }
    if (arm.elastostatic)
      return std::make_unique<ElasticChain>(std::move(chain), *arm.elastostatic, problem.at(arm.elastostatic->line));
    return std::make_unique<SerialChain>(std::move(chain));
  }
  std::unique_ptr<TipModel> operator()(const SixLegsSpec& spec) const {
    return std::make_unique<SixLegs>(spec, problem.workspace.limits);
  }
  std::unique_ptr<TipModel> operator()(const FiveBarSpec& spec) const { return std::make_unique<FiveBar>(spec); }
  std::unique_ptr<TipModel> operator()(const DeltaSpec& spec) const { return std::make_unique<Delta>(spec); }
  std::unique_ptr<TipModel> operator()(const CompensatorGeometrySpec&) const { return nullptr; }
  std::unique_ptr<TipModel> operator()(const GivenPosesSpec& spec) const {
    return std::make_unique<GivenPoses>(spec, problem.workspace.limits);
  }
};

/// The arm on the way of each of the instruments, and which of the coordinates move there.
class WaysOfInstruments {
 public:
  using Readings = std::vector<std::unique_ptr<MeasurementModel>>;

  /// @param readings  of each instrument
  WaysOfInstruments(const SerialArmSpec& arm, const ProblemVariant& variant,
                    const std::vector<MeasurementSpec>& instruments, const Readings& readings)
      : arm_(arm), problem_(variant.problem), chains_(read_urdf_ways(arm, variant.problem.at(arm.line))) {
    if (variant.spec.convention != VariantSpec::Convention::frames)
      throw CannotDo("variant '" + variant.spec.name + "': parameters dh and mdh are those of one way alone");
    tools_.assign(arm.ways.size(), 0);
    for (std::size_t k = 0; k < instruments.size(); ++k)
      if (!readings[k]->replaces_tool()) tools_[way_of(arm, instruments[k])] = 1;
  }

  std::unique_ptr<TipModel> of(const MeasurementSpec& instrument, const MeasurementModel& readings,
                               std::vector<char>& moving) const {
    auto chain = std::make_unique<ForkedChain>(chains_, way_of(arm_, instrument), tools_, !readings.replaces_tool());
    moving = chain->moving();
    if (arm_.joint_effects.empty()) return chain;
    auto with_effects = std::make_unique<JointEffects>(std::move(chain), arm_, problem_.file.string());
    moving.resize(with_effects->coordinates().size(), 1);
    return with_effects;
  }

 private:
  const SerialArmSpec& arm_;
  const ProblemFile& problem_;
  WayChains chains_;
  std::vector<char> tools_;  // per way
};

/// Throws InputError where targets of some that read together stand for the tool, and others read where the tool is.
void require_one_tool(const Problem& problem, const std::vector<MeasurementSpec>& instruments,
                      const WaysOfInstruments::Readings& readings) {
  for (const MeasurementSpec& one : instruments) {
    if (members_of(one) == nullptr) continue;
    std::string with, without;
    for (const MeasurementSpec& member : *members_of(one)) {
      const auto at = std::ranges::find(instruments, member.name, &MeasurementSpec::name) - instruments.begin();
      (readings[std::size_t(at)]->replaces_tool() ? without : with) = member.name;
    }
    if (!with.empty() && !without.empty())
      throw InputError(problem.at(one.line), "'" + without + "' and '" + with + "' cannot read together",
                       "targets of the one stand for the tool, whose place the other reads");
  }
}

std::unique_ptr<IdentificationModel> seen_by_each(const ProblemVariant& variant,
                                                  const std::vector<MeasurementSpec>& instruments) {
  const auto* arm = std::get_if<SerialArmSpec>(&variant.problem.robot);
  WaysOfInstruments::Readings readings;
  for (const MeasurementSpec& one : instruments) readings.push_back(make_measurement(one));
  require_one_tool(variant.problem, instruments, readings);
  std::optional<WaysOfInstruments> ways;
  if (arm != nullptr && !arm->ways.empty()) ways.emplace(*arm, variant, instruments, readings);
  std::vector<InstrumentOfList> list;
  for (std::size_t k = 0; k < instruments.size(); ++k) {
    const MeasurementSpec& one = instruments[k];
    list.push_back({one.name, nullptr, one.noise_factor});
    InstrumentOfList& listed = list.back();
    listed.together = members_of(one) != nullptr;
    auto tip = ways ? ways->of(one, *readings[k], listed.moving) : make_tip(variant);
    listed.model = std::make_unique<ExplicitModel>(std::move(tip), std::move(readings[k]), one.repeatability);
  }
  return std::make_unique<InstrumentChoice>(std::move(list));
}

std::unique_ptr<IdentificationModel> observed(const ProblemVariant& variant) {
  const Problem& problem = variant.problem;
  if (const auto* compensator = std::get_if<CompensatorGeometrySpec>(&problem.robot))
    return std::make_unique<CompensatorGeometry>(*compensator, problem.measurement);
  if (const std::vector<MeasurementSpec>* instruments = instruments_of(problem.measurement))
    return seen_by_each(variant, *instruments);
  return observe(make_tip(variant), problem.measurement, problem);
}

}  // namespace

Problem without_pose_errors(Problem problem) {
  for_each_instrument(problem.measurement, [](MeasurementSpec& instrument) { instrument.repeatability = {}; });
  set_joint_noise(problem.robot, 0.0);
  return problem;
}

namespace {

/// Lists of measured poses have a column for each: one name cannot be both.
void require_names_of_their_own(const IdentificationModel& model, const SourcePlace& robot) {
  for (const Coordinate& c : model.coordinates())
    for (const Reading& reading : model.readings())
      if (c.name == reading.name)
        throw InputError(robot, "joint '" + c.name + "' has the name of a reading of the instrument",
                         "rename the joint or the target");
}

}  // namespace

std::unique_ptr<IdentificationModel> make_model(const ProblemVariant& variant) {
  const Problem& problem = variant.problem;
  if (variant.spec.convention != VariantSpec::Convention::frames &&
      !std::holds_alternative<SerialArmSpec>(problem.robot))
    throw CannotDo("variant '" + variant.spec.name + "': parameters dh and mdh are those of a serial arm");
  const bool difference = problem.measurement.loaded_minus_unloaded;
  std::unique_ptr<IdentificationModel> model =
      observed({difference ? without_pose_errors(problem) : problem, variant.spec});
  // Before anything is put around it: what the arm is linearised at, its tool poses follow, too.
  apply_nominal(*model, variant);
  if (difference) model = std::make_unique<LoadDifference>(std::move(model));
  require_names_of_their_own(*model, problem.at(problem.robot_line));
  return model;
}

std::unique_ptr<TipModel> make_tip(const ProblemVariant& variant) {
  return std::visit(MakeTip{variant.problem, variant.spec}, variant.problem.robot);
}

std::unique_ptr<IdentificationModel> make_model(const Problem& problem) {
  return make_model({problem, problem.variants.front()});
}

}  // namespace posewright
