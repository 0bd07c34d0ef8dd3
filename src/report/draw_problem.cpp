#include "posewright/report/draw_problem.hpp"

#include <algorithm>
#include <array>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/report/report_result.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/workspace/candidates.hpp"
#include "report_scene.hpp"

namespace posewright {
namespace {

constexpr std::uint64_t look_stream = 0x100c;

/// What may be wrong in space, in the order in which it is left out.
constexpr std::array<void (*)(Problem&), 3> easements = {
    [](Problem& problem) { problem.workspace.motion.reachable = false; },
    [](Problem& problem) {
      problem.workspace.line_of_sight.reset();
      for_each_instrument(problem.measurement, [](MeasurementSpec& one) { one.line_of_sight.reset(); });
    },
    [](Problem& problem) { problem.workspace.collision.reset(); },
};

class ProblemDrawing {
 public:
  ProblemDrawing(const Problem& problem, const DrawOptions& options, const Monitor& monitor)
      : problem_(problem), eased_(problem), options_(options), monitor_(monitor) {
    if (!options.ways) eased_.workspace.motion.reachable = false;
  }

  ProblemReport make() {
    place();
    const std::vector<Coordinate>& coordinates = variant_.workspace->proposed();
    report_.reasons = variant_.workspace->reasons();
    report_.scene.title = title_of(problem_.file);
    report_.file = problem_.file.string();
    report_.sha256 = problem_.sha256;
    report_.seed = options_.seed;
    look(home(coordinates));
    for (int k = 0; k < options_.evenly && !monitor_.should_stop(); ++k) look(drawn(coordinates, k));
    report_.evenly = int(poses_.size()) - 1;
    look_at_feasible();
    fill_scene(report_.scene, Drawing(problem_, *variant_.cell), poses_, coordinates, {});
    return std::move(report_);
  }

 private:
  void fault(const std::string& what) {
    if (std::find(report_.faults.begin(), report_.faults.end(), what) == report_.faults.end())
      report_.faults.push_back(what);
  }

  /// Robot and cell as the problem has them, or without the check that cannot be made.
  void place() {
    for (std::size_t k = 0;; ++k) {
      try {
        variant_ = place_variant({eased_, find_variant(eased_, "")}, make_cell(eased_), monitor_);
        return;
      } catch (const InputError& error) {
        if (k == easements.size()) throw;
        fault(error.what());
      } catch (const CannotDo& error) {
        if (k == easements.size() || monitor_.should_stop()) throw;
        fault(error.what());
      }
      easements[k](eased_);
    }
  }

  std::vector<double> home(const std::vector<Coordinate>& coordinates) {
    try {
      return home_configuration(problem_.workspace.motion, problem_, variant_.workspace->coordinates());
    } catch (const InputError& error) {
      fault(error.what());
      return drawn(coordinates, 0);
    }
  }

  std::vector<double> drawn(const std::vector<Coordinate>& coordinates, int k) const {
    Random random(options_.seed, mix_bits(std::uint64_t(k)) + look_stream);
    std::vector<double> q;
    q.reserve(coordinates.size());
    for (const Coordinate& c : coordinates)
      q.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))]
                               : random.uniform(c.lower, c.upper));
    return q;
  }

  void look(std::span<const double> q) {
    report_.verdicts.push_back(variant_.workspace->violation(q));
    poses_.emplace_back(int(poses_.size()), std::vector<double>(q.begin(), q.end()));
  }

  /// Where few configurations are feasible, even draws show hardly one.
  void look_at_feasible() {
    SamplingOptions sampling;
    sampling.count = std::size_t(options_.feasible);
    sampling.seed = options_.seed;
    sampling.threads = options_.threads;
    try {
      const Configurations found = sample_configurations(*variant_.workspace, sampling, monitor_);
      for (std::size_t i = 0; i < found.count(); ++i) look(found[i]);
    } catch (const CannotDo& error) {
      fault(error.what());
    }
  }

  const Problem& problem_;
  Problem eased_;
  const DrawOptions& options_;
  const Monitor& monitor_;
  Variant variant_;
  ProblemReport report_;
  std::vector<std::pair<int, std::vector<double>>> poses_;
};

}  // namespace

bool is_problem(const std::filesystem::path& file) {
  if (file.extension() != ".yaml" && file.extension() != ".yml") return false;
  const std::string text = "\n" + read_text(file, plan_size_limit);
  return text.find("\nposewright_parameters:") == std::string::npos;
}

ProblemReport draw_problem(const Problem& problem, const DrawOptions& options, const Monitor& monitor) {
  return ProblemDrawing(problem, options, monitor).make();
}

}  // namespace posewright
