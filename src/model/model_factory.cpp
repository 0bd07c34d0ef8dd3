#include "posewright/model/model_factory.hpp"

#include "posewright/model/explicit_model.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/six_pus.hpp"
#include "posewright/model/urdf_reader.hpp"

namespace posewright {
namespace {

/// One overload a robot: a new robot is one file and one row here.
struct Make {
  const Problem& problem;

  std::unique_ptr<IdentificationModel> operator()(const SerialArmSpec& arm) const {
    auto chain = std::make_unique<SerialChain>(read_urdf_chain(arm, problem.at(arm.line)));
    return std::make_unique<ExplicitModel>(std::move(chain), make_measurement(problem.measurement));
  }
  std::unique_ptr<IdentificationModel> operator()(const SixPusSpec& spec) const {
    return std::make_unique<SixPus>(spec, problem.workspace.limits, make_measurement(problem.measurement));
  }
};

}  // namespace

std::unique_ptr<IdentificationModel> make_model(const Problem& problem) {
  return std::visit(Make{problem}, problem.robot);
}

}  // namespace posewright
