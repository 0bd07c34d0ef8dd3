#include "given_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/calibration/given.hpp"

namespace posewright {
namespace {

constexpr const char* unknown = "without σ and interval here and in written files";

void append(std::string& list, const std::string& name) { list += (list.empty() ? "" : ", ") + name; }

}  // namespace

void GivenParameters::take(const std::vector<Dependency>& left_out, const VariantColumns& among) {
  if (among.automatic) return;
  const std::vector<std::vector<std::string>> names = given(left_out, among.parameters);
  for (std::size_t j = 0; j < names.size(); ++j)
    if (!names[j].empty()) on_[among.parameters[j].name] = names[j];
}

std::string GivenParameters::take(const ScoreTest& effect, const std::vector<Parameter>& fitted,
                                  const Eigen::MatrixXd& covariance, double stretch) {
  std::string named;
  for (std::size_t j = 0; j < fitted.size(); ++j) {
    const auto k = Eigen::Index(j);
    if (!(std::abs(effect.moves[k]) > stretch * std::sqrt(covariance(k, k)))) continue;
    on_[fitted[j].name].push_back(effect.name);
    append(named, fitted[j].name);
  }
  if (named.empty()) return {};
  return fmt::format(
      "{}: biased beyond their intervals by the effect {}, with {:.3g} % of the squared residuals; {}: estimate the "
      "effect, too",
      named, effect.name, 100 * effect.share, unknown);
}

std::string GivenParameters::note(const std::vector<CalibratedParameter>& left_out) const {
  if (on_.empty()) return {};
  std::string named, open;
  for (const auto& [name, others] : on_) append(named, name);
  int count = 0;
  for (const CalibratedParameter& p : left_out)
    if (!counts(p.label, Prior::manufactured)) {
      append(open, p.label.name);
      ++count;
    }
  return fmt::format("{}: valid only if {} {} nominal, which these poses cannot determine; {}", named, open,
                     count > 1 ? "are" : "is", unknown);
}

bool GivenParameters::turn(const std::string& frame) const {
  return std::ranges::any_of(on_, [&](const auto& entry) { return entry.first.starts_with(frame + ".r"); });
}

void GivenParameters::mark(CalibratedParameter& p) const {
  const auto at = on_.find(p.label.name);
  if (at == on_.end()) return;
  p.given = at->second;
  p.profiled = p.weak = false;
  p.lower = -std::numeric_limits<double>::infinity();
  p.upper = std::numeric_limits<double>::infinity();
}

}  // namespace posewright
