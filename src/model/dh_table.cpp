#include "posewright/model/dh_table.hpp"

#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

double* cell(DhRow& row, const std::string& kind) {
  if (kind == "theta") return &row.theta;
  if (kind == "d") return &row.d;
  if (kind == "a") return &row.a;
  if (kind == "alpha") return &row.alpha;
  return &row.beta.emplace(0.0);
}

}  // namespace

Eigen::Isometry3d DhTable::tip(std::span<const double> q) const {
  using Eigen::AngleAxisd, Eigen::Translation3d, Eigen::Vector3d;
  Eigen::Isometry3d X = X_MeasureBase * X_BaseFirst;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DhRow& row = rows[i];
    const Eigen::Isometry3d joint = AngleAxisd(row.theta + (row.prismatic ? 0 : q[i]), Vector3d::UnitZ()) *
                                    Translation3d(0, 0, row.d + (row.prismatic ? q[i] : 0));
    const Eigen::Isometry3d link = Translation3d(row.a, 0, 0) * AngleAxisd(row.alpha, Vector3d::UnitX()) *
                                   AngleAxisd(row.beta.value_or(0), Vector3d::UnitY());
    X = convention == DhConvention::distal ? X * joint * link : X * link * joint;
  }
  return X * X_LastTip;
}

DhTable dh_table(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention names,
                 const std::vector<CalibratedValue>& values, DhConvention convention) {
  const ChainDescription nominal = read_urdf_chain(arm, place);
  const ChainCorrection correction = chain_correction(nominal, names, values);
  const ChainDescription chain = corrected_chain(nominal, correction);
  const DhDescription dh = denavit_hartenberg(chain, convention);
  DhTable table;
  table.convention = convention;
  table.X_MeasureBase = chain.X_MeasureBase;
  table.X_BaseFirst = chain.X_MeasureBase.inverse() * dh.base;
  table.X_LastTip = dh.tool;
  for (const ChainJoint& joint : chain.joints) {
    table.rows.emplace_back();
    table.rows.back().joint = joint.name;
    table.rows.back().prismatic = joint.prismatic;
  }
  for (const ElementaryMotion& motion : dh.motions) {
    if (motion.name.empty()) continue;  // the reading of a prismatic joint whose d is zero
    const std::size_t dot = motion.name.rfind('.');
    for (DhRow& row : table.rows)
      if (row.joint == motion.name.substr(0, dot)) *cell(row, motion.name.substr(dot + 1)) = motion.nominal;
  }
  for (const CalibratedValue& v : correction.left_out)
    table.left_out.push_back(left_out_text(v, "a table of Denavit–Hartenberg parameters has no place for it"));
  return table;
}

}  // namespace posewright
