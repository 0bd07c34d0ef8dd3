#include "posewright/search/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "joined.hpp"
#include "planners/planner_registry.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/criterion/reserve.hpp"
#include "posewright/planning/extended_bound.hpp"
#include "posewright/planning/limited_bound.hpp"
#include "posewright/planning/spectral_bound.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/proof/taylor_bound.hpp"
#include "posewright/proof/workspace_proof.hpp"
#include "posewright/search/design_measure.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/repeats.hpp"

namespace posewright {
namespace {

// Efficiencies of o2 and o4 are ratios of squares, as those of o3 and o5 are.
constexpr double spectral_degree = 0.5;
// So few poses are as good from rough weights over the workspace as from settled ones; three are 0.01 worse in log det.
// Only where local searches have no gradients, so that settling takes long.
constexpr int few_poses = 2;

void require_choice(const SearchRequest& request, std::size_t candidates) {
  if (double(request.poses) <= double(candidates) * request.repeats.most) return;
  throw CannotDo(fmt::format(
      "{} poses cannot be chosen from {} candidates{}", request.poses, candidates,
      request.repeats.most == 1 ? " without repeats" : fmt::format(", each at most {} times", request.repeats.most)));
}

/// Whitened blocks of configurations that are no candidates.
BlockArray blocks_at(const std::vector<std::vector<double>>& configurations, const ConfigurationSpace& space,
                     const Joined& joined) {
  BlockArray blocks(configurations.size(), joined.blocks.rows(), joined.blocks.columns());
  const auto probe = space.probe();
  for (std::size_t i = 0; i < blocks.count(); ++i) probe->block(configurations[i], blocks.row(i, 0), blocks.stride());
  return blocks;
}

std::vector<double> without_each(const Joined& joined, const Design& design, const BlockArray& added,
                                 const InformationFunction& function, double degree, int threads) {
  const auto n = joined.blocks.count();
  BlockArray chosen(design.members.size(), joined.blocks.rows(), joined.blocks.columns());
  for (std::size_t i = 0; i < chosen.count(); ++i) {
    const auto member = std::size_t(design.members[i]);
    chosen.block(i) = member < n ? joined.blocks.block(member) : added.block(member - n);
  }
  Eigen::MatrixXd M = chosen.all().transpose() * chosen.all();
  if (joined.prior.size() > 0) M += joined.prior;
  const double whole = function.value(M), share = degree > 0 ? degree : 1.0;
  std::vector<double> result(chosen.count());
  parallel_for(chosen.count(), thread_count(threads), [&](std::size_t i, int) {
    const auto block = chosen.block(i);
    result[i] = std::min(1.0, std::exp((function.value(M - block.transpose() * block) - whole) / share));
  });
  return result;
}

/// Raw blocks of the chosen candidates, each part's own.
std::vector<BlockArray> raw_blocks(const Joined& joined, const std::vector<std::pair<int, int>>& shapes,
                                   const Design& design) {
  std::vector<int> members;
  for (const int i : design.members)
    if (std::size_t(i) < joined.blocks.count()) members.push_back(i);
  const BlockArray white = joined.blocks.subset(members);
  std::vector<BlockArray> result;
  Eigen::Index row = 0, column = 0;
  for (const auto& [r, m] : shapes) {
    BlockArray raw(members.size(), r, m);
    for (std::size_t i = 0; i < raw.count(); ++i)
      raw.block(i) = white.block(i).block(row, column, r, m) * joined.R.block(column, column, m, m);
    row += r;
    column += m;
    result.push_back(std::move(raw));
  }
  return result;
}

void fill(Certificate& certificate, const ApproximateDesign& approximate, const Joined& joined,
          const SearchRequest& request, double offset) {
  certificate.bound = approximate.bound_for(request.poses) + offset;
  certificate.max_sensitivity_ratio = approximate.max_sensitivity_ratio;
  certificate.count = joined.blocks.count();
  certificate.repeats = repeats_text(request.repeats);
}

/// o2 and o4 have a bound of their own; that of o3 is tighter than what its weights alone say.
std::optional<SpectralBound> spectral_bound_of(const BlockArray& blocks, const Joined& joined,
                                               const InformationFunction& function, const SearchRequest& request,
                                               const Monitor& monitor, EigenvalueBounds* known = nullptr) {
  SpectralBoundOptions options;
  options.poses = request.poses;
  options.repeats = std::min(request.repeats.most, request.poses);
  options.prior = joined.prior;
  options.threads = request.planner.threads;
  return spectral_bound(blocks, function, options, monitor, known);
}

/// Takes the bound where it is the lower one, or the only one.
void tighten(Certificate& certificate, const std::optional<SpectralBound>& spectral, bool only) {
  if (!spectral || (!only && certificate.bound <= spectral->bound)) return;
  certificate.bound = spectral->bound;
  certificate.max_sensitivity_ratio = std::exp(2 * spectral->gap);
}

bool has_limits(const SearchRequest& request) { return request.spacing != nullptr && !request.spacing->most.empty(); }

/// Counts the limits of the request's spacing, too.
/// @param spacing  with the points of the blocks
void limit(Certificate& certificate, const BlockArray& blocks, const Spacing& spacing, const Joined& joined,
           const InformationFunction& function, const ApproximateDesign& approximate, const SearchRequest& request,
           double offset, const Monitor& monitor) {
  const LimitedChoice choice{blocks, spacing, request.poses, std::min(request.repeats.most, request.poses),
                             bound_options(request, joined.prior).prior};
  const double bound = limited_bound(choice, function, approximate, request.planner.threads, monitor);
  if (!(bound + offset < certificate.bound)) return;
  certificate.bound = bound + offset;
  certificate.limited = true;
}

/// All blocks of both.
BlockArray joined_blocks(const BlockArray& first, const BlockArray& second) {
  BlockArray both(first.count() + second.count(), first.rows(), first.columns());
  for (std::size_t i = 0; i < both.count(); ++i)
    both.block(i) = i < first.count() ? first.block(i) : second.block(i - first.count());
  return both;
}

/// Φ of determinant criteria is that of raw coordinates, as people know it.
double offset_of(const Joined& joined, const CriterionEntry& entry) {
  return entry.determinant ? joined.offsets.front() : 0.0;
}

std::shared_ptr<const DesignMeasure> measure(const Joined& joined, const CriterionEntry& entry,
                                             std::shared_ptr<const Criterion> criterion) {
  return std::make_shared<DesignMeasure>(std::move(criterion), joined.R, joined.prior, offset_of(joined, entry));
}

/// What solutions of bounds leave for further ones of the same candidates.
struct SolvedBounds {
  std::vector<int> support{};  // of the weights, ascending; empty: none yet
  EigenvalueBounds eigenvalues{};
};

template <class Registry>
std::vector<std::string> names_in(const Registry& registry) {
  std::vector<std::string> names;
  names.reserve(std::size(registry));
  for (const auto& entry : registry) names.push_back(entry.name);
  return names;
}

}  // namespace

void require_known(const std::string& criterion, const std::string& method, const SourcePlace& criterion_place,
                   const SourcePlace& method_place, std::string_view other) {
  if (find_criterion(criterion) == nullptr)
    throw InputError(criterion_place,
                     "unknown criterion '" + criterion + "'" + meant_instead(criterion, names_in(criterion_registry())),
                     fmt::format("available: {}{}{}", criterion_names(), other.empty() ? "" : ", ", other));
  if (find_planner(method) == nullptr)
    throw InputError(method_place,
                     "unknown method '" + method + "'" + meant_instead(method, names_in(planner_registry())),
                     "available: " + planner_names());
}

std::shared_ptr<const DesignMeasure> measure_of(std::vector<SearchPart> parts, const SearchRequest& request,
                                                const Monitor& monitor) {
  const CriterionEntry& entry = *find_criterion(request.criterion);
  const Joined joined = join(std::move(parts), request, entry.several_variants, monitor);
  return measure(joined, entry, entry.make(joined.data));
}

namespace {

/// @param solved  what solutions before have found of the same candidates
Bound bound_of(const Joined& joined, const CriterionEntry& entry, const SearchRequest& request, const Monitor& monitor,
               SolvedBounds& solved) {
  const std::shared_ptr<const Criterion> criterion = entry.make(joined.data);
  Bound result;
  result.measure = measure(joined, entry, criterion);
  result.degree = criterion->function().degree();
  result.references = joined.references;
  const auto spectral =
      spectral_bound_of(joined.blocks, joined, criterion->function(), request, monitor, &solved.eigenvalues);
  result.certificate.proved = result.degree > 0 || spectral;
  if (!result.certificate.proved) return result;
  if (result.degree == 0) {
    result.degree = spectral_degree;
    fill(result.certificate, {}, joined, request, 0.0);
    tighten(result.certificate, spectral, true);
    return result;
  }
  ApproximateDesignOptions options = bound_options(request, joined.prior);
  // The smallest eigenvalue has kinks: weights of another criterion may leave its solution at a looser bound.
  if (!spectral) options.start = solved.support;
  const ApproximateDesign approximate =
      solve_approximate_design(joined.blocks, criterion->function(), options, monitor);
  solved.support = approximate.support;
  fill(result.certificate, approximate, joined, request, offset_of(joined, entry));
  if (has_limits(request))
    limit(result.certificate, joined.blocks, *request.spacing, joined, criterion->function(), approximate, request,
          offset_of(joined, entry), monitor);
  tighten(result.certificate, spectral, false);
  result.sensitivity = approximate.sensitivity;
  result.price = approximate.price;
  return result;
}

}  // namespace

Bound bound_only(std::vector<SearchPart> parts, const SearchRequest& request, const Monitor& monitor) {
  return CandidateBounds(std::move(parts), request).of(request.criterion, monitor);
}

struct CandidateBounds::State {
  std::vector<SearchPart> parts;  // until they are joined
  SearchRequest request;
  std::optional<Joined> joined;
  bool several = false;
  SolvedBounds solved;
};

CandidateBounds::CandidateBounds(std::vector<SearchPart> parts, const SearchRequest& request)
    : state_(new State{std::move(parts), request, {}, false, {}}) {
  require_choice(request, state_->parts.front().blocks.count());
}

CandidateBounds::~CandidateBounds() = default;
CandidateBounds::CandidateBounds(CandidateBounds&&) noexcept = default;

Bound CandidateBounds::of(const std::string& criterion, const Monitor& monitor) {
  State& state = *state_;
  const CriterionEntry& entry = *find_criterion(criterion);
  if (!state.joined) {
    state.several = entry.several_variants;
    state.joined = join(std::move(state.parts), state.request, state.several, monitor);
  }
  if (entry.several_variants != state.several)
    throw std::invalid_argument("bounds of one variant and of several have different coordinates");
  return bound_of(*state.joined, entry, state.request, monitor, state.solved);
}

namespace {

// A proof that allows plans better by more than this share counts as a search with a loose proof beside it.
constexpr double loose_proof = 0.05;

/// Over the whole workspace: proved where the largest d is, else as far as searches tell.
Certificate::Workspace certificate_of(const WorkspaceBound& found, int poses, double offset, bool smooth) {
  const WorkspaceProof& proof = found.proof;
  const double proved = proof.bound + found.degree * std::log(double(poses)) + offset;
  const bool loose = proof.why_not.empty() && proof.bound - found.bound > loose_proof * found.degree;
  if (proof.why_not.empty() && !loose)
    return {0.0,
            proved,
            proof.max_ratio,
            fmt::format("largest d(q) over the limits by Bernstein coefficients of {} boxes{}{}", proof.boxes,
                        proof.ended.empty() ? "" : ", ", proof.ended),
            true,
            "",
            proof.boxes,
            proof.limits};
  const std::string confirmed =
      found.confirmed == 0 ? "not settled"
                           : fmt::format("{} more from drawn candidates found nothing better", found.confirmed);
  Certificate::Workspace searched{0.0,
                                  found.bound_for(poses) + offset,
                                  found.max_ratio,
                                  fmt::format("largest d(q) of {} local searches ({}), {}; not a proof",
                                              found.searches - found.confirmed, smooth ? "SLSQP" : "SBPLX", confirmed),
                                  false,
                                  proof.why_not};
  searched.settled = found.confirmed > 0;
  if (loose) {
    searched.why_not =
        !proof.ended.empty() ? "the proof was " + proof.ended
        : !proof.largest_forbidden_by.empty()
            ? "the proof includes poses that are forbidden by conditions outside it: " + proof.largest_forbidden_by
            : "the bound of the noise is loose";
    searched.boxes = proof.boxes;
    searched.limits = proof.limits;
    searched.loose_bound = proved;
  }
  return searched;
}

/// One search: bounds that serve it, the design, the certificate.
class DesignSearch {
 public:
  DesignSearch(std::vector<SearchPart> parts, const SearchRequest& request, const Monitor& monitor)
      : request_(request),
        monitor_(monitor),
        entry_(*find_criterion(request.criterion)),
        shapes_(shapes_of(parts)),
        joined_(join(std::move(parts), request, entry_.several_variants, monitor)),
        criterion_(entry_.make(joined_.data)),
        function_(criterion_->function()),
        degree_(function_.degree()),
        offset_(offset_of(joined_, entry_)),
        space_(request.make_space ? request.make_space(joined_.R) : nullptr) {}

  SearchResult run() {
    bound_candidates();
    bound_workspace();
    choose();
    if (!request_.certificate) {
      result_.certificate.proved = false;
      return std::move(result_);
    }
    // Last, so that whoever stops it has his plan.
    if (workspace_ && request_.prove)
      settle_workspace(*workspace_, joined_.blocks, approximate_, function_, *space_, workspace_options_, monitor_);
    certify_among_candidates();
    certify_over_workspace();
    for (const SearchStage& stage : result_.design.stages)
      result_.stages.push_back({stage.name, stage.value + offset_, efficiency_of(stage), stage.seconds});
    BlockArray added;
    if (goes_between()) added = blocks_at(result_.design.added, *space_, joined_);
    result_.without = without_each(joined_, result_.design, added, function_, share_, request_.planner.threads);
    result_.chosen = raw_blocks(joined_, shapes_, result_.design);
    return std::move(result_);
  }

 private:
  static std::vector<std::pair<int, int>> shapes_of(const std::vector<SearchPart>& parts) {
    std::vector<std::pair<int, int>> shapes;
    shapes.reserve(parts.size());
    for (const SearchPart& part : parts) shapes.emplace_back(part.blocks.rows(), part.blocks.columns());
    return shapes;
  }

  bool goes_between() const { return !result_.design.added.empty(); }

  void bound_candidates() {
    if (request_.certify) {
      // Criteria without a bound take their starts from the determinant's weights.
      const LogDetFunction log_det(joined_.nuisance, joined_.blocks.columns());
      approximate_ = solve_approximate_design(joined_.blocks, degree_ > 0 ? function_ : log_det,
                                              bound_options(request_, joined_.prior), monitor_);
      spectral_ = spectral_bound_of(joined_.blocks, joined_, function_, request_, monitor_);
      share_ = degree_ > 0 ? degree_ : spectral_ ? spectral_degree : 0.0;
    }
    if (degree_ == 0) approximate_.sensitivity.clear();
  }

  void bound_workspace() {
    if (space_ == nullptr || degree_ == 0 || !request_.certify || monitor_.should_stop()) return;
    WorkspaceBoundOptions& options = workspace_options_;
    options.starts_alone = !request_.certificate && request_.poses <= few_poses && !space_->margins();
    options.prior = bound_options(request_, joined_.prior).prior;
    options.seed = request_.planner.seed;
    options.proof = request_.proof;
    options.threads = request_.planner.threads;
    options.further_starts = middles_of_uncut_boxes(*space_, int(joined_.blocks.columns()), options);
    workspace_ = workspace_bound(joined_.blocks, approximate_, function_, *space_, options, monitor_);
  }

  void choose() {
    DesignTask task;
    task.candidates = {&joined_.blocks, joined_.nuisance, std::min(request_.repeats.most, request_.poses),
                       joined_.prior.size() > 0 ? &joined_.prior : nullptr, request_.spacing};
    const ReserveCriterion reserve(*criterion_);
    task.criterion = request_.reserve ? &reserve : criterion_.get();
    task.poses = request_.poses;
    if (request_.certify) task.approximate = &approximate_;
    if (degree_ > 0 && request_.certify) task.bound = approximate_.bound_for(request_.poses);
    if (spectral_) task.bound = std::min(spectral_->bound, task.bound.value_or(spectral_->bound));
    task.space = space_.get();
    task.workspace = workspace_ ? &*workspace_ : nullptr;
    result_.measure = measure(joined_, entry_, criterion_);
    result_.degree = share_;
    result_.references = joined_.references;
    Monitor shifted;
    shifted.follow(monitor_);
    shifted.on_progress = [this](const Progress& progress) { report_in_plan_units(progress); };
    result_.design = find_planner(request_.method)->plan(task, request_.planner, shifted);
    result_.stopped = approximate_.stopped || result_.design.stopped;
  }

  /// People see the log det that will be in the plan, not that of whitened coordinates.
  void report_in_plan_units(Progress progress) const {
    if (progress.best) *progress.best += offset_;
    if (progress.bound) *progress.bound += offset_;
    // Poses between the candidates may be better than any of those: then their bound says nothing.
    if (progress.best && progress.bound && *progress.best > *progress.bound) {
      progress.bound.reset();
      progress.efficiency.reset();
    }
    monitor_.report(progress);
  }

  void certify_among_candidates() {
    Certificate& certificate = result_.certificate;
    certificate.proved = share_ > 0;
    if (degree_ > 0 && request_.certify) fill(certificate, approximate_, joined_, request_, offset_);
    else if (spectral_) fill(certificate, {}, joined_, request_, 0.0);
    if (goes_between() && share_ > 0) count_places_between();
    else if (!goes_between() && is_limited()) limit(joined_.blocks, *request_.spacing);
    tighten(certificate, spectral_, degree_ == 0);
    // A planner that proves something knows more than the weights alone.
    if (!result_.design.bound || request_.reserve || !(*result_.design.bound + offset_ < certificate.bound)) return;
    certificate.bound = *result_.design.bound + offset_;
    certificate.apart = request_.spacing != nullptr && request_.spacing->keeps_distance();
    certificate.limited = certificate.limited || has_limits(request_);
  }

  bool is_limited() const { return degree_ > 0 && request_.certify && has_limits(request_); }
  void limit(const BlockArray& blocks, const Spacing& spacing) {
    posewright::limit(result_.certificate, blocks, spacing, joined_, function_, approximate_, request_, offset_,
                      monitor_);
  }

  /// Poses between the candidates count as candidates, so that the bound holds for the plan itself; and so do those
  /// that optimal weights over the workspace use.
  void count_places_between() {
    Certificate& certificate = result_.certificate;
    if (workspace_) result_.support = workspace_->support;
    std::vector<std::vector<double>> found = result_.design.added;
    found.insert(found.end(), result_.support.begin(), result_.support.end());
    const BlockArray more = blocks_at(found, *space_, joined_);
    if (degree_ > 0)
      fill(certificate,
           extended_bound(joined_.blocks, approximate_, more, function_, bound_options(request_, joined_.prior),
                          monitor_),
           joined_, request_, offset_);
    if (is_limited()) limit(joined_blocks(joined_.blocks, more), request_.spacing->with(found));
    if (spectral_)
      spectral_ = spectral_bound_of(joined_blocks(joined_.blocks, more), joined_, function_, request_, monitor_);
    if (degree_ == 0 && !spectral_) certificate.proved = false;
    certificate.count += more.count();
    certificate.found = more.count();
  }

  void certify_over_workspace() {
    if (!workspace_) return;
    auto& whole = result_.certificate.workspace;
    whole = certificate_of(*workspace_, request_.poses, offset_, space_->margins().has_value());
    whole->reached = workspace_->value + share_ * std::log(double(request_.poses)) + offset_;
    // Candidates are a part of the workspace: what their weights prove to be possible, a search between them must not
    // miss.
    if (!whole->proved) whole->bound = std::max(whole->bound, result_.certificate.bound);
  }

  std::optional<double> efficiency_of(const SearchStage& stage) const {
    if (!result_.certificate.proved) return std::nullopt;
    return std::exp((stage.value + offset_ - result_.certificate.bound) / share_);
  }

  const SearchRequest& request_;
  const Monitor& monitor_;
  const CriterionEntry& entry_;
  const std::vector<std::pair<int, int>> shapes_;
  const Joined joined_;
  const std::shared_ptr<const Criterion> criterion_;
  const InformationFunction& function_;
  const double degree_, offset_;
  double share_ = 0.0;  // Φ's degree, or what stands for it in the certificate; 0: there is none
  const std::unique_ptr<ConfigurationSpace> space_;
  ApproximateDesign approximate_;
  std::optional<SpectralBound> spectral_;
  std::optional<WorkspaceBound> workspace_;
  WorkspaceBoundOptions workspace_options_;
  SearchResult result_;
};

}  // namespace

SearchResult search(std::vector<SearchPart> parts, const SearchRequest& request, const Monitor& monitor) {
  require_choice(request, parts.front().blocks.count());
  return DesignSearch(std::move(parts), request, monitor).run();
}

void certify(Certificate& certificate, double phi, double degree) {
  if (!certificate.proved) return;
  // Below 1e-9 the difference is that of two ways to compute one number. A list may exceed the bound: it may repeat
  // poses, or have some nearer to the limits than any that is proposed.
  const double short_of = certificate.bound - phi;
  certificate.efficiency = std::abs(short_of) < 1e-9 ? 1.0 : std::exp(-short_of / degree);
  if (!certificate.workspace) return;
  Certificate::Workspace& whole = *certificate.workspace;
  whole.efficiency = std::exp((phi - whole.bound) / degree);
  whole.at_most = std::exp((phi - whole.reached) / degree);
  if (whole.loose_bound) whole.loose_efficiency = std::exp((phi - *whole.loose_bound) / degree);
}

}  // namespace posewright
