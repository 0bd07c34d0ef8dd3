#include "suspicious_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace posewright {
namespace {

constexpr std::size_t most_lines = 5;
// rad and m: rows of one id may differ by so much, as encoders jitter.
constexpr double jitter = 1e-3;

/// Values that instruments write for no reading, in m and in mm.
bool is_code(double value) {
  for (const double code : {9999.0, 99999.0})
    for (const double unit : {1.0, 1e-3})
      if (std::abs(std::abs(value) - code * unit) < 1e-12 * code) return true;
  return false;
}

bool same_numbers(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size() || !a.array().isFinite().any()) return false;
  for (Eigen::Index i = 0; i < a.size(); ++i)
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
  return true;
}

}  // namespace

bool SuspiciousRows::moved(const std::vector<double>& from, const std::vector<double>& to) const {
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!model_.coordinates()[i].discrete() && std::abs(from[i] - to[i]) > jitter) return true;
  return false;
}

void SuspiciousRows::look_for_codes(int line, const Eigen::VectorXd& y) {
  if (std::any_of(y.begin(), y.end(), is_code))
    lines_["9999 stands for no reading? Leave its cell empty"].push_back(line);
  const Eigen::Index size =
      model_.rows_per_target() > 0 ? model_.rows_per_target() : std::min<Eigen::Index>(3, y.size());
  for (Eigen::Index first = 0; first + size <= y.size(); first += size) {
    if (size > 1 && (y.segment(first, size).array() == 0.0).all()) {
      lines_["a target is read as 0: was it lost? Leave its cells empty"].push_back(line);
      return;
    }
    if (model_.rows_per_target() == 0) return;
  }
}

void SuspiciousRows::add(int id, int line, const std::vector<double>& q, const Eigen::VectorXd& y) {
  look_for_codes(line, y);
  if (!last_q_.empty() && same_numbers(last_y_, y) && moved(last_q_, q))
    lines_["the readings of the row before, at other joints: was the instrument read again?"].push_back(line);
  if (id > 0) {
    const auto [known, added] = configurations_.emplace(id, q);
    if (!added && moved(known->second, q)) lines_["an id that another configuration has"].push_back(line);
  }
  last_q_ = q;
  last_y_ = y;
}

std::vector<std::string> SuspiciousRows::notes(const std::string& file) const {
  std::vector<std::string> notes;
  for (const auto& [kind, lines] : lines_) {
    std::string note = file;
    for (std::size_t k = 0; k < std::min(most_lines, lines.size()); ++k)
      note += fmt::format("{}{}", k == 0 ? ":" : ", ", lines[k]);
    if (lines.size() > most_lines) note += fmt::format(" and {} more rows", lines.size() - most_lines);
    notes.push_back(note + ": " + kind);
  }
  return notes;
}

}  // namespace posewright
