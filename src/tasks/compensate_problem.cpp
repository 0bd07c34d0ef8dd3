#include "posewright/tasks/compensate_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "posewright/model/calibrated_values.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/table.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {
namespace {

// Poses that one thread takes at a time: Ctrl-C is heard between them.
constexpr std::size_t chunk = 512;
// m and rad: what a platform's way through its actuators and back leaves.
constexpr double rounding = 1e-9;

ProblemVariant calibrated_variant(const Problem& problem) {
  if (!problem.parameters)
    throw InputError({problem.file.string(), 0}, "no calibrated parameters", "a parameters file");
  return {problem, find_variant(problem, problem.parameters->variant.value)};
}

/// The robot as its controller knows it: nominal parameters, joints that stand where they read and do not bend.
std::unique_ptr<TipModel> nominal_tip(const ProblemVariant& calibrated, bool elastic) {
  Problem problem = calibrated.problem;
  VariantSpec variant = calibrated.spec;
  problem.parameters.reset();
  variant.nominal.clear();
  variant.convention = VariantSpec::Convention::frames;
  if (auto* arm = std::get_if<SerialArmSpec>(&problem.robot)) {
    if (!elastic) arm->elastostatic.reset();
    arm->joint_effects.clear();
    arm->temperature.reset();
  }
  return make_tip({problem, variant});
}

std::unique_ptr<TipModel> calibrated_tip(const ProblemVariant& calibrated) {
  auto tip = make_tip(calibrated);
  if (tip == nullptr) throw CannotDo("this robot has no tip to bring to a pose");
  return tip;
}

/// Calibrated less nominal of the robot's own parameters; what belongs to the instrument is left out.
std::vector<double> corrections(const ProblemVariant& calibrated, const TipModel& tip) {
  const auto model = make_model(calibrated);
  const std::vector<CalibratedValue> values = calibrated_values(calibrated, *model, {});
  std::vector<double> result(tip.parameters().size(), 0.0);
  for (std::size_t i = 0; i < result.size(); ++i)
    // A target may be called as a joint is: the robot's parameters come first.
    for (const CalibratedValue& value : values)
      if (value.name == tip.parameters()[i].name) {
        result[i] = value.correction();
        break;
      }
  return result;
}

/// Length of the translation and of the rotation among six corrections of a displacement.
std::string shown_displacement(const TipModel& tip, const std::vector<double>& correction, const std::string& frame) {
  double length = 0, angle = 0;
  for (std::size_t i = 0; i < correction.size(); ++i) {
    if (!tip.parameters()[i].name.starts_with(frame)) continue;
    (tip.parameters()[i].unit == "m" ? length : angle) += correction[i] * correction[i];
  }
  if (length == 0 && angle == 0) return "";
  return fmt::format("{}, {}", shown_value(std::sqrt(length), "m"), shown_value(std::sqrt(angle), "rad"));
}

std::string in_own_unit(double value, const std::string& unit) {
  return unit == "m" ? fmt::format("{:.3f} mm", value * 1e3)
                     : fmt::format("{:.4f} deg", value * 180 / std::numbers::pi);
}

class Compensator {
 public:
  Compensator(const Problem& problem, const CompensateOptions& options)
      : problem_(problem),
        options_(options),
        tip_(calibrated_tip(calibrated_variant(problem))),
        correction_(corrections(calibrated_variant(problem), *tip_)) {
    solver_ = std::make_unique<CommandSolver>(nominal_tip(calibrated_variant(problem), options.elastic_target),
                                              calibrated_tip(calibrated_variant(problem)), correction_,
                                              compensation_coordinates(problem), options.solver);
    result_.variant = problem.parameters->variant.value;
    result_.position_only = options.solver.position_only;
    result_.parallel = solver_->is_parallel();
    result_.coordinates = solver_->coordinates();
    for (const Coordinate& c : solver_->commanded()) result_.axes.push_back({c.name, c.unit});
  }

  const CommandSolver& solver() const { return *solver_; }

  Compensation run(const std::vector<PoseList>& lists, const Monitor& monitor) {
    for (const PoseList& list : lists) result_.lists.push_back(solved(list, monitor));
    for (const CompensatedList& list : result_.lists) add(list);
    finish();
    add_notes();
    return std::move(result_);
  }

 private:
  CompensatedList solved(const PoseList& list, const Monitor& monitor) const {
    require_fits(list, solver_->coordinates());
    const std::size_t count = list.configurations.size(), axes = solver_->commanded().size();
    CompensatedList out;
    out.file = list.name;
    out.ids = list.ids;
    out.lines = list.lines;
    out.lines.resize(count, 0);
    for (std::size_t i = out.ids.size(); i < count; ++i) out.ids.push_back(int(i) + 1);
    out.width = solver_->coordinates().size();
    out.configurations.resize(count * out.width);
    out.changes.resize(count * axes);
    if (solver_->is_parallel()) out.actuators.resize(count * axes);
    out.solutions.resize(count);
    require_listed_positions(list);
    std::atomic<std::size_t> done = 0;
    parallel_for((count + chunk - 1) / chunk, thread_count(options_.threads), [&](std::size_t part, int) {
      if (monitor.should_stop()) return;
      const std::size_t end = std::min(count, (part + 1) * chunk);
      for (std::size_t i = part * chunk; i < end; ++i)
        out.solutions[i] = solver_->solve(
            list.configurations[i], {out.configurations.data() + i * out.width, out.width},
            {out.changes.data() + i * axes, axes},
            out.actuators.empty() ? std::span<double>() : std::span(out.actuators.data() + i * axes, axes));
      done += end - part * chunk;
      monitor.report({"poses", double(done), double(count), {}, {}, {}});
    });
    if (done < count) throw CannotDo("stopped before all poses were solved");
    return out;
  }

  /// Refuses positions between those of a listed compliance, where it is unknown.
  void require_listed_positions(const PoseList& list) const {
    for (std::size_t k = 0; k < solver_->coordinates().size(); ++k) {
      const Coordinate& c = solver_->coordinates()[k];
      if (!c.discrete() || c.choice()) continue;
      for (std::size_t i = 0; i < list.configurations.size(); ++i)
        if (std::find(c.values.begin(), c.values.end(), list.configurations[i][k]) == c.values.end())
          throw InputError({list.name, list.lines.empty() ? 0 : list.lines[i]},
                           fmt::format("'{}' is at {}, where its compliance is not known", c.name,
                                       in_own_unit(list.configurations[i][k], c.unit)),
                           "the listed positions of that joint");
    }
  }

  void add(const CompensatedList& list) {
    const std::size_t axes = solver_->commanded().size();
    for (std::size_t i = 0; i < list.solutions.size(); ++i) {
      const CommandSolver::Solution& s = list.solutions[i];
      if (s.outcome != CommandSolver::Outcome::reached) {
        result_.failures.push_back({list.file, list.lines[i], list.ids[i], why_not(s)});
        continue;
      }
      ++result_.compensated;
      for (std::size_t k = 0; k < axes; ++k) {
        const double change = list.changes[i * axes + k];
        result_.axes[k].largest = std::max(result_.axes[k].largest, std::abs(change));
        result_.axes[k].rms += change * change;
      }
      add(s.before, result_.before);
      add(s.after, result_.after);
    }
  }

  static void add(const TipError& error, TipErrorSummary& summary) {
    summary.position_rms += error.position * error.position;
    summary.rotation_rms += error.rotation * error.rotation;
    summary.position_largest = std::max(summary.position_largest, error.position);
    summary.rotation_largest = std::max(summary.rotation_largest, error.rotation);
  }

  void finish() {
    const double count = std::max(1.0, double(result_.compensated));
    const auto root = [&](double& sum) { sum = std::sqrt(sum / count); };
    for (AxisChange& axis : result_.axes) root(axis.rms);
    for (TipErrorSummary* summary : {&result_.before, &result_.after}) {
      root(summary->position_rms);
      root(summary->rotation_rms);
    }
  }

  std::string why_not(const CommandSolver::Solution& s) const {
    using Outcome = CommandSolver::Outcome;
    const std::size_t axes = solver_->commanded().size();
    const auto k = std::size_t(std::max(s.coordinate, 0));
    const Coordinate& c = k < axes ? solver_->commanded()[k] : solver_->coordinates()[k - axes];
    switch (s.outcome) {
      case Outcome::reached:
        return "";
      case Outcome::out_of_reach:
        return "the nominal robot does not reach it";
      case Outcome::no_solution:
        return std::isfinite(s.after.position)
                   ? fmt::format("the calibrated robot does not reach it: {} and {} are left",
                                 shown_value(s.after.position, "m"), shown_value(s.after.rotation, "rad"))
                   : "the calibrated robot does not reach it";
      case Outcome::too_far:
        return fmt::format("'{}' would have to move by {}: a singularity is near", c.name,
                           in_own_unit(s.value, c.unit));
      case Outcome::beyond_limit:
        return fmt::format("'{}' would be at {}, allowed are {} to {}", c.name, in_own_unit(s.value, c.unit),
                           in_own_unit(c.lower, c.unit), in_own_unit(c.upper, c.unit));
    }
    return "";
  }

  void add_notes() {
    if (std::ranges::all_of(correction_, [](double c) { return c == 0; })) {
      // A load bends even a robot whose parameters are nominal.
      const bool still = std::max(result_.before.position_largest, result_.before.rotation_largest) < rounding;
      result_.notes.push_back(
          "no parameter of the robot was estimated in variant '" + calibrated_variant(problem_).spec.name +
          (still ? "': no compensation, poses stay as listed" : "': only what the problem file states is compensated"));
    }
    const std::string base = shown_displacement(*tip_, correction_, "base."),
                      tool = shown_displacement(*tip_, correction_, "tool.");
    if (!base.empty() && !options_.solver.with_base)
      result_.notes.push_back("poses refer to the robot's own base: its estimated displacement (" + base +
                              " from the problem file) is left out; --with-base includes it");
    if (!tool.empty() && options_.solver.with_tool)
      result_.notes.push_back("the tool's correction (" + tool +
                              ") is applied; use --without-tool if another tool works");
    const auto* arm = std::get_if<SerialArmSpec>(&problem_.robot);
    if (arm != nullptr && arm->elastostatic && !options_.elastic_target)
      result_.notes.emplace_back(
          "the deflection under the load of each pose is compensated in full, as for a controller of a stiff robot "
          "(--elastic-target if the poses include the nominal deflection)");
    if (problem_.parameters->unmodelled)
      result_.notes.push_back(fmt::format("the unmodelled effect of the calibration (1σ {}) is not compensated",
                                          shown_value(problem_.parameters->unmodelled->size, "m")));
    if (options_.solver.position_only)
      result_.notes.emplace_back("only positions are compensated; the orientation of the tip is free");
  }

  const Problem& problem_;
  const CompensateOptions& options_;
  std::unique_ptr<TipModel> tip_;
  std::vector<double> correction_;
  std::unique_ptr<CommandSolver> solver_;
  Compensation result_;
};

}  // namespace

ArmInverse nominal_inverse(const Problem& problem) {
  const auto tip = nominal_tip(calibrated_variant(problem), false);
  const auto* chain = dynamic_cast<const SerialChain*>(tip.get());
  if (chain == nullptr) throw CannotDo("this robot has no inverse in closed form: it is no arm of six joints");
  return ArmInverse(chain->description());
}

namespace {

/// Places between the ends of a line that are looked at.
constexpr int line_places = 15;

/// One end of a line.
struct LineEnd {
  ArmInverse::Joints commanded{};
  std::vector<double> listed;  ///< configuration
};

class LineCheck {
 public:
  LineCheck(const CommandSolver& solver, ArmInverse inverse) : solver_(solver), inverse_(std::move(inverse)) {}

  /// Largest distance of the calibrated robot's tool from the line that was meant.
  double deviation(const LineEnd& from, const LineEnd& to, const Eigen::Isometry3d& X_TipTool) const {
    Eigen::Isometry3d X_from, X_to, X;
    if (!solver_.target(from.listed, X_from) || !solver_.target(to.listed, X_to)) return 0;
    const Eigen::Vector3d p = (X_from * X_TipTool).translation(), q = (X_to * X_TipTool).translation();
    const Eigen::Isometry3d first = inverse_.tip(from.commanded) * X_TipTool,
                            last = inverse_.tip(to.commanded) * X_TipTool;
    const Eigen::Quaterniond turned(first.linear()), towards(last.linear());
    ArmInverse::Joints joints = from.commanded;
    double largest = 0;
    for (int k = 1; k <= line_places; ++k) {
      const double s = double(k) / (line_places + 1);
      const Eigen::Isometry3d tool =
          Eigen::Translation3d(first.translation() + s * (last.translation() - first.translation())) *
          turned.slerp(s, towards);
      if (!follow(tool * X_TipTool.inverse(), joints)) return std::numeric_limits<double>::infinity();
      std::vector<double> configuration = from.listed;
      std::copy(joints.begin(), joints.end(), configuration.begin());
      if (!solver_.reached(configuration, X)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, distance((X * X_TipTool).translation(), p, q));
    }
    return largest;
  }

 private:
  static double distance(const Eigen::Vector3d& x, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    const Eigen::Vector3d along = q - p;
    const double length = along.squaredNorm();
    const double s = length > 0 ? std::clamp((x - p).dot(along) / length, 0.0, 1.0) : 0.0;
    return (x - p - s * along).norm();
  }

  /// The joints at a pose that are nearest to the last ones; false if none are near.
  bool follow(const Eigen::Isometry3d& X, ArmInverse::Joints& joints) const {
    static constexpr double most_turn = 1.5;  // rad between two places
    std::vector<ArmBranch> branches;
    inverse_.solve(X, branches);
    double nearest = most_turn;
    ArmInverse::Joints found = joints;
    for (const ArmBranch& branch : branches) {
      ArmInverse::Joints near = joints;
      double turn = 0;
      for (std::size_t i = 0; i < near.size(); ++i) {
        const double change = std::remainder(branch.q[i] - joints[i], 2 * std::numbers::pi);
        near[i] += change;
        turn = std::max(turn, std::abs(change));
      }
      if (turn >= nearest) continue;
      nearest = turn;
      found = near;
    }
    joints = found;
    return nearest < most_turn;
  }

  const CommandSolver& solver_;
  ArmInverse inverse_;
};

/// Compensated points of programs, by element.
std::map<std::string, LineEnd> line_ends(const Compensation& result) {
  std::map<std::string, LineEnd> ends;
  for (const ProgramAccount& program : result.programs)
    for (const CompensatedList& list : result.lists)
      for (const ProgramEntry& entry : program.entries) {
        if (list.file != program.file || entry.point < 0 || entry.treatment != Treatment::compensated) continue;
        const auto p = std::size_t(entry.point);
        const auto commanded = list.configuration(p);
        LineEnd end{{}, {commanded.begin(), commanded.end()}};
        for (std::size_t i = 0; i < end.commanded.size(); ++i) {
          end.commanded[i] = commanded[i];
          end.listed[i] -= list.changes[p * result.axes.size() + i];
        }
        ends.insert_or_assign(entry.element, std::move(end));
      }
  return ends;
}

}  // namespace

void check_lines(const Problem& problem, const CompensateOptions& options, Compensation& result) {
  const auto is_empty = [](const ProgramAccount& program) { return program.lines.empty(); };
  if (std::ranges::all_of(result.programs, is_empty)) return;
  const Compensator compensator(problem, options);
  const LineCheck check(compensator.solver(), nominal_inverse(problem));
  const std::map<std::string, LineEnd> ends = line_ends(result);
  std::vector<const LineMotion*> motions;
  for (const ProgramAccount& program : result.programs)
    for (const LineMotion& motion : program.lines) {
      if (!ends.contains(motion.from) || !ends.contains(motion.to)) continue;
      motions.push_back(&motion);
      result.lines.push_back({program.file, motion.line});
    }
  parallel_for(motions.size(), thread_count(options.threads), [&](std::size_t i, int) {
    const LineMotion& motion = *motions[i];
    result.lines[i].largest = check.deviation(ends.at(motion.from), ends.at(motion.to), motion.X_TipTool);
  });
}

std::vector<Coordinate> compensation_coordinates(const Problem& problem) {
  const auto tip = calibrated_tip(calibrated_variant(problem));
  const auto model = make_model(calibrated_variant(problem));
  // Limits of the workspace are of poses to measure; a program goes wherever robot and controller can.
  Problem anywhere = problem;
  anywhere.workspace.limits.clear();
  const std::vector<Coordinate> limits = limits_in_force(*model, anywhere);
  std::vector<Coordinate> result = tip->coordinates();
  for (Coordinate& c : result)
    for (const Coordinate& narrowed : limits)
      if (narrowed.name == c.name) c = narrowed;
  for (Coordinate& c : result)
    for (const auto& [name, velocity] : problem.workspace.motion.velocity)
      if (name.value == c.name) c.speed = velocity.value;
  return result;
}

Compensation compensate_problem(const Problem& problem, const std::vector<PoseList>& lists,
                                const CompensateOptions& options, const Monitor& monitor) {
  return Compensator(problem, options).run(lists, monitor);
}

}  // namespace posewright
