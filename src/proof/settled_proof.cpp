#include "posewright/proof/workspace_proof.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
namespace {

// Proofs of one plan; after the first few what they find changes nothing.
constexpr int most_proofs = 4;

}  // namespace

void settle_workspace(WorkspaceBound& found, const BlockArray& blocks, const ApproximateDesign& on_candidates,
                      const InformationFunction& function, const ConfigurationSpace& space,
                      WorkspaceBoundOptions options, const Monitor& monitor) {
  // Several processes end by their boxes (prove_workspace()), so that all of them take the same turns here.
  Monitor own;
  own.follow(monitor);
  own.on_progress = [&monitor](const Progress& progress) { monitor.report(progress); };
  if (options.proof.seconds.value_or(0.0) > 0 && !several_processes(monitor)) own.end_within(*options.proof.seconds);
  prove_workspace(found, space, blocks.count(), blocks.rows(), options, own);
  options.known = found.support;
  // A proof that was ended has used its work up.
  for (int proofs = 1; proofs < most_proofs && !found.proof.refuted_by.empty() && found.proof.ended.empty(); ++proofs) {
    options.known.push_back(found.proof.refuted_by);
    WorkspaceBound better = workspace_bound(blocks, on_candidates, function, space, options, own);
    if (better.stopped) return;
    prove_workspace(better, space, blocks.count(), blocks.rows(), options, own);
    if (!better.proof.why_not.empty() || !(better.proof.bound < found.proof.bound)) return;
    better.proof.boxes += found.proof.boxes;
    better.searches += found.searches;
    found = std::move(better);
  }
}

}  // namespace posewright
