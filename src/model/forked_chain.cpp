#include "posewright/model/forked_chain.hpp"

#include <algorithm>
#include <map>

namespace posewright {

std::string base_name(const WaySpec& way) { return way.in ? "base@" + way.in->name : "base"; }
std::string tool_name(const WaySpec& way) { return "tool@" + way.of.name; }

ForkedChain::ForkedChain(const WayChains& all, std::size_t own, const std::vector<char>& tools, bool tool)
    : chain_(all.ways[own].chain), coordinates_at_(all.ways[own].coordinates) {
  coordinates_ = all.coordinates;
  moving_.assign(coordinates_.size(), 0);
  for (const std::size_t at : coordinates_at_) moving_[at] = 1;
  offsets_.assign(coordinates_.size(), -1);
  reading_noise_.assign(coordinates_.size(), 0.0);
  std::map<std::string, int> known;
  const auto add = [&](std::size_t way, const SerialChain& chain, int index, const std::string& name) {
    const auto [at, added] = known.emplace(name, int(parameters_.size()));
    if (added) {
      parameters_.push_back(chain.parameters()[std::size_t(index)]);
      parameters_.back().name = name;
      own_.push_back(chain_.layout().count);
      for (const auto& preference : chain.geometric_parameters())
        if (preference.parameter == index) geometric_.push_back({at->second, preference.tier});
    }
    if (way == own) own_[std::size_t(at->second)] = index;
    return at->second;
  };
  std::vector<SerialChain> chains;
  for (const WayChain& way : all.ways) chains.emplace_back(way.chain);
  for (std::size_t w = 0; w < chains.size(); ++w) {
    const SerialChain& chain = chains[w];
    const std::vector<std::size_t>& at = all.ways[w].coordinates;
    for (int i = 0; i < chain.layout().tool; ++i) {
      const std::string& name = chain.parameters()[std::size_t(i)].name;
      add(w, chain, i, i < 6 ? base_name(all.ways[w].way) + name.substr(name.rfind('.')) : name);
    }
    for (std::size_t c = 0; c < at.size(); ++c) {
      const std::string& offset = chain.parameters()[std::size_t(chain.layout().offset[c])].name;
      offsets_[at[c]] = known.at(offset);
      reading_noise_[at[c]] = chain.reading_noise()[c];
    }
  }
  for (std::size_t w = 0; w < chains.size(); ++w)
    for (int i = chains[w].layout().tool; tools[w] != 0 && i < chains[w].layout().count; ++i) {
      const std::string& name = chains[w].parameters()[std::size_t(i)].name;
      const int at = add(w, chains[w], i, tool_name(all.ways[w].way) + name.substr(name.rfind('.')));
      if (w == own && !tool) own_[std::size_t(at)] = chain_.layout().count;
    }
}

std::vector<double> ForkedChain::configuration(std::span<const double> q) const {
  std::vector<double> own;
  own.reserve(coordinates_at_.size());
  for (const std::size_t at : coordinates_at_) own.push_back(q[at]);
  return own;
}

std::vector<double> ForkedChain::corrections(std::span<const double> correction) const {
  std::vector<double> own;
  if (correction.empty()) return own;
  own.assign(std::size_t(chain_.layout().count) + 1, 0.0);
  for (std::size_t i = 0; i < own_.size(); ++i) own[std::size_t(own_[i])] = correction[i];
  own.pop_back();
  return own;
}

/// Columns that are none of the chain's have an index beyond its own, and are zero.
std::vector<int> ForkedChain::own_columns(std::span<const int> selected) const {
  std::vector<int> own;
  own.reserve(selected.size());
  for (const int i : selected) own.push_back(i < int(own_.size()) ? own_[std::size_t(i)] : chain_.layout().count);
  return own;
}

bool ForkedChain::linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X, Twists& twists,
                            Twists* reading_twists) const {
  const std::vector<double> q = configuration(at.q), correction = corrections(at.correction);
  static thread_local Twists own;
  if (!chain_.linearise({q, correction}, own_columns(selected), X, twists, reading_twists == nullptr ? nullptr : &own))
    return false;
  if (reading_twists == nullptr) return true;
  reading_twists->setZero(6, Eigen::Index(coordinates_.size()));
  for (std::size_t c = 0; c < coordinates_at_.size(); ++c)
    reading_twists->col(Eigen::Index(coordinates_at_[c])) = own.col(Eigen::Index(c));
  return true;
}

bool ForkedChain::pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                            std::span<double> gradient) const {
  const std::vector<double> q = configuration(at.q), correction = corrections(at.correction);
  TipAdjoint own{f.twists, {}, f.tip};
  if (f.reading_twists.cols() > 0) {
    own.reading_twists.resize(6, Eigen::Index(coordinates_at_.size()));
    for (std::size_t c = 0; c < coordinates_at_.size(); ++c)
      own.reading_twists.col(Eigen::Index(c)) = f.reading_twists.col(Eigen::Index(coordinates_at_[c]));
  }
  std::vector<double> own_gradient(q.size(), 0.0);
  if (!chain_.pull_back({q, correction}, own_columns(selected), own, own_gradient)) return false;
  for (std::size_t c = 0; c < coordinates_at_.size(); ++c) gradient[coordinates_at_[c]] += own_gradient[c];
  return true;
}

}  // namespace posewright
