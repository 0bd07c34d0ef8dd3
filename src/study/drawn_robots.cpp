#include "posewright/study/drawn_robots.hpp"

#include <cstring>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "posewright/cell/line_of_sight.hpp"
#include "posewright/model/readable.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/study/pose_distance.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

// What else is drawn from the seed must not be the same numbers.
constexpr std::uint64_t robots_stream = 0x0b057;

/// Lines of sight that were looked at once; others are asked for as ever.
class RememberedSight : public Visibility {
 public:
  RememberedSight(std::shared_ptr<const Visibility> sight, const Configurations& configurations, int threads)
      : sight_(std::move(sight)) {
    const std::size_t n = configurations.count(), targets = std::size_t(sight_->targets());
    std::vector<char> seen(n * targets);
    parallel_for(n, thread_count(threads), [&](std::size_t i, int) {
      sight_->visible(configurations[i], {seen.data() + i * targets, targets});
    });
    for (std::size_t i = 0; i < n; ++i) known_.try_emplace(key(configurations[i]), seen.data() + i * targets, targets);
  }

  int targets() const override { return sight_->targets(); }
  void visible(std::span<const double> q, std::span<char> seen) const override {
    const auto found = known_.find(key(q));
    if (found == known_.end()) return sight_->visible(q, seen);
    std::memcpy(seen.data(), found->second.data(), seen.size());
  }

 private:
  static std::string key(std::span<const double> q) {
    return {reinterpret_cast<const char*>(q.data()), q.size_bytes()};
  }

  std::shared_ptr<const Visibility> sight_;
  std::unordered_map<std::string, std::string> known_;
};

Configurations some_of(const Configurations& all, const std::vector<int>& which) {
  Configurations some;
  some.dimension = all.dimension;
  for (const int i : which) append(some, all[std::size_t(i)]);
  return some;
}

}  // namespace

DrawnRobots::DrawnRobots(const Study& study, const Configurations& sought, const Monitor& monitor)
    : columns_(study.first().columns),
      model_(place_variant({*study.problem, *study.first().spec}, study.cell, monitor).model),
      seed_(study.planner.seed) {
  if (study.cell->sight() != nullptr && study.cell->sight()->judges())
    model_->set_visibility(std::make_shared<RememberedSight>(
        std::shared_ptr<const Visibility>(study.cell, study.cell->sight()), sought, study.planner.threads));
}

std::vector<double> DrawnRobots::correction(int robot) const {
  Random random(seed_ ^ robots_stream, std::uint64_t(robot));
  return drawn_correction(columns_, model_->parameters().size(), random);
}

BlockArray DrawnRobots::blocks(int robot, const Configurations& configurations) const {
  const std::vector<double> truth = correction(robot);
  BlockArray blocks(configurations.count(), model_->block_rows(columns_.selected), int(columns_.selected.size()));
  Linearisation scratch;
  std::vector<double> q(std::size_t(configurations.dimension));
  for (std::size_t i = 0; i < configurations.count(); ++i) {
    if (readable(*model_, configurations[i], truth, q) &&
        whitened_block(*model_, q, truth, columns_.selected, scratch, blocks.row(i, 0), blocks.stride()) &&
        blocks.block(i).allFinite())
      continue;
    blocks.block(i).setZero();
  }
  return blocks;
}

RobustRequest robust_request(const Study& study, const DrawnRobots& robots, const Configurations& configurations,
                             std::vector<int> plan) {
  const Variant& variant = study.first();
  RobustRequest request;
  request.aim = study.robust->aim;
  request.scenarios = study.robust->draws;
  request.poses = int(plan.size());
  request.nuisance = variant.nuisance_counts ? 0 : variant.columns.nuisance;
  request.repeats = study.repeats;
  request.spacing = study.distance.among(configurations);
  request.planner = study.planner;
  request.plan = std::move(plan);
  request.nominal = search_blocks(variant, configurations, study.planner.threads);
  request.prior = variant.prior;
  request.blocks = [&robots, &configurations](int robot, const std::vector<int>& which) {
    return robots.blocks(robot, which.empty() ? configurations : some_of(configurations, which));
  };
  if (variant.prior.size() == 0) return request;
  // Tolerances are the same for every robot; what is measured already tells each something else.
  const auto m = Eigen::Index(variant.columns.selected.size());
  Eigen::MatrixXd tolerances = Eigen::MatrixXd::Zero(m, m);
  if (study.prior) tolerances.diagonal() = tolerances_of(variant.columns).cwiseAbs2().cwiseInverse();
  request.prior_of = [&robots, known = known_before(study), tolerances](int robot) {
    Eigen::MatrixXd prior = tolerances;
    if (known.count() == 0) return prior;
    const BlockArray blocks = robots.blocks(robot, known);
    prior.noalias() += blocks.all().transpose() * blocks.all();
    return prior;
  };
  return request;
}

}  // namespace posewright
