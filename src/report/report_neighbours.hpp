#pragma once

#include <utility>
#include <vector>

#include "posewright/cell/drawing.hpp"
#include "posewright/report/report.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Fills report.neighbours: looks at every place around each pose that is one or two coordinates away, so that whoever
/// moves a pose there is told what evaluate would tell; or report.why_no_neighbours. Uses report.information and
/// report.chain.
/// @param poses  id and configuration of those that are still to be measured
void fill_neighbours(Report& report, const Study& study, const Drawing& drawing,
                     const std::vector<std::pair<int, std::vector<double>>>& poses, int threads,
                     const Monitor& monitor);

}  // namespace posewright
