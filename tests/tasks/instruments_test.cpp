// A list of instruments from the problem file to plan, evaluation and calibration. The second roads: problems of one
// instrument each, information summed by hand, least squares with kinematics and derivatives of their own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "posewright/blocks/block_array.hpp"
#include "posewright/lists/measured_data.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/model/campaigns.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/place_stations.hpp"
#include "posewright/tasks/simulate_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/planar_instruments.hpp"
#include "tests/kit/recompute.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

constexpr const char* mixed_example = "instruments/tracker_and_camera.yaml";

std::vector<int> every_parameter(const IdentificationModel& model) {
  std::vector<int> all(model.parameters().size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// JᵀJ of one block, all parameters.
Eigen::MatrixXd information_at(const IdentificationModel& model, const std::vector<double>& q) {
  const std::vector<int> all = every_parameter(model);
  BlockArray::RowMatrix J(model.block_rows(all), Eigen::Index(all.size()));
  Linearisation scratch;
  if (!whitened_block(model, q, {}, all, scratch, J.data(), int(J.cols()))) return {};
  return J.transpose() * J;
}

class InformationOf : public testing::TestWithParam<const char*> {};

TEST_P(InformationOf, AListIsTheSumOfThatOfItsInstruments) {
  const Problem problem = example(GetParam());
  const std::vector<MeasurementSpec>& instruments = *instruments_of(problem.measurement);
  const auto mixed = make_model(problem);
  for (std::size_t k = 0; k < instruments.size(); ++k)
    EXPECT_EQ(mixed->coordinates().back().labels.at(k), instruments[k].name);
  // Eight readings a row of the board's 96 would make a block as high; six motions and the lens do not.
  EXPECT_LT(mixed->block_rows(every_parameter(*mixed)), 32);
  Random random(3, 1);
  Eigen::MatrixXd whole =
      Eigen::MatrixXd::Zero(Eigen::Index(mixed->parameters().size()), Eigen::Index(mixed->parameters().size()));
  Eigen::MatrixXd sum = whole;
  for (std::size_t k = 0; k < instruments.size(); ++k) {
    Problem alone = problem;
    alone.measurement = instruments[k];
    alone.variants = {VariantSpec{}};
    const auto model = make_model(alone);
    std::vector<int> at;
    for (const Parameter& p : model->parameters()) {
      const bool of_robot = p.name.starts_with("base.") || p.name.starts_with("tool.") || p.name.starts_with("joint_");
      const std::string name = of_robot ? p.name : name_in(instruments[k].name, p.name);
      int i = 0;
      while (i < int(mixed->parameters().size()) && mixed->parameters()[std::size_t(i)].name != name) ++i;
      ASSERT_LT(i, int(mixed->parameters().size())) << name;
      EXPECT_EQ(mixed->parameters()[std::size_t(i)].nominal, p.nominal);
      EXPECT_EQ(mixed->parameters()[std::size_t(i)].tolerance, p.tolerance);
      at.push_back(i);
    }
    for (int done = 0; done < 30;) {
      std::vector<double> q = random_configuration(*mixed, random);
      q.back() = double(k);
      if (!mixed->measurable(q)) continue;
      ++done;
      std::vector<double> own(q.begin(), q.end() - 1);
      own.resize(model->coordinates().size(), 0.0);
      ASSERT_TRUE(model->measurable(own));
      whole += information_at(*mixed, q);
      sum(at, at) += information_at(*model, own);
    }
  }
  Eigen::VectorXd unit = sum.diagonal().cwiseSqrt();
  unit = (unit.array() > 0).select(unit, 1.0);
  EXPECT_LT((whole - sum).cwiseQuotient(unit * unit.transpose()).cwiseAbs().maxCoeff(), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Examples, InformationOf, testing::Values(mixed_example, "instruments/tracker_and_level.yaml"),
                         [](const auto& file) { return test_name(file.param); });

TEST(InstrumentList, LinearRowsAndFactoredRowsTellTheSame) {
  const auto model = make_model(example(mixed_example));
  const std::vector<int> all = every_parameter(*model);
  ASSERT_LT(model->block_rows(all), model->rows());
  Random random(5, 2);
  Linearisation at;
  for (int done = 0; done < 20;) {
    const std::vector<double> q = random_configuration(*model, random);
    if (!model->measurable(q)) continue;
    ++done;
    ASSERT_TRUE(model->linearise(q, {}, all, at));
    const Eigen::MatrixXd plain = at.G.transpose() * at.covariance.ldlt().solve(at.G);
    Eigen::VectorXd unit = plain.diagonal().cwiseSqrt();
    unit = (unit.array() > 0).select(unit, 1.0);
    EXPECT_LT((information_at(*model, q) - plain).cwiseQuotient(unit * unit.transpose()).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(InstrumentList, APlanStatesTheInstrumentOfEveryPoseAndWhatEachGives) {
  const Planar planar;
  const Plan plan = plan_problem(planar.problem, {}, Monitor{});
  ASSERT_EQ(plan.instruments.size(), 2U);
  EXPECT_GT(plan.certificate.efficiency, 0.9);
  ASSERT_TRUE(plan.certificate.proved);
  // By the definition, from the written poses: log det M, so that S = M⁻¹.
  const auto model = make_model(planar.problem);
  const VariantColumns columns = select_columns(*model, {planar.problem, planar.problem.variants.front()});
  std::vector<Eigen::Matrix3d> part(2, Eigen::Matrix3d::Zero());
  std::vector<int> poses(2, 0);
  Linearisation at;
  double before = 0;
  for (const std::vector<double>& q : configurations_of(planar.problem, plan)) {
    EXPECT_LE(before, q.back()) << "one instrument after the other";
    before = q.back();
    ASSERT_TRUE(model->linearise(q, {}, columns.selected, at));
    part[std::size_t(q.back())] += at.G.transpose() * at.covariance.inverse() * at.G;
    ++poses[std::size_t(q.back())];
  }
  const Eigen::Matrix3d M = part[0] + part[1];
  double shares = plan.prior_share;
  for (std::size_t k = 0; k < 2; ++k) {
    const InstrumentWorth& worth = plan.instruments[k];
    EXPECT_EQ(worth.name, k == 0 ? "tracker" : "gauge");
    EXPECT_EQ(worth.poses, poses[k]);
    EXPECT_NEAR(worth.share, (part[k] * M.inverse()).trace() / 3, 1e-9);
    shares += worth.share;
    const Eigen::Matrix3d left = M - part[k];
    EXPECT_NEAR(worth.without, std::pow(left.determinant() / M.determinant(), 1.0 / 3), 1e-7);
    if (worth.without == 0) continue;
    ASSERT_EQ(worth.sigma_without.size(), 3U);
    for (Eigen::Index j = 0; j < 3; ++j)
      EXPECT_NEAR(worth.sigma_without[std::size_t(j)].second, std::sqrt(left.inverse()(j, j)),
                  1e-6 * worth.sigma_without[std::size_t(j)].second);
  }
  EXPECT_NEAR(shares, 1.0, 1e-12);
  EXPECT_EQ(plan.prior_share, 0.0);

  const nlohmann::json json = nlohmann::json::parse(plan_json(plan));
  EXPECT_EQ(json["instruments"].size(), 2U);
  EXPECT_THAT(json["poses"][0]["instrument"].get<std::string>(), testing::AnyOf("tracker", "gauge"));
  EXPECT_THAT(plan_summary(plan), HasSubstr("left without it"));

  // The list is read back with its instruments, and gives the same figures.
  for (const char* file : {"plan.json", "poses.csv"}) {
    const bool csv = std::string(file) == "poses.csv";
    const PoseList list = read_poses(planar.folder.write(file, csv ? poses_csv(plan) : plan_json(plan)),
                                     pose_coordinates(planar.problem));
    const Plan again = evaluate_problem(planar.problem, list, {}, Monitor{}).plan;
    EXPECT_EQ(again.log_det, plan.log_det);
    ASSERT_EQ(again.instruments.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(again.instruments[k].poses, plan.instruments[k].poses);
      EXPECT_NEAR(again.instruments[k].share, plan.instruments[k].share, 1e-9);
      EXPECT_NEAR(again.instruments[k].without, plan.instruments[k].without, 1e-9);
    }
  }
}

TEST(InstrumentList, SharesAndThePriorsAddToOneForEveryCriterion) {
  for (const char* criterion : {"a", "o3", "o5", "test_pose"}) {
    const Planar planar(
        replaced_once(planar_problem, "criterion: o1",
                      std::string("prior: tolerance, test_poses: {random: 20}, criterion: ") + criterion));
    const Plan plan = plan_problem(planar.problem, {}, Monitor{});
    ASSERT_EQ(plan.instruments.size(), 2U);
    EXPECT_GT(plan.prior_share, 0) << criterion;
    EXPECT_NEAR(plan.prior_share + plan.instruments[0].share + plan.instruments[1].share, 1, 1e-12) << criterion;
    for (const InstrumentWorth& worth : plan.instruments) {
      EXPECT_GT(worth.without, 0) << criterion << ": tolerances leave nothing open";
      EXPECT_LE(worth.without, 1) << criterion;
      EXPECT_EQ(worth.sigma_without.size(), 3U) << criterion;
      EXPECT_EQ(worth.expected_without.has_value(), worth.poses < 8) << criterion << worth.name;
    }
  }
}

/// log det of the first columns' complement, columns that no row has left out.
double log_det_of_interest(const Eigen::MatrixXd& M, int nuisance) {
  std::vector<int> kept, kept_nuisance;
  for (int j = 0; j < int(M.cols()); ++j)
    if (M(j, j) > 0) {
      kept.push_back(j);
      if (j < nuisance) kept_nuisance.push_back(j);
    }
  const auto log_det = [&](const std::vector<int>& own) {
    const Eigen::VectorXd unit = M.diagonal()(own).cwiseSqrt();
    const Eigen::MatrixXd scaled = M(own, own).cwiseQuotient(unit * unit.transpose());
    return scaled.ldlt().vectorD().array().log().sum() + 2 * unit.array().log().sum();
  };
  return log_det(kept) - log_det(kept_nuisance);
}

TEST(InstrumentList, WithoutAnInstrumentItsOwnNuisanceIsNotAskedFor) {
  Problem problem = example(mixed_example);
  VariantSpec& variant = problem.variants.front();
  variant.automatic = false;
  for (const char* name : {"joint_a2.offset", "joint_a3.offset", "joint_a4.offset", "joint_a5.offset"})
    variant.parameters.push_back({name, 0});
  problem.design.candidates.value = 300;
  problem.design.method.value = "exchange";
  const Plan plan = plan_problem(problem, {}, Monitor{});
  const auto model = make_model(problem);
  const VariantColumns columns = select_columns(*model, {problem, variant});
  const auto m = Eigen::Index(columns.selected.size());
  std::vector<Eigen::MatrixXd> part(2, Eigen::MatrixXd::Zero(m, m));
  Linearisation at;
  for (const std::vector<double>& q : configurations_of(problem, plan)) {
    ASSERT_TRUE(model->linearise(q, {}, columns.selected, at));
    part[std::size_t(q.back())] += at.G.transpose() * at.covariance.ldlt().solve(at.G);
  }
  const double whole = log_det_of_interest(part[0] + part[1], columns.nuisance);
  ASSERT_EQ(plan.instruments.size(), 2U);
  // The camera alone tells of base and board together only.
  EXPECT_EQ(plan.instruments[0].without, 0);
  EXPECT_TRUE(plan.instruments[0].sigma_without.empty());
  const InstrumentWorth& camera = plan.instruments[1];
  EXPECT_GT(camera.without, 0);
  EXPECT_NEAR(camera.without, std::exp((log_det_of_interest(part[0], columns.nuisance) - whole) / 4), 1e-6);
  EXPECT_TRUE(camera.expected_without.has_value());
  EXPECT_EQ(int(camera.sigma_without.size()), int(m) - 12) << "all but those of camera and board";
  for (const auto& [name, sigma] : camera.sigma_without) {
    EXPECT_EQ(name.find("@camera."), std::string::npos);
    for (const PlannedParameter& p : plan.parameters) {
      if (p.label.name == name) {
        EXPECT_GE(sigma, *p.sigma * (1 - 1e-9)) << name;
      }
    }
  }
}

TEST(InstrumentList, PosesThatGainNothingWhileTheyAreTooFewAreFound) {
  // Camera and board take three pictures; fewer tell the arm nothing, so no single exchange leads there.
  Problem problem = example(mixed_example);
  problem.design.candidates.value = 100;
  problem.design.restarts.value = 1;
  problem.design.method.value = "exchange";
  const Plan plan = plan_problem(problem, {}, Monitor{});
  EXPECT_GT(plan.certificate.efficiency, 0.7);
  for (const InstrumentWorth& worth : plan.instruments) EXPECT_GT(worth.poses, 0) << worth.name;
}

TEST(InstrumentList, AnInstrumentThatSeesNothingIsNamed) {
  Problem problem = example(mixed_example);
  auto& camera =
      std::get<CameraMeasurement>(std::get<InstrumentList>(problem.measurement.instrument).instruments[1].instrument);
  camera.camera.rpy = -camera.camera.rpy;
  problem.design.candidates.value = 100;
  EXPECT_THAT(message_of<std::runtime_error>([&] { plan_problem(problem, {}, Monitor{}); }),
              HasSubstr("measurement: instrument 'camera' reads at none of the 100 candidates"));
}

TEST(InstrumentList, MixedDataGiveTheLeastSquaresOfAnotherRoad) {
  const Planar planar;
  const PlanarReadings data(4);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
  std::vector<int> of;
  for (int round = 0; round < 20; ++round) {
    data.stack(x, r, J, of);
    x += (J.transpose() * J).ldlt().solve(J.transpose() * r);
  }
  data.stack(x, r, J, of);
  const Eigen::Matrix3d C = (J.transpose() * J).inverse();
  const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(r.size(), r.size()) - J * C * J.transpose();

  const Calibration result = calibrated(planar, data.csv);
  ASSERT_EQ(result.fit.noise_factor, 1.0);
  ASSERT_EQ(result.parameters.size(), 3U);
  for (int j = 0; j < 3; ++j) {
    const CalibratedParameter& p = result.parameters[std::size_t(j)];
    EXPECT_NEAR(p.value - p.label.nominal, x[j], 1e-4 * std::sqrt(C(j, j))) << p.label.name;
    EXPECT_NEAR(p.sigma, std::sqrt(C(j, j)), 1e-6 * p.sigma) << p.label.name;
  }
  ASSERT_EQ(result.instruments.size(), 2U);
  double chi_square = 0, freedom = 0;
  for (int k = 0; k < 2; ++k) {
    const InstrumentResiduals& one = result.instruments[std::size_t(k)];
    double square = 0, trace = 0;
    for (Eigen::Index row = 0; row < r.size(); ++row)
      if (of[std::size_t(row)] == k) {
        square += r[row] * r[row];
        trace += left(row, row);
      }
    EXPECT_NEAR(one.chi_square, square, 1e-5 * square) << one.name;
    EXPECT_NEAR(one.freedom, trace, 1e-6 * trace) << one.name;
    EXPECT_EQ(one.poses, k == 0 ? 20 : 40);
    EXPECT_EQ(one.readings, 40);
    EXPECT_TRUE(one.test.possible);
    EXPECT_GT(one.test.probability, 0.01);
    chi_square += one.chi_square;
    freedom += one.freedom;
  }
  EXPECT_NEAR(chi_square, result.fit.chi_square, 1e-9 * chi_square);
  EXPECT_NEAR(freedom, result.fit.freedom, 1e-9 * freedom);
  EXPECT_THAT(calibration_text(result), HasSubstr("times the stated noise"));
}

TEST(InstrumentList, AnInstrumentWhoseNoiseIsStatedWronglyShowsAlone) {
  const Planar planar;
  const Calibration result = calibrated(planar, PlanarReadings(7, 3.0).csv);
  ASSERT_EQ(result.instruments.size(), 2U);
  EXPECT_GT(result.instruments[0].test.probability, 0.01);
  EXPECT_LT(result.instruments[1].test.probability, 1e-6);
  EXPECT_NEAR(std::sqrt(result.instruments[1].chi_square / result.instruments[1].freedom), 3.0, 0.8);
}

/// Least squares of the test's own, of the poses that `counts` names.
template <class Counts>
Eigen::Vector3d least_squares(const PlanarReadings& data, const Counts& counts) {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int round = 0; round < 20; ++round) {
    Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < data.q1.size(); ++i) {
      if (!counts(i)) continue;
      const auto at = [&](const Eigen::Vector3d& p) {
        return data.rows(p, data.q1[i], data.q2[i], data.instrument[i]);
      };
      Eigen::MatrixXd D(data.z[i].size(), 3);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(k);
        D.col(k) = (at(x + h) - at(x - h)) / 2e-6;
      }
      M += D.transpose() * D;
      b += D.transpose() * (data.z[i] - at(x));
    }
    x += M.ldlt().solve(b);
  }
  return x;
}

TEST(InstrumentList, HelpIsThatOfPosesThatAreLeftOut) {
  const Planar planar;
  const PlanarReadings data(4);
  const Calibration result = calibrated(planar, data.csv);
  constexpr std::size_t groups = 10;
  for (int k = 0; k < 2; ++k) {
    double sums[2] = {0, 0};
    std::vector<double> gains;
    for (std::size_t i = 0; i < data.q1.size(); ++i) {
      if (data.instrument[i] == k) continue;
      double squares[2];
      for (const bool with : {true, false}) {
        const Eigen::Vector3d x = least_squares(
            data, [&](std::size_t n) { return n % groups != i % groups && (with || data.instrument[n] != k); });
        const Eigen::VectorXd off = data.z[i] - data.rows(x, data.q1[i], data.q2[i], data.instrument[i]);
        sums[with ? 0 : 1] += squares[with ? 0 : 1] = off.squaredNorm() / double(off.size());
      }
      gains.push_back(squares[1] - squares[0]);
    }
    const double n = double(gains.size());
    const double mean = std::accumulate(gains.begin(), gains.end(), 0.0) / n;
    double variance = 0;
    for (const double gain : gains) variance += std::pow(gain - mean, 2) / (n - 1);
    ASSERT_TRUE(result.instruments[std::size_t(k)].help);
    const InstrumentHelp& help = *result.instruments[std::size_t(k)].help;
    EXPECT_NEAR(help.with, std::sqrt(sums[0] / n), 1e-4 * help.with);
    EXPECT_NEAR(help.without, std::sqrt(sums[1] / n), 1e-4 * help.without);
    EXPECT_NEAR(help.gain, mean / std::sqrt(variance / n), 0.01);
    EXPECT_TRUE(help.alone.empty());
  }
}

TEST(InstrumentList, AnInstrumentCountsWithTheNoiseThatItsResidualsShow) {
  const Planar planar;
  const PlanarReadings data(7, 3.0);
  const Calibration result = calibrated(planar, data.csv);
  EXPECT_EQ(result.instruments[0].noise_factor, 1.0);
  EXPECT_NEAR(result.instruments[1].noise_factor, 3.0, 0.8);
  // At the maximum of the likelihood, by the definition: a stated factor that is larger or smaller has less.
  const auto minus_two_log = [&](double factor) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    Eigen::VectorXd r;
    Eigen::MatrixXd J, M;
    std::vector<int> of;
    for (int round = 0; round < 20; ++round) {
      data.stack(x, r, J, of);
      for (Eigen::Index row = 0; row < r.size(); ++row)
        if (of[std::size_t(row)] == 1) {
          r[row] /= factor;
          J.row(row) /= factor;
        }
      M = J.transpose() * J;
      x += M.ldlt().solve(J.transpose() * r);
    }
    return 2 * double(std::ranges::count(of, 1)) * std::log(factor) + std::log(M.determinant()) + r.squaredNorm();
  };
  const double best = result.instruments[1].noise_factor;
  EXPECT_LT(minus_two_log(best), minus_two_log(1.01 * best));
  EXPECT_LT(minus_two_log(best), minus_two_log(best / 1.01));
  EXPECT_THAT(result.notes, testing::Contains(HasSubstr("gauge counts with")));
}

TEST(InstrumentList, AnInstrumentThatAgreesWithItselfIsNotBlamed) {
  // Many lengths with an effect that no parameter describes, a few points without.
  const Planar planar;
  const Calibration result = calibrated(planar, PlanarReadings(3, 1.0, 30.0).csv);
  EXPECT_EQ(result.instruments[0].noise_factor, 1.0);
  EXPECT_GT(result.instruments[1].noise_factor, 10.0);
  EXPECT_FALSE(result.instruments[0].help && result.instruments[0].help->harms());
  const std::array<double, 3> truth{2e-3, -1e-3, 4e-4};
  for (std::size_t j = 0; j < 3; ++j) {
    const CalibratedParameter& p = result.parameters[j];
    EXPECT_NEAR(p.value - p.label.nominal, truth[j], 4 * p.sigma) << p.label.name;
  }
}

TEST(InstrumentList, ProbabilitiesOfAnInstrumentAreEven) {
  // Under right noise each p is as often below 0.1 as in a tenth of the draws.
  const Planar planar;
  std::array<int, 2> low{};
  constexpr int draws = 60;
  for (unsigned seed = 100; seed < 100 + draws; ++seed) {
    CalibrateOptions options;
    options.data = planar.folder.write("data.csv", PlanarReadings(seed).csv);
    options.prior = Prior::none;
    options.profile.choice = ProfileChoice::none;
    const Calibration result = calibrate_problem(planar.problem, options, Monitor{});
    for (std::size_t k = 0; k < 2; ++k) low[k] += result.instruments[k].test.probability < 0.1 ? 1 : 0;
  }
  for (const int count : low) EXPECT_NEAR(double(count) / draws, 0.1, 0.11);
}

TEST(InstrumentList, AnglesCountFromTheNominalOrientation) {
  const Planar planar(R"(posewright: 1
robot: {urdf: arm.urdf}
measurement:
  - {name: pose, type: pose, components: [x, y, rz], device: {type: isotropic, noise: {position: 20 um, rotation: 1 mrad}}}
  - {name: level, type: inclination, range: 30 deg, device: {type: isotropic, noise: 1 mrad}}
  - {name: both, together: [pose, level]}
variants: {arm: {parameters: [q1.offset, q2.offset]}}
)");
  const auto model = make_model(planar.problem);
  std::vector<double> correction(model->parameters().size());
  for (const char* offset : {"q1.offset", "q2.offset"}) {
    std::size_t i = 0;
    while (model->parameters()[i].name != offset) ++i;
    correction[i] = 1e-3;
  }
  // Two joints that turn by 1 mrad each about z turn the tip by 2 mrad; a level sees nothing of that.
  for (const double reader : {0.0, 2.0}) {
    Eigen::VectorXd y;
    ASSERT_TRUE(model->predict(std::vector<double>{0.4, 0.9, reader}, correction, y));
    EXPECT_NEAR(y[2], 2e-3, 1e-12);
    EXPECT_EQ(std::isfinite(y[3]), reader == 2.0);
  }
}

TEST(InstrumentList, SimulationsCoverAndTheirReadingsAreReadBack) {
  const Planar planar;
  const Plan plan = plan_problem(planar.problem, {}, Monitor{});
  const PoseList list = read_poses(planar.folder.write("plan.json", plan_json(plan)), pose_coordinates(planar.problem));
  SimulateOptions options;
  options.experiment.draws = 300;
  const Simulation simulation = simulate_problem(planar.problem, list, options, Monitor{});
  for (const SimulatedParameter& p : simulation.parameters) {
    ASSERT_TRUE(p.errors.has_value());
    EXPECT_NEAR(p.errors->observed / p.predicted, 1.0, 0.15) << p.label.name;
    EXPECT_NEAR(p.errors->coverage, 0.95, 0.04) << p.label.name;
  }
  const auto model = make_model(planar.problem);
  const MeasuredData back =
      read_measured_data(planar.folder.write("data.csv", simulation.first_readings), planar.problem, *model);
  EXPECT_EQ(simulation.hidden, 0) << "the others do not read";
  ASSERT_EQ(back.poses.size(), plan.poses.size());
  for (const MeasuredPose& pose : back.poses)
    EXPECT_EQ(pose.y.array().isFinite().count(), pose.q.back() == 0 ? 2 : 1) << "of its own instrument alone";
}

TEST(InstrumentList, WrongDataAreOneLine) {
  const Planar planar;
  const std::string head = "id,q1,q2,instrument,tracker.target.x,tracker.target.y,gauge.A-T\n";
  const auto complaint = [&](const std::string& rows) {
    return message_of<std::runtime_error>([&] { calibrated(planar, head + rows); });
  };
  EXPECT_THAT(complaint("1,0.1,0.2,tracker,1,0.5,\n2,0.3,0.2,laser,1,0.5,\n"),
              testing::AllOf(HasSubstr("data.csv:3"), HasSubstr("laser"), HasSubstr("tracker")));
  EXPECT_THAT(complaint("1,0.1,0.2,tracker,1,0.5,\n2,0.3,0.2,gauge,1,0.5,0.7\n"),
              HasSubstr("data.csv:3: has a value of 'tracker.target.x' in a row of instrument 'gauge'"));
  EXPECT_THAT(message_of<std::runtime_error>(
                  [&] { calibrated(planar, "id,q1,q2,tracker.target.x,tracker.target.y\n1,0.1,0.2,1,0.5\n"); }),
              HasSubstr("instrument"));
}

TEST(InstrumentList, WhatIsForOneInstrumentRefusesAList) {
  const Planar planar;
  const std::string list = "p.yaml:3: measurement is a list of instruments; ";
  CalibrateOptions options;
  options.data = planar.folder.write("a.csv", PlanarReadings(1).csv);
  options.campaigns = {planar.folder.write("b.csv", PlanarReadings(2).csv)};
  options.moved = Moved::base;
  EXPECT_THAT(message_of<std::runtime_error>([&] { calibrate_problem(planar.problem, options, Monitor{}); }),
              HasSubstr(list));
  const Planar placed(std::string(planar_problem) + "workspace: {stations: {among: {B: [1, 0, 0]}}}\n");
  EXPECT_THAT(message_of<std::runtime_error>([&] { place_stations(placed.problem, {}, Monitor{}); }),
              HasSubstr(list + "stations"));
}

}  // namespace
}  // namespace posewright
