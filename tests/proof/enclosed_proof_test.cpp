// Largest sensitivities of six-legged robots, proved by Taylor models. Second roads: actuators and blocks of the model
// at random poses, dense sampling taken uphill.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/proof/workspace_proof.hpp"
#include "posewright/study/space.hpp"
#include "posewright/support/random.hpp"
#include "posewright/workspace/workspace.hpp"
#include "src/proof/enclosed_sensitivity.hpp"
#include "tests/kit/taylor_value.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

/// A platform of either kind, its legs anywhere near those of a hexapod, and what a test of its sensitivity needs.
struct RandomPlatform {
  std::unique_ptr<IdentificationModel> model;
  std::unique_ptr<Workspace> workspace;
  Problem problem;
  std::vector<int> selected;
  Eigen::MatrixXd scale, factor;  // R of the columns, T of d(q) = ‖J(q) R⁻¹ T‖²
  bool slides;

  RandomPlatform(const TemporaryFolder& folder, Random& random) : slides(random.uniform() < 0.7) {
    const double size = random.uniform(0.5, 2), lean = random.uniform(-0.2, 0.2);
    std::string legs;
    for (int i = 0; i < 6; ++i) {
      const double at = 60 * i + random.uniform(-15, 15), a = size * random.uniform(0.25, 0.35),
                   b = size * random.uniform(0.12, 0.22), turn = random.uniform(5, 35) * (i % 2 == 0 ? 1 : -1);
      const std::string u =
          slides ? fmt::format(", u: [{}, {}, 1]", lean * random.uniform(-1, 1), lean * random.uniform(-1, 1)) : "";
      // As long as it has to be at the reference, or it slides there; where it starts does not matter.
      legs +=
          fmt::format("    - {{a: [{}, {}, 0], b: [{}, {}, {}], l: {}{}}}\n", a * std::cos(at * degree),
                      a * std::sin(at * degree), b * std::cos((at + turn) * degree), b * std::sin((at + turn) * degree),
                      0.01 * random.normal(), size * random.uniform(0.6, 0.65), u);
    }
    const double travel = size * random.uniform(0.02, 0.3), angle = random.uniform(0.2, 6),
                 length = size * random.uniform(0.0005, 0.02);
    const bool deforms = slides && random.uniform() < 0.5;
    problem = read_problem(folder.write(
        "p.yaml",
        fmt::format("posewright: 1\nrobot:\n  model: {}\n  reference: {{position: [0, 0, {}]}}\n  actuators: {{travel: "
                    "[{}, {}], noise: {} um}}\n  legs:\n",
                    slides ? "six_pus" : "gough", 0.55 * size, -travel, travel, random.uniform(0, 5)) +
            legs +
            (random.uniform() < 0.5
                 ? "measurement:\n  type: points\n  targets: {A: [0.1, 0, 0], B: [-0.1, 0.02, 0], C: [0, 0.1, 0.03]}\n "
                   " "
                   "device: {type: isotropic, noise: 3 um}\n"
                 : "measurement: {type: pose, device: {type: isotropic, noise: {position: 5 um, rotation: 0.001 "
                   "deg}}}\n") +
            "variants:\n  v:\n    parameters: [\"*.ax\", \"*.ay\", \"*.bx\", \"*.bz\", \"*.l\"" +
            (slides ? ", \"*.ux\", kappa_3, K_12" : "") + ", base.x, base.rz, leg_2.az]\n" +
            (deforms ? "    nominal: {kappa: 0.02, K_14: -0.03, kappa_5: 0.01}\n" : "") +
            fmt::format("workspace: {{pose: {{x: [{0}, {1}], y: [{0}, {1}], z: [{0}, {1}], rx: [{2} deg, {3} deg], ry: "
                        "[{2} deg, {3} deg], rz: [{2} deg, {3} deg]}}}}\n",
                        -length, length, -angle, angle)));
    model = make_model(problem);
    const VariantColumns columns = select_columns(*model, {problem, problem.variants.front()});
    selected = columns.selected;
    workspace = std::make_unique<Workspace>(*model, problem, nullptr);
    const auto m = Eigen::Index(selected.size());
    // Columns of very different size, as units and tolerances make them: rounding has its chance.
    Eigen::VectorXd sizes(m);
    for (double& s : sizes) s = std::pow(10.0, random.uniform(-6, 6));
    scale = sizes.asDiagonal();
    factor.resize(m, 1 + random.index(int(m)));
    for (double& value : factor.reshaped()) value = random.normal();
    factor = scale * factor * 1e-4;
  }

  static constexpr double degree = 0.017453292519943295;
};

class EnclosedProofs : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

int wanted_platforms() {
  const char* wanted = std::getenv("POSEWRIGHT_RANDOM_PLATFORMS");
  return wanted != nullptr ? std::atoi(wanted) : 2;
}

TEST_F(EnclosedProofs, EveryActuatorIsInsideItsModel) {
  double narrowest = 1;
  long asked = 0, known = 0;
  for (int i = 0; i < 5 * wanted_platforms(); ++i) {
    Random random(31, std::uint64_t(i));
    const RandomPlatform platform(folder_, random);
    const Monomials& monomials = Monomials::of(6, 2 + random.index(3));
    // Boxes of several widths side by side.
    std::vector<TaylorModel> q;
    std::array<std::vector<double>, TaylorModel::boxes> middle, half;
    for (const Coordinate& c : platform.workspace->coordinates()) {
      TaylorModel::Values lower, upper;
      for (std::size_t box = 0; box < TaylorModel::boxes; ++box) {
        const double width = c.upper - c.lower, part = box % 2 == 0 ? 0.5 : 0.5 * random.uniform();
        lower[box] = c.lower + 0.4 * width * random.uniform();
        upper[box] = lower[box] + part * width * random.uniform();
        middle[box].push_back(0.5 * (lower[box] + upper[box]));
        half[box].push_back(0.5 * (upper[box] - lower[box]));
      }
      q.push_back(TaylorModel::variable(monomials, int(q.size()), lower, upper));
    }
    EnclosedModel enclosed;
    ASSERT_TRUE(enclose(*platform.model, q, platform.selected, nullptr, enclosed)) << "platform " << i;
    const auto limits = std::span(enclosed.allowed).last(12);
    for (int sample = 0; sample < 30 * int(TaylorModel::boxes); ++sample) {
      const std::size_t box = std::size_t(sample) % TaylorModel::boxes;
      std::vector<double> x, place;
      for (std::size_t k = 0; k < 6; ++k) {
        x.push_back(sample < 15 * int(TaylorModel::boxes) ? random.uniform(-1, 1) : random.uniform() < 0.5 ? -1 : 1);
        place.push_back(middle[box][k] + half[box][k] * x.back());
      }
      std::vector<double> rho(6);
      if (!platform.model->actuator_values(place, rho)) continue;
      for (std::size_t leg = 0; leg < 6; ++leg) {
        const Coordinate& actuator = platform.model->actuators()[leg];
        const TaylorModel &above = limits[2 * leg], &below = limits[2 * leg + 1];
        ++asked;
        if (!above.known(box)) continue;
        ++known;
        EXPECT_LE(std::abs(double(taylor_value(above, x, box)) - (rho[leg] - actuator.lower)),
                  above.radius(box) + 1e-14);
        EXPECT_LE(std::abs(double(taylor_value(below, x, box)) - (actuator.upper - rho[leg])),
                  below.radius(box) + 1e-14);
        narrowest = std::min(narrowest, above.radius(box));
      }
    }
  }
  // Nothing would be wrong of boxes of which nothing is said.
  EXPECT_GT(10 * known, 9 * asked);
  // A radius as wide as the strokes would hold everything as well.
  EXPECT_LT(narrowest, 1e-10);
}

TEST_F(EnclosedProofs, NoPoseOfARandomPlatformIsBeyondTheBound) {
  int wide = 0, judged = 0;
  for (int i = 0; i < wanted_platforms(); ++i) {
    Random random(29, std::uint64_t(i));
    const RandomPlatform platform(folder_, random);
    const auto space = make_configuration_space(
        {{platform.model.get(), platform.workspace.get(), platform.selected, {}}}, {}, {}, {}, platform.scale);
    const int m = int(platform.selected.size()), rows = platform.model->block_rows(platform.selected);
    const auto probe = space->probe();
    BlockArray block(1, rows, m);
    // Dense sampling, its best taken uphill by ever smaller random steps.
    double largest = 0;
    std::vector<double> best, q;
    for (int sample = 0; sample < 4000; ++sample) {
      if (sample >= 1500 && best.empty()) break;
      const double reach = std::pow(0.997, sample - 1500);
      q.clear();
      for (std::size_t k = 0; k < space->axes().size(); ++k) {
        const ConfigurationSpace::Axis& axis = space->axes()[k];
        const double width = axis.upper - axis.lower;
        const double at = sample < 1500 ? random.uniform(axis.lower - 0.2 * width, axis.upper + 0.2 * width)
                                        : best[k] + (random.uniform() < 0.4 ? reach * width * random.normal() : 0.0);
        q.push_back(std::clamp(at, axis.lower, axis.upper));
      }
      if (!probe->feasible(q) || !probe->block(q, block.row(0, 0), block.stride())) continue;
      const double d = (std::as_const(block).block(0) * platform.factor).squaredNorm();
      if (d > largest) largest = d, best = q;
    }
    if (best.empty()) continue;
    const auto proved = [&](int threads, long boxes) {
      WorkspaceBound result;
      result.factor = platform.factor;
      result.degree = 1e-2 * largest;
      result.max_ratio = 0.9 * largest / result.degree;
      WorkspaceBoundOptions options;
      options.tolerance = 0.01;
      options.threads = threads;
      if (boxes == 0) options.proof.seconds = 1e-3;
      prove_workspace(result, *space, 1000, rows, options, Monitor{});
      return result.proof;
    };
    const WorkspaceProof proof = proved(2, 1);
    ASSERT_EQ(proof.why_not, "") << "platform " << i;
    ++judged;
    const double bound = proof.max_ratio * 1e-2 * largest;
    EXPECT_GE(bound, largest * (1 - 1e-12)) << "platform " << i;
    wide += int(bound > 1.02 * largest);
    if (i % 4 == 0) {
      EXPECT_EQ(proved(1, 1).max_ratio, proof.max_ratio);
    }
    // Stopped at once it has a bound or says that it has none.
    const WorkspaceProof stopped = proved(1, 0);
    if (stopped.why_not.empty()) {
      EXPECT_GE(stopped.max_ratio * 1e-2 * largest, largest * (1 - 1e-12));
    } else {
      EXPECT_EQ(stopped.why_not, WorkspaceProof::cut_short);
    }
  }
  EXPECT_GT(judged, 0);
  // Random steps do not always find the largest value.
  EXPECT_LE(wide, 1 + judged / 10);
}

}  // namespace
}  // namespace posewright
