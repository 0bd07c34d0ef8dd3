#include "continuous.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlopt.hpp>
#include <span>

#include "exchange.hpp"
#include "planners.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/planning/ascent.hpp"
#include "posewright/planning/block_gradient.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

constexpr int evaluations_per_pose = 300;
constexpr int most_rounds = 20, rough_rounds = 2;
// Of a set: more would look for the same places.
constexpr std::size_t poses_at_once = 4;
// A round that gains less than this of Φ is the last. Without a gradient, and with a cell to be asked of every step,
// rounds are dear: there it is so much of the best plan.
constexpr double round_gain = 1e-6, dear_round_gain = 2e-5;
constexpr int joint_evaluations = 200;
// MMA's own work grows with the square of the number of coordinates.
constexpr std::size_t most_joint_coordinates = 500;

Eigen::MatrixXd information_of(const DesignTask& task, const BlockArray& blocks) {
  const auto all = blocks.all();
  Eigen::MatrixXd M = all.transpose() * all;
  if (task.candidates.prior != nullptr) M += *task.candidates.prior;
  return M;
}

/// Φ of the others and one block.
class OnePose : public BlockObjective {
 public:
  OnePose(const InformationFunction& function, Eigen::MatrixXd rest)
      : function_(function), rest_(std::move(rest)), value_(function.with_block(rest_)) {}
  double value(const BlockArray::ConstMap& J) override { return value_->value(J); }
  const Eigen::MatrixXd& gradient(const BlockArray::ConstMap& J) override {
    gradient_ = function_.gradient(rest_ + J.transpose() * J);
    return gradient_;
  }

 private:
  const InformationFunction& function_;
  Eigen::MatrixXd rest_, gradient_;
  std::unique_ptr<BlockFunction> value_;
};

/// True if pose i may go to q: far enough from the others, and within the limit of its choice.
bool may_move(const DesignTask& task, const PoseSet& poses, std::size_t i, std::span<const double> q) {
  const Spacing& spacing = task.space->spacing();
  const auto chosen = [&](std::span<const double> at) { return at[std::size_t(spacing.limited)]; };
  int alike = 0;
  for (std::size_t j = 0; j < poses.configurations.size(); ++j) {
    if (j == i) continue;
    if (spacing.too_near(poses.configurations[j], q)) return false;
    alike += !spacing.most.empty() && chosen(poses.configurations[j]) == chosen(q);
  }
  return spacing.most.empty() || alike < spacing.most[std::size_t(chosen(q))];
}

/// All poses at once on the unit box.
class Joint {
 public:
  Joint(const DesignTask& task, const PoseSet& poses)
      : task_(task),
        axes_(task.space->axes()),
        probe_(task.space->probe()),
        gradient_(*task.space, poses.blocks.rows(), poses.blocks.columns()),
        moving_(gradient_.moving()),
        start_(poses),
        now_(poses),
        best_(poses) {}

  std::size_t size() const { return moving_.size() * start_.configurations.size(); }
  std::vector<double> unit() const {
    std::vector<double> u;
    for (const auto& q : start_.configurations)
      for (const std::size_t k : moving_)
        u.push_back(std::clamp((q[k] - axes_[k].lower) / (axes_[k].upper - axes_[k].lower), 0.0, 1.0));
    return u;
  }
  const PoseSet& best() const { return best_; }

  double operator()(const std::vector<double>& u, std::vector<double>& gradient) {
    const double bad = start_.value - 1 - std::abs(start_.value);
    std::fill(gradient.begin(), gradient.end(), 0.0);
    if (!place(u)) return bad;
    const Eigen::MatrixXd M = information_of(task_, now_.blocks);
    now_.value = task_.criterion->function().value(M);
    if (!std::isfinite(now_.value)) return bad;
    if (now_.value > best_.value && valid()) keep();
    if (!gradient.empty()) differentiate(task_.criterion->function().gradient(M), gradient);
    return now_.value;
  }

 private:
  bool place(const std::vector<double>& u) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < now_.configurations.size(); ++i) {
      auto& q = now_.configurations[i];
      for (const std::size_t k : moving_) {
        const double x = u[at++];
        q[k] = x >= 1.0 ? axes_[k].upper
                        : std::max(axes_[k].lower, axes_[k].lower + x * (axes_[k].upper - axes_[k].lower));
      }
      if (!probe_->block(q, now_.blocks.row(i, 0), now_.blocks.stride())) return false;
    }
    return true;
  }

  bool valid() {
    for (std::size_t i = 0; i < now_.configurations.size(); ++i)
      if (!probe_->feasible(now_.configurations[i]) || !may_move(task_, now_, i, now_.configurations[i])) return false;
    return true;
  }

  void keep() {
    best_.configurations = now_.configurations;
    best_.value = now_.value;
    std::copy_n(now_.blocks.data(), now_.blocks.count() * std::size_t(now_.blocks.rows() * now_.blocks.stride()),
                best_.blocks.data());
  }

  void differentiate(const Eigen::MatrixXd& S, std::span<double> gradient) {
    for (std::size_t i = 0; i < now_.configurations.size(); ++i) {
      slope_.noalias() = 2 * now_.blocks.block(i) * S;
      gradient_.at(*probe_, now_.configurations[i], slope_, gradient.subspan(i * moving_.size(), moving_.size()));
    }
  }

  struct Copy : PoseSet {
    explicit Copy(const PoseSet& other) {
      configurations = other.configurations;
      candidates = other.candidates;
      value = other.value;
      std::vector<int> all(other.blocks.count());
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = int(i);
      blocks = other.blocks.subset(all);
    }
  };

  const DesignTask& task_;
  const std::vector<ConfigurationSpace::Axis>& axes_;
  std::unique_ptr<ConfigurationSpace::Probe> probe_;
  BlockGradient gradient_;
  BlockArray::RowMatrix slope_;
  const std::vector<std::size_t>& moving_;
  Copy start_, now_, best_;
};

double call(const std::vector<double>& u, std::vector<double>& gradient, void* data) {
  return (*static_cast<Joint*>(data))(u, gradient);
}

bool improve_jointly(const DesignTask& task, PoseSet& poses) {
  Joint joint(task, poses);
  if (joint.size() == 0 || joint.size() > most_joint_coordinates) return false;
  nlopt::opt method(nlopt::LD_MMA, unsigned(joint.size()));
  method.set_lower_bounds(0.0);
  method.set_upper_bounds(1.0);
  method.set_max_objective(call, &joint);
  method.set_xtol_abs(1e-8);
  method.set_maxeval(joint_evaluations);
  std::vector<double> u = joint.unit();
  double value = 0.0;
  try {
    method.optimize(u, value);
  } catch (const nlopt::roundoff_limited&) {
    // The best design seen stands.
  } catch (const std::runtime_error&) {
    // NLopt's "generic failure": the same.
  }
  if (!(joint.best().value > poses.value)) return false;
  for (std::size_t i = 0; i < poses.configurations.size(); ++i)
    if (joint.best().configurations[i] != poses.configurations[i]) poses.candidates[i] = -1;
  poses.configurations = joint.best().configurations;
  poses.value = joint.best().value;
  std::copy_n(joint.best().blocks.data(),
              poses.blocks.count() * std::size_t(poses.blocks.rows() * poses.blocks.stride()), poses.blocks.data());
  return true;
}

}  // namespace

double value_of_blocks(const DesignTask& task, const BlockArray& blocks) {
  return task.criterion->function().value(information_of(task, blocks));
}

PoseSet pose_set_of(const DesignTask& task, const std::vector<int>& members) {
  PoseSet poses;
  poses.candidates = members;
  poses.blocks = task.candidates.blocks->subset(members);
  for (const int i : members)
    poses.configurations.emplace_back(task.space->candidate(i).begin(), task.space->candidate(i).end());
  poses.value = value_of_blocks(task, poses.blocks);
  return poses;
}

void write_to(Design& design, const PoseSet& poses, std::size_t candidates) {
  design.members.clear();
  design.added.clear();
  for (std::size_t i = 0; i < poses.configurations.size(); ++i) {
    if (poses.candidates[i] >= 0) {
      design.members.push_back(poses.candidates[i]);
      continue;
    }
    design.members.push_back(int(candidates + design.added.size()));
    design.added.push_back(poses.configurations[i]);
  }
  design.value = poses.value;
}

namespace {

/// Poses moved one after the other, each a few times.
class InTurn {
 public:
  /// @param at_once  poses that look for their place at the same time, from the same information
  InTurn(const DesignTask& task, PoseSet& poses, std::size_t at_once, int threads)
      : task_(task), poses_(poses), at_once_(at_once), threads_(threads) {
    for (std::size_t i = 0; i < at_once; ++i) probes_.push_back(task.space->probe());
  }

  long go(int rounds, const Monitor& monitor) {
    const double enough = task_.space->margins()
                              ? round_gain
                              : std::max(round_gain, dear_round_gain * task_.criterion->function().degree());
    long moves = 0;
    for (int round = 0; round < rounds && !monitor.should_stop(); ++round) {
      const double before = poses_.value;
      for (std::size_t i = 0; i < poses_.configurations.size() && !monitor.should_stop(); i += at_once_)
        moves += move_from(i, monitor);
      monitor.report({"continuous", double(round + 1), double(rounds), poses_.value, task_.bound, {}});
      if (poses_.value - before < enough) break;
    }
    return moves;
  }

 private:
  /// Every thread count gives the same: how many look at once is fixed, and each has a probe of its own.
  long move_from(std::size_t first, const Monitor& monitor) {
    const std::size_t count = std::min(at_once_, poses_.configurations.size() - first);
    const Eigen::MatrixXd M = information_of(task_, poses_.blocks);
    std::vector<AscentResult> found(count);
    parallel_for(count, threads_, [&](std::size_t k, int) {
      if (k == 0 || !monitor.should_stop()) found[k] = ascent(first + k, M, *probes_[k]);
    });
    const double before = poses_.value;
    long moves = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = first + k;
      if (found[k].q.empty() || !(found[k].value > before + 1e-12)) continue;
      // Another one that moved meanwhile may have taken what this one was after.
      if (moves > 0) {
        const double promised = found[k].value - before;
        found[k].value = value_with(i, found[k].q, *probes_[k]);
        if (!(found[k].value - poses_.value > 0.5 * promised) || !may_move(task_, poses_, i, found[k].q))
          found[k] = ascent(i, information_of(task_, poses_.blocks), *probes_[k]);
      }
      moves += take(i, found[k], *probes_[k]);
    }
    return moves;
  }

  AscentResult ascent(std::size_t i, const Eigen::MatrixXd& M, ConfigurationSpace::Probe& probe) const {
    const auto block = poses_.blocks.block(i);
    OnePose objective(task_.criterion->function(), M - block.transpose() * block);
    const auto accept = [&](std::span<const double> q) { return may_move(task_, poses_, i, q); };
    const auto from = [&](std::vector<double> start) {
      return ascend(*task_.space, probe, objective, poses_.blocks.rows(), poses_.blocks.columns(), std::move(start),
                    evaluations_per_pose, accept);
    };
    AscentResult best = from(poses_.configurations[i]);
    // A station or a load case is nothing to move along: the most promising other one starts a search of its own.
    std::vector<double> other = best_other_choice(best.q, objective, probe);
    if (other.empty()) return best;
    const AscentResult found = from(std::move(other));
    if (found.value > best.value && probe.feasible(found.q) && accept(found.q)) return found;
    return best;
  }

  /// q with one choice made otherwise, that of the largest value; empty if there is none.
  std::vector<double> best_other_choice(const std::vector<double>& q, BlockObjective& objective,
                                        ConfigurationSpace::Probe& probe) const {
    std::vector<double> best, other = q;
    double most = -std::numeric_limits<double>::infinity();
    ProbedBlock block(poses_.blocks.rows(), poses_.blocks.columns());
    const std::vector<ConfigurationSpace::Axis>& axes = task_.space->axes();
    for (std::size_t k = 0; k < axes.size(); ++k) {
      for (const double value : axes[k].choices) {
        if (value == q[k]) continue;
        other[k] = value;
        if (!block.at(probe, other) || !probe.perhaps_feasible(other)) continue;
        const double reached = objective.value(block.map());
        if (!(reached > most)) continue;
        most = reached;
        best = other;
      }
      other[k] = q[k];
    }
    return best;
  }

  double value_with(std::size_t i, std::span<const double> q, ConfigurationSpace::Probe& probe) {
    ProbedBlock moved(poses_.blocks.rows(), poses_.blocks.columns());
    if (!moved.at(probe, q)) return -std::numeric_limits<double>::infinity();
    const auto block = poses_.blocks.block(i);
    Eigen::MatrixXd M = information_of(task_, poses_.blocks) - block.transpose() * block;
    M.noalias() += moved.map().transpose() * moved.map();
    return task_.criterion->function().value(M);
  }

  bool take(std::size_t i, const AscentResult& found, ConfigurationSpace::Probe& probe) {
    if (!(found.value > poses_.value + 1e-12) || found.q == poses_.configurations[i]) return false;
    poses_.configurations[i] = found.q;
    poses_.candidates[i] = -1;
    poses_.value = found.value;
    probe.block(found.q, poses_.blocks.row(i, 0), poses_.blocks.stride());
    return true;
  }

  const DesignTask& task_;
  PoseSet& poses_;
  const std::size_t at_once_;
  const int threads_;
  std::vector<std::unique_ptr<ConfigurationSpace::Probe>> probes_;
};

}  // namespace

long improve(const DesignTask& task, PoseSet& poses, int threads, const Monitor& monitor) {
  long moves = InTurn(task, poses, poses_at_once, thread_count(threads)).go(most_rounds, monitor);
  if (task.space->is_box() && !monitor.should_stop() && improve_jointly(task, poses)) ++moves;
  return moves;
}

long improve_roughly(const DesignTask& task, PoseSet& poses, const Monitor& monitor) {
  return InTurn(task, poses, 1, 1).go(rough_rounds, monitor);
}

namespace {

/// The best design of `exchange`, improved. Throws CannotDo if the task has no configurations.
Design continuous_design(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) {
  if (task.space == nullptr)
    throw CannotDo("continuous moves poses between the candidates: it needs a robot, not blocks");
  if (!task.criterion->of_information_alone())
    throw CannotDo("continuous cannot move poses for a plan with reserve; use exchange or tabu");
  Design design = exchange_planner().plan(task, options, monitor);
  PoseSet poses = pose_set_of(task, design.members);
  design.exchanges += improve(task, poses, options.threads, monitor);
  write_to(design, poses, task.candidates.blocks->count());
  design.stopped = design.stopped || monitor.should_stop();
  return design;
}

}  // namespace

Planner continuous_planner() {
  return {"continuous", "exchange, then the poses themselves are moved by NLopt", continuous_design};
}

}  // namespace posewright
