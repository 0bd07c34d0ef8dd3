#include "listed_candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "posewright/lists/read_poses.hpp"
#include "posewright/model/instrument_view.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// So many rows are named; the table counts them all.
constexpr int most_named = 5;

/// Names of columns that hold what an instrument read.
std::vector<std::string> names_of_readings(const Variant& variant) {
  std::vector<std::string> names;
  for (const Reading& reading : variant.model->readings()) names.push_back(reading.name);
  if (const InstrumentView view = view_of(variant.problem->measurement); view.fits_pose)
    for (const TargetSpec& marker : view.targets) names.push_back(marker.name + ".x");
  return names;
}

class ListedPoses {
 public:
  explicit ListedPoses(Study& study)
      : study_(study),
        list_(*study.candidates_from),
        coordinates_(study.first().workspace->coordinates()),
        out_(study.configurations) {
    const std::vector<std::string> readings = names_of_readings(study.first());
    measured_ = std::any_of(list_.columns.begin(), list_.columns.end(), [&](const std::string& column) {
      return std::find(readings.begin(), readings.end(), column) != readings.end();
    });
    out_ = {};
    out_.dimension = int(coordinates_.size());
    study.list = list_.name;
    study.notes = list_.notes;
  }

  void take() {
    std::map<std::vector<double>, int> seen;
    for (std::size_t i = 0; i < list_.configurations.size(); ++i)
      if (const int index = int(seen.size()); seen.emplace(list_.configurations[i], index).second) take(i, index);
    out_.drawn = long(seen.size());
    if (!near_.empty()) study_.notes.push_back(margin_note(list_.name, near_));
    if (count_ > most_named) study_.notes.push_back(fmt::format("… and {} more", count_ - most_named));
    if (out_.count() > 0) return;
    std::string reasons;
    for (const auto& [reason, count] : out_.rejected)
      reasons += fmt::format("{}'{}' rejects {}", reasons.empty() ? "" : ", ", reason, count);
    throw CannotDo(list_.name + " has no feasible configuration: " + reasons);
  }

 private:
  void take(std::size_t i, int index) {
    std::vector<double> q = list_.configurations[i];
    const ListedRow row{index, own_id(i, index), i < list_.lines.size() ? list_.lines[i] : 0};
    if (!measured_) settle_on_limits(q);
    const std::string reason = violation(q);
    const bool kept = reason.empty() || (measured_ && can_be_told(q));
    if (!reason.empty()) tell(q, row, reason, kept);
    if (!kept) {
      count_reason(reason);
      return;
    }
    if (reason.empty()) note_margin(q, row);
    append(out_, q);
    out_.rows.push_back(row);
  }

  int own_id(std::size_t i, int index) const {
    return i < list_.own_ids.size() && list_.own_ids[i] > 0 ? list_.own_ids[i] : index + 1;
  }

  void settle_on_limits(std::vector<double>& q) const {
    for (std::size_t k = 0; k < q.size(); ++k) {
      const Coordinate& c = coordinates_[k];
      if (inside(q[k], c)) q[k] = as_allowed(q[k], c);
    }
  }

  /// Why a variant's workspace forbids q; empty: none does.
  std::string violation(const std::vector<double>& q) const {
    for (const Variant& v : study_.variants)
      if (const int reason = v.workspace->violation(q); reason >= 0) return v.workspace->reasons()[std::size_t(reason)];
    return {};
  }

  /// True if every variant's model has a block there, limits or not.
  bool can_be_told(const std::vector<double>& q) const {
    Linearisation out;
    const std::vector<int> first{0};
    return std::all_of(study_.variants.begin(), study_.variants.end(), [&](const Variant& v) {
      return v.model->measurable(q) && v.model->linearise(q, {}, first, out);
    });
  }

  /// One line about a configuration that the workspace forbids.
  void tell(const std::vector<double>& q, const ListedRow& row, const std::string& reason, bool kept) {
    if (++count_ > most_named) return;
    std::string where;
    for (std::size_t k = 0; k < q.size() && where.empty(); ++k)
      if (const Coordinate& c = coordinates_[k]; !inside(q[k], c))
        where = fmt::format(" ('{}' is {:.6g} {}; {:.6g} to {:.6g})", c.name, q[k], c.unit, c.lower, c.upper);
    const std::string place = row.line > 0 ? fmt::format("{}:{}", list_.name, row.line) : list_.name;
    study_.notes.push_back(fmt::format("{}: pose {} {}: {}{}", place, row.id,
                                       kept ? "was measured, though the problem forbids it" : "is rejected", reason,
                                       where));
  }

  void note_margin(const std::vector<double>& q, const ListedRow& row) {
    if (!study_.first().workspace->within_margin(q).empty()) near_.push_back(row.id);
  }

  void count_reason(const std::string& reason) {
    const auto at = std::find_if(out_.rejected.begin(), out_.rejected.end(),
                                 [&](const auto& entry) { return entry.first == reason; });
    if (at == out_.rejected.end()) out_.rejected.emplace_back(reason, 1);
    else ++at->second;
  }

  Study& study_;
  const PoseList& list_;
  const std::vector<Coordinate>& coordinates_;
  Configurations& out_;
  bool measured_ = false;
  int count_ = 0;
  std::vector<int> near_;  // ids of poses nearer to a limit than the margin
};

}  // namespace

void take_listed_candidates(Study& study) { ListedPoses(study).take(); }

}  // namespace posewright
