#include "report_neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <numbers>

#include "neighbour_figures.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/parallel.hpp"
#include "report_scene.hpp"

namespace posewright {
namespace {

// Steps to either side of a pose at most, and where the interpolation is exact.
constexpr int most_reach = 3, node = 2;
// In a cell every place is checked against bodies: beside meshes some milliseconds each. Of all poses so many at most.
constexpr std::size_t most_checked = 3'000;
// A step is a fiftieth of the range, at most this: rad, m.
constexpr double share_of_range = 0.02, most_turn = std::numbers::pi / 90, most_slide = 0.01;
// Where fewer places are told, half as long steps are tried, so often.
constexpr double enough_told = 0.9;
constexpr int most_halvings = 4;
constexpr std::size_t most_coordinates = 8;
// Numbers of all terms: two bytes each in the page, a third more as text.
constexpr double most_terms = 1.6e6;

/// The largest of 1, 2, 5 · 10ⁿ of the unit that people read (degrees, millimetres) that is not above `most`.
double round_step(double most, const std::string& unit) {
  const double shown = unit == "m" ? 1e-3 : std::numbers::pi / 180;
  const double decade = std::pow(10.0, std::floor(std::log10(most / shown * (1 + 1e-9))));
  double best = decade;
  for (const double digit : {2.0, 5.0})
    if (digit * decade <= most / shown * (1 + 1e-9)) best = digit * decade;
  return best * shown;
}

/// Coordinates that a reader may move.
std::vector<ReportNeighbours::Coordinate> moving_coordinates(const std::vector<Coordinate>& all,
                                                             std::vector<std::size_t>& places) {
  std::vector<ReportNeighbours::Coordinate> moving;
  int written = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Coordinate& c = all[k];
    if (c.choice()) continue;
    if (!c.discrete()) {
      const double most = std::min(share_of_range * (c.upper - c.lower), c.unit == "m" ? most_slide : most_turn);
      moving.push_back({written, round_step(most, c.unit), c.lower, c.upper});
      places.push_back(k);
    }
    ++written;
  }
  return moving;
}

/// No step, then all of one coordinate, then all of two.
std::vector<std::vector<int>> places_of(std::size_t coordinates, int reach) {
  std::vector<std::vector<int>> places(1, std::vector<int>(coordinates, 0));
  const auto each = [reach](auto&& use) {
    for (int k = -reach; k <= reach; ++k)
      if (k != 0) use(k);
  };
  const auto add = [&](std::size_t i, int k, std::size_t j, int l) {
    places.emplace_back(coordinates, 0);
    places.back()[i] = k;
    if (j < coordinates) places.back()[j] = l;
  };
  for (std::size_t i = 0; i < coordinates; ++i) each([&](int k) { add(i, k, coordinates, 0); });
  for (std::size_t i = 0; i < coordinates; ++i)
    for (std::size_t j = i + 1; j < coordinates; ++j) each([&](int k) { each([&](int l) { add(i, k, j, l); }); });
  return places;
}

/// Verdicts in words, each once.
class Reasons {
 public:
  explicit Reasons(const Study& study) : study_(study) {
    for (const Variant& variant : study.variants)
      for (const std::string& reason : variant.workspace->reasons()) names_.push_back(reason);
  }
  const std::vector<std::string>& names() const { return names_; }
  int verdict(std::span<const double> q) const {
    int first = 0;
    for (const Variant& variant : study_.variants) {
      if (const int reason = variant.workspace->violation(q); reason >= 0) return first + reason;
      first += int(variant.workspace->reasons().size());
    }
    return -1;
  }

 private:
  const Study& study_;
  std::vector<std::string> names_;
};

class Neighbourhood {
 public:
  Neighbourhood(const Report& report, const Study& study, const Drawing& drawing)
      : report_(report), study_(study), drawing_(drawing), reasons_(study), figures_(report.information) {
    result_.coordinates = moving_coordinates(study.first().workspace->coordinates(), moving_);
    result_.reasons = reasons_.names();
  }

  /// Why there is none; empty: there is.
  std::string refusal(std::size_t poses) const {
    const std::size_t d = moving_.size();
    if (d == 0 || d > most_coordinates) return fmt::format("a pose has {} coordinates", d);
    if (!figures_.regular()) return "the poses do not determine all parameters";
    const Variant& variant = study_.first();
    const std::size_t of_a_block = 1 + d + d * (d + 1) / 2;
    const double terms = double(poses) * double(of_a_block) *
                         double(variant.model->block_rows(variant.columns.selected)) *
                         double(variant.columns.selected.size());
    if (terms > most_terms) return fmt::format("the page would have {:.1f} million more numbers", terms * 1e-6);
    return {};
  }

  std::optional<ReportNeighbours> make(const std::vector<std::pair<int, std::vector<double>>>& poses, int threads,
                                       const Monitor& monitor) {
    result_.reach = most_reach;
    do result_.places = places_of(moving_.size(), result_.reach);
    while (study_.cell->collision != nullptr && result_.places.size() * poses.size() > most_checked &&
           --result_.reach > 0);
    result_.reach = std::max(result_.reach, 1);
    result_.poses.resize(poses.size());
    std::vector<std::vector<std::optional<Separation>>> nearest(poses.size());
    std::vector<NeighbourErrors> errors(poses.size());
    std::atomic<int> done = 0;
    parallel_for(poses.size(), thread_count(threads), [&](std::size_t i, int) {
      if (monitor.should_stop()) return;
      ReportNeighbours::Pose& pose = result_.poses[i];
      pose.id = poses[i].first;
      errors[i] = interpolate(poses[i].second, pose);
      judge(poses[i].second, pose, nearest[i], monitor);
      draw(poses[i].second, pose);
      monitor.report({"moved poses", double(++done), double(poses.size()), {}, {}, {}});
    });
    if (monitor.should_stop()) return std::nullopt;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      name_bodies(nearest[i], result_.poses[i]);
      result_.efficiency_error = std::max(result_.efficiency_error, errors[i].efficiency);
      result_.sigma_error = std::max(result_.sigma_error, errors[i].sigma);
      result_.accuracy_error = std::max(result_.accuracy_error, errors[i].accuracy);
    }
    return std::move(result_);
  }

 private:
  /// The configuration k steps from q, by the sums that the page does.
  std::vector<double> moved(const std::vector<double>& q, const std::vector<double>& steps,
                            const std::vector<int>& k) const {
    std::vector<double> result = q;
    for (std::size_t j = 0; j < k.size(); ++j)
      if (k[j] != 0) result[moving_[j]] = q[moving_[j]] + k[j] * steps[j];
    return result;
  }

  /// Steps short enough that the interpolated block stands for the model's nearly everywhere.
  NeighbourErrors interpolate(const std::vector<double>& q, ReportNeighbours::Pose& pose) const {
    NeighbourErrors errors;
    Linearisation scratch;
    for (int halvings = 0; halvings <= most_halvings; ++halvings) {
      pose.steps.clear();
      for (const ReportNeighbours::Coordinate& c : result_.coordinates)
        pose.steps.push_back(std::ldexp(c.step, -halvings));
      const auto block_at = [&](const std::vector<int>& k) { return block(moved(q, pose.steps, k), scratch); };
      const std::optional<BlockSurface> surface = BlockSurface::through(moving_.size(), node, block_at);
      pose.told.assign(result_.places.size(), false);
      errors = {};
      if (!surface) continue;
      // More places than that, and half as long steps are tried.
      std::size_t may_be_lost = std::size_t((1 - enough_told) * double(result_.places.size()));
      if (halvings == most_halvings) may_be_lost = result_.places.size();
      std::size_t lost = 0;
      for (std::size_t p = 0; p < result_.places.size() && lost <= may_be_lost; ++p) {
        const auto there = block_at(result_.places[p]);
        if (!there) continue;
        const NeighbourErrors off =
            figures_.compare(pose.id, surface->at(result_.places[p]), surface->middle(), *there);
        pose.told[p] = off.small();
        if (pose.told[p]) errors.include(off);
        else ++lost;
      }
      pose.rows = surface->rows();
      pose.terms = surface->terms();
      pose.scale = surface->scale();
      if (lost <= may_be_lost) break;
    }
    return errors;
  }

  /// Whitened block times tolerance; none where the robot cannot stand.
  std::optional<Eigen::MatrixXd> block(const std::vector<double>& q, Linearisation& scratch) const {
    const Variant& variant = study_.first();
    const std::vector<int>& selected = variant.columns.selected;
    BlockArray::RowMatrix rows(variant.model->block_rows(selected), Eigen::Index(selected.size()));
    if (!whitened_block(*variant.model, q, {}, selected, scratch, rows.data(), int(rows.cols()))) return std::nullopt;
    if (!rows.allFinite()) return std::nullopt;
    return Eigen::MatrixXd(rows * figures_.tolerance().asDiagonal());
  }

  void judge(const std::vector<double>& q, ReportNeighbours::Pose& pose,
             std::vector<std::optional<Separation>>& nearest, const Monitor& monitor) const {
    for (const std::vector<int>& place : result_.places) {
      if (monitor.should_stop()) return;
      const std::vector<double> there = moved(q, pose.steps, place);
      pose.verdicts.push_back(reasons_.verdict(there));
      if (study_.cell->collision != nullptr) nearest.push_back(study_.cell->collision->nearest_bodies(there));
    }
  }

  void name_bodies(const std::vector<std::optional<Separation>>& nearest, ReportNeighbours::Pose& pose) {
    for (const std::optional<Separation>& found : nearest) {
      pose.clearance.push_back(found ? found->distance : 0.0);
      int index = -1;
      if (found) {
        const auto [entry, is_new] = known_.try_emplace({found->first, found->second}, int(result_.bodies.size()));
        if (is_new) result_.bodies.emplace_back(found->first, found->second);
        index = entry->second;
      }
      pose.between.push_back(index);
    }
  }

  void draw(const std::vector<double>& q, ReportNeighbours::Pose& pose) const {
    for (std::size_t j = 0; !report_.chain && j < moving_.size(); ++j) {
      std::vector<int> k(moving_.size(), 0);
      k[j] = result_.reach;
      pose.drawn.push_back(keyframe_at(drawing_, moved(q, pose.steps, k)));
    }
  }

  const Report& report_;
  const Study& study_;
  const Drawing& drawing_;
  Reasons reasons_;
  NeighbourFigures figures_;
  std::vector<std::size_t> moving_;
  std::map<std::pair<std::string, std::string>, int> known_;
  ReportNeighbours result_;
};

}  // namespace

void fill_neighbours(Report& report, const Study& study, const Drawing& drawing,
                     const std::vector<std::pair<int, std::vector<double>>>& poses, int threads,
                     const Monitor& monitor) {
  Neighbourhood neighbourhood(report, study, drawing);
  report.why_no_neighbours = neighbourhood.refusal(poses.size());
  if (!report.why_no_neighbours.empty()) return;
  report.neighbours = neighbourhood.make(poses, threads, monitor);
  if (!report.neighbours) report.why_no_neighbours = "the report was stopped before";
}

}  // namespace posewright
