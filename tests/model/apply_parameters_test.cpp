// Which variants are linearised at calibrated parameters, and which names and units they may have.

#include "posewright/model/apply_parameters.hpp"

#include <gmock/gmock.h>

#include "posewright/model/calibrated_values.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string arm_problem = R"(posewright: 1
robot:
  urdf: arm.urdf
  parameter_names: {lift: j2.z}
measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}
variants:
  few: {parameters: ["j?.offset"], nominal: {j1.offset: 1 mrad, j1.x: 1 mm}}
  all: {parameters: auto, nominal: {j1.offset: 2 mrad}}
  table: {parameters: dh}
design: {poses: 10}
)";

class ApplyParameters : public testing::Test {
 protected:
  ApplyParameters() {
    folder_.write("arm.urdf", urdf_text({{'R', "0 0 0.5", "0 0 0", "0 0 1"}, {'R', "0.4 0 0", "0 0 0", "0 1 0"}}));
    problem = read_problem(folder_.write("p.yaml", arm_problem));
  }

  static CalibratedParameters parameters(const std::string& entries, const std::string& variant = "few") {
    return parse_calibrated_parameters(
        "posewright_parameters: 1\nvariant: " + variant + "\nparameters: {" + entries + "}\n", "cal.yaml");
  }

  double nominal(const std::string& variant, const std::string& name) const {
    for (const VariantSpec& v : problem.variants) {
      if (v.name != variant) continue;
      const auto model = make_model({problem, v});
      for (const Parameter& p : model->parameters())
        if (p.name == name) return p.nominal;
    }
    ADD_FAILURE() << "no such parameter";
    return 0;
  }

  std::string complaint(const CalibratedParameters& p, const std::vector<std::string>& asked = {}) {
    try {
      apply_parameters(problem, p, asked);
      return "accepted";
    } catch (const InputError& error) {
      EXPECT_FALSE(problem.parameters.has_value());
      return error.what();
    }
  }

  Problem problem;

 private:
  TemporaryFolder folder_;
};

TEST_F(ApplyParameters, InTheCalibratedVariantTheyWinOverItsNominalAndInOthersItsNominalStands) {
  const auto notes = apply_parameters(problem, parameters("j1.offset: {value: 0.5}, lift: {value: 0.25}"), {});
  EXPECT_THAT(notes, ElementsAre("cal.yaml: variant 'table' has parameters of another kind and keeps its nominal "
                                 "values"));
  EXPECT_EQ(nominal("few", "j1.offset"), 0.5);
  EXPECT_EQ(nominal("few", "j1.x"), 0.001);
  EXPECT_EQ(nominal("few", "j2.z"), 0.25);
  EXPECT_EQ(nominal("all", "j1.offset"), 0.002);
  EXPECT_EQ(nominal("all", "j2.z"), 0.25);
}

TEST_F(ApplyParameters, TheVariantAskedForTakesThemAsItsOwn) {
  apply_parameters(problem, parameters("j1.offset: {value: 0.5}"), {"all"});
  EXPECT_EQ(nominal("all", "j1.offset"), 0.5);
  EXPECT_EQ(nominal("few", "j1.offset"), 0.001);
  // Also where the calibrated one is not in this problem file.
  apply_parameters(problem, parameters("j1.offset: {value: 0.75}", "before"), {"all"});
  EXPECT_EQ(nominal("all", "j1.offset"), 0.75);
}

TEST_F(ApplyParameters, CorrectionsAreThoseFromTheRobotsOwnValues) {
  apply_parameters(problem, parameters("j1.offset: {value: 0.5}"), {});
  const VariantSpec& few = problem.variants.front();
  const auto model = make_model({problem, few});
  std::vector<double> correction(model->parameters().size(), 0.0);
  correction[0] = 0.125;
  for (const CalibratedValue& v : calibrated_values({problem, few}, *model, correction)) {
    const double expected = v.name == "base.x" ? 0.125 : v.name == "j1.offset" ? 0.5 : v.name == "j1.x" ? 0.001 : 0.0;
    EXPECT_NEAR(v.correction(), expected, 1e-16) << v.name;
  }
}

TEST_F(ApplyParameters, UnknownNamesOtherUnitsAndOtherKindsAreRefusedWithTheLineOfTheFile) {
  EXPECT_THAT(complaint(parameters("j9.offset: {value: 1}")),
              HasSubstr("cal.yaml:3: 'j9.offset' is not a parameter of variant 'few'; parameters: base.x"));
  EXPECT_THAT(complaint(parameters("j1.offset: {value: 1, unit: deg}")),
              HasSubstr("cal.yaml:3: 'j1.offset' is in 'deg'; allowed: rad, values are in SI"));
  EXPECT_THAT(complaint(parameters("j1.offset: {value: 0.001, nominal: 0.1}")),
              HasSubstr("cal.yaml:3: 'j1.offset' was 0.1 before it was calibrated, this robot's is 0: these are "
                        "parameters of another robot"));
  EXPECT_THAT(complaint(parameters("j1.offset: {value: 1}", "before")),
              HasSubstr("cal.yaml:2: 'before' is not a variant of"));
  EXPECT_THAT(complaint(parameters("j1.offset: {value: 1}"), {"table"}),
              HasSubstr("cal.yaml:2: has parameters of the kind 'frames', variant 'table' is 'dh'"));
  EXPECT_THAT(complaint(parameters("j1.offset: {value: 1}"), {"none"}), HasSubstr("has no variant 'none'"));
  // Nothing is half applied.
  EXPECT_EQ(nominal("few", "j1.offset"), 0.001);
}

}  // namespace
}  // namespace posewright
