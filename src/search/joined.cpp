#include "joined.hpp"

#include <algorithm>
#include <utility>

#include "posewright/criterion/determinant.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/search/design_measure.hpp"

namespace posewright {

ApproximateDesignOptions bound_options(const SearchRequest& request, const Eigen::MatrixXd& prior) {
  ApproximateDesignOptions options;
  options.cap = std::min(1.0, double(request.repeats.most) / request.poses);
  options.tolerance = request.bound_tolerance;
  if (prior.size() > 0) options.prior = prior / double(request.poses);
  options.threads = request.planner.threads;
  return options;
}

namespace {

/// Bound for this part alone: the reference of its efficiency.
double reference_of(const SearchPart& part, const Eigen::MatrixXd& prior, const SearchRequest& request,
                    const Monitor& monitor) {
  return solve_approximate_design(part.blocks, LogDetFunction(part.nuisance, part.blocks.columns()),
                                  bound_options(request, prior), monitor)
      .bound_for(request.poses);
}

}  // namespace

Joined join(std::vector<SearchPart> parts, const SearchRequest& request, bool several, const Monitor& monitor) {
  Joined joined;
  Eigen::Index m = 0;
  for (const SearchPart& part : parts) m += part.blocks.columns();
  joined.R = Eigen::MatrixXd::Zero(m, m);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(m, m);
  joined.data.scale.resize(m);
  Eigen::Index first = 0;
  for (SearchPart& part : parts) {
    const Eigen::Index c = part.blocks.columns();
    const Eigen::MatrixXd per_pose =
        part.prior.size() > 0 ? Eigen::MatrixXd(part.prior / double(request.poses)) : Eigen::MatrixXd();
    const Whitening whitening = whiten(part.blocks, per_pose);
    joined.R.block(first, first, c, c) = whitening.R;
    joined.offsets.push_back(whitening.log_det_offset(part.nuisance));
    Eigen::MatrixXd own;
    if (part.prior.size() > 0) own = whitening.prior * double(request.poses);
    if (own.size() > 0) prior.block(first, first, c, c) = own;
    joined.data.scale.segment(first, c) = part.scale;
    if (several) {
      const std::size_t v = joined.references.size();
      const double reference = request.references.empty() ? reference_of(part, own, request, monitor)
                                                          : request.references[v] - joined.offsets.back();
      joined.references.push_back(reference + joined.offsets.back());
      joined.data.variants.push_back({int(first), int(c), part.nuisance, part.weight, reference});
    }
    first += c;
  }
  if (parts.front().prior.size() > 0) joined.prior = prior;
  joined.data.R = joined.R;
  joined.data.test_points = parts.front().test_points;
  joined.data.effects = parts.front().effects;
  if (!several) joined.nuisance = joined.data.nuisance = parts.front().nuisance;
  joined.blocks = parts.size() == 1 ? std::move(parts.front().blocks) : side_by_side(parts);
  return joined;
}

}  // namespace posewright
