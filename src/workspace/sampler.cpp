#include "sampler.hpp"

#include <algorithm>
#include <atomic>
#include <boost/random/sobol.hpp>
#include <chrono>
#include <cstdint>
#include <span>

#include "closure.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"
#include "view_sampler.hpp"

namespace posewright {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
  x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
  x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
  return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
}

/// Nested uniform scramble: each bit is flipped by a hash of the bits above it. Burley (2020), listing 3.
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return reverse_bits(x);
}

/// Sobol points in [0, 1)^d, Owen-scrambled by a hash of the seed (Laine & Karras 2011; Burley 2020, JCGT 9(4)).
class LowDiscrepancy {
 public:
  /// 1 ≤ dimension ≤ 3667.
  LowDiscrepancy(int dimension, std::uint64_t seed) : sobol_(std::size_t(dimension)), seed_(seed) {}
  /// The next point; size of `point` = dimension.
  void next(std::span<double> point) {
    for (std::size_t i = 0; i < point.size(); ++i) {
      const auto high = static_cast<std::uint32_t>(sobol_() >> 32);
      const auto scramble = static_cast<std::uint32_t>(mix_bits(seed_ + 0x9e37U * (i + 1)) >> 32);
      point[i] = owen_scramble(high, scramble) * 0x1.0p-32;
    }
  }

 private:
  boost::random::sobol sobol_;
  std::uint64_t seed_;
};

constexpr std::size_t batch = 2048;
// Of a batch so many are judged at once, and none of the rest when there are enough.
constexpr std::size_t judged_at_once = 256;
// Halvings of the way from a feasible point to an infeasible one: 2⁻³⁰ of the way is finer than any controller's step.
constexpr int bisections = 30;
// Where each step asks for collisions: 2⁻¹³ of the way.
constexpr int bisections_in_cell = 13;
// Corners of a box of more dimensions are drawn, not enumerated.
constexpr std::size_t max_enumerated = 10;
constexpr std::uint64_t interior_stream = 1, boundary_stream = 2, view_stream = 4;
// Even draws that tell how much is feasible.
constexpr std::size_t pilot_draws = 1024;
// Views that nothing reaches are not tried as often as plain draws, which take a thousandth of their time.
constexpr std::size_t views_per_candidate = 40;
// A batch that is begun is finished, unless it takes longer than who stops it would wait.
constexpr std::chrono::milliseconds patience{400};

}  // namespace

void Sampler::interior(std::size_t wanted, const Monitor& monitor) {
  // A second go must not draw the same again.
  LowDiscrepancy points(result_.dimension, result_.count() == 0 ? options_.seed : mix_bits(options_.seed + 3));
  draw(
      wanted, monitor, options_.draws_per_candidate, [&](std::size_t, std::span<double> q) { points.next(q); },
      [&](std::size_t, std::span<double> q) {
        scale(q);
        return closed_violation(q);
      });
}

int Sampler::closed_violation(std::span<double> q) const {
  if (workspace_.closure() != nullptr && !workspace_.closure()->close(q)) return open_loop();
  return workspace_.violation(q);
}

double Sampler::feasible_share() const {
  LowDiscrepancy points(result_.dimension, mix_bits(options_.seed + view_stream));
  const auto d = std::size_t(result_.dimension);
  std::vector<double> drawn(pilot_draws * d);
  for (std::size_t i = 0; i < pilot_draws; ++i) points.next(std::span(drawn).subspan(i * d, d));
  std::vector<char> good(pilot_draws, 0);
  parallel_for(pilot_draws / 64, thread_count(options_.threads), [&](std::size_t chunk, int) {
    for (std::size_t i = 64 * chunk; i < 64 * (chunk + 1); ++i) {
      const std::span<double> q = std::span(drawn).subspan(i * d, d);
      scale(q);
      good[i] = char(closed_violation(q) < 0);
    }
  });
  return double(std::count(good.begin(), good.end(), char(1))) / double(pilot_draws);
}

void Sampler::views(std::size_t wanted, const Monitor& monitor) {
  has_views_ = true;
  const std::uint64_t seed = mix_bits(options_.seed + view_stream + result_.count());
  LowDiscrepancy points(result_.dimension, seed);
  draw(
      wanted, monitor, std::min(options_.draws_per_candidate, views_per_candidate),
      [&](std::size_t, std::span<double> q) { points.next(q); },
      [&](std::size_t i, std::span<double> q) {
        scale(q);
        Random random(seed, mix_bits(i));
        const bool there = workspace_.views()->move_to_view(q, random);
        const int verdict = closed_violation(q);
        return verdict >= 0 && !there ? out_of_reach() : verdict;
      });
}

void Sampler::boundary(std::size_t wanted, const Monitor& monitor) {
  LowDiscrepancy points(result_.dimension, mix_bits(options_.seed + boundary_stream));
  anchors_ = result_.count();
  draw(
      wanted, monitor, options_.draws_per_candidate,
      [&](std::size_t i, std::span<double> q) {
        points.next(q);
        pin(i, q);
      },
      [&](std::size_t i, std::span<double> q) {
        scale(q);
        const int verdict = closed_violation(q);
        return verdict < 0 || anchors_ == 0 ? verdict : draw_back(i, q);
      });
}

void Sampler::fill_up(std::size_t count, const Monitor& monitor) {
  if (result_.count() == 0 || result_.count() >= count) return;
  filling_up_ = true;
  if (has_views_) views(count - result_.count(), monitor);
  else if (has_ompl_ || instrument_) interior(count - result_.count(), monitor);
}

void Sampler::pin(std::size_t i, std::span<double> q) const {
  const std::size_t ends = bounded_.size();
  const bool all_corners = ends <= max_enumerated;
  if (all_corners && i < (std::size_t(1) << ends)) {
    for (std::size_t k = 0; k < ends; ++k) q[bounded_[k]] = double((i >> k) & 1U);
    return;
  }
  Random random(options_.seed, mix_bits(i + interior_stream));
  const std::size_t most = all_corners && ends > 1 ? ends - 1 : ends;
  std::size_t pinned = most == 0 ? 0 : 1 + i % most;
  for (std::size_t k = 0; k < ends; ++k) {
    // Selection sampling: coordinate k is among those still to be pinned with the right probability.
    if (random.uniform() * double(ends - k) >= double(pinned)) continue;
    q[bounded_[k]] = random.bits() >> 63 ? 1.0 : 0.0;
    --pinned;
  }
}

void Sampler::draw(std::size_t wanted, const Monitor& monitor, std::size_t draws_per_candidate,
                   const Generate& generate, const Judge& judge) {
  const auto d = std::size_t(result_.dimension);
  const std::size_t target = result_.count() + wanted;
  const std::size_t limit = wanted * draws_per_candidate;
  std::vector<double> points(batch * d);
  std::vector<int> verdict(batch);
  share_among_instruments(wanted);
  for (std::size_t first = 0;
       result_.count() < target && first < limit && (result_.drawn == 0 || !monitor.should_stop()); first += batch) {
    for (std::size_t i = 0; i < batch; ++i) generate(first + i, std::span(points).subspan(i * d, d));
    std::atomic<bool> cut = false;
    const auto begin = Monitor::Clock::now();
    const auto judge_from = [&](std::size_t part) {
      constexpr std::size_t chunk = 4;
      parallel_for(judged_at_once / chunk, thread_count(options_.threads), [&](std::size_t c, int) {
        if (monitor.should_stop() && Monitor::Clock::now() - begin > patience) cut = true;
        for (std::size_t i = part + chunk * c; i < part + chunk * (c + 1) && !cut; ++i)
          verdict[i] = judge(first + i, std::span(points).subspan(i * d, d));
      });
      return !cut;
    };
    for (std::size_t i = 0; i < batch && result_.count() < target; ++i) {
      // A part that was not finished would depend on the number of threads.
      if (i % judged_at_once == 0 && !judge_from(i)) return;
      ++result_.drawn;
      const std::span<const double> q = std::span(points).subspan(i * d, d);
      if (verdict[i] >= 0) ++rejected_[std::size_t(verdict[i])];
      else if (!is_new(q)) ++rejected_[drawn_before()];
      else if (!counts(q)) ++rejected_.back();
      else
        result_.values.insert(result_.values.end(), points.begin() + std::ptrdiff_t(i * d),
                              points.begin() + std::ptrdiff_t((i + 1) * d));
    }
    monitor.report({"candidates", double(result_.count()), double(options_.count), {}, {}, {}});
    std::erase_if(open_, [&](double k) { return still_wanted_[std::size_t(k)] == 0; });
  }
}

void Sampler::share_among_instruments(std::size_t wanted) {
  if (!instrument_) return;
  open_ = workspace_.proposed()[*instrument_].values;
  const std::size_t each = filling_up_ ? wanted : (wanted + open_.size() - 1) / open_.size();
  still_wanted_.assign(open_.size(), each);
}

bool Sampler::counts(std::span<const double> q) {
  if (!instrument_) return true;
  std::size_t& wanted = still_wanted_[std::size_t(q[*instrument_])];
  if (wanted == 0) return false;
  --wanted;
  return true;
}

void Sampler::scale(std::span<double> q) const {
  for (std::size_t k = 0; k < q.size(); ++k) {
    const Coordinate& c = workspace_.proposed()[k];
    const std::vector<double>& values = k == instrument_ && !open_.empty() ? open_ : c.values;
    if (c.discrete()) q[k] = values[std::min(std::size_t(q[k] * double(values.size())), values.size() - 1)];
    else q[k] = q[k] >= 1.0 ? c.upper : c.lower + q[k] * (c.upper - c.lower);
  }
}

int Sampler::draw_back(std::size_t index, std::span<double> q) const {
  Random random(options_.seed, mix_bits(index) + boundary_stream);
  const std::span<const double> inside = result_[std::size_t(random.index(int(anchors_)))];
  std::vector<double> trial(q.size());
  const auto along = [&](double t) {
    for (std::size_t k = 0; k < q.size(); ++k)
      trial[k] = workspace_.proposed()[k].discrete() ? inside[k] : inside[k] + t * (q[k] - inside[k]);
  };
  const Closure* closure = workspace_.closure();
  const int steps = workspace_.cut_by_cell() ? bisections_in_cell : bisections;
  double feasible = 0.0, infeasible = 1.0;
  for (int i = 0; i < steps; ++i) {
    const double middle = 0.5 * (feasible + infeasible);
    along(middle);
    const bool meets = closure == nullptr || closure->close(trial);
    (meets && workspace_.is_free_at(trial) ? feasible : infeasible) = middle;
  }
  along(feasible);
  std::copy(trial.begin(), trial.end(), q.begin());
  return closed_violation(q);
}

}  // namespace posewright
