#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../results/sight_json.hpp"
#include "posewright/report/judge_poses.hpp"
#include "posewright/report/report.hpp"
#include "posewright/support/base64.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/json.hpp"
#include "posewright/version.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

// What is drawn needs no more than 10 µm and 10 µrad.
constexpr double drawn_step = 1e5;
// Integers in a unit of whitened rows.
constexpr double row_unit = 1 << 30;

double drawn(double value) {
  const double rounded = std::round(value * drawn_step) / drawn_step;
  return rounded == 0 ? 0.0 : rounded;  // no minus zero
}

Json point_json(const Eigen::Vector3d& p) { return {drawn(p.x()), drawn(p.y()), drawn(p.z())}; }

Json placement_json(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  Json json = point_json(X.translation());
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) json.push_back(drawn(value));
  return json;
}

Json shape_json(const ReportBody& body) {
  switch (body.shape) {
    case ReportBody::Shape::box:
      return {{"type", "box"}, {"size", point_json(body.size)}};
    case ReportBody::Shape::cylinder:
      return {{"type", "cylinder"}, {"radius", body.radius}, {"length", body.length}};
    case ReportBody::Shape::sphere:
      return {{"type", "sphere"}, {"radius", body.radius}};
    case ReportBody::Shape::plane:
      return {{"type", "plane"}, {"normal", point_json(body.size)}};
    case ReportBody::Shape::mesh:
      break;
  }
  Json vertices = Json::array(), triangles = Json::array();
  for (const Eigen::Vector3d& v : body.vertices)
    for (const double x : v) vertices.push_back(drawn(x));
  for (const auto& triangle : body.triangles)
    for (const int i : triangle) triangles.push_back(i);
  return {{"type", "mesh"}, {"vertices", vertices}, {"triangles", triangles}};
}

Json keyframe_json(const ReportKeyframe& k) {
  Json json = {{"pose", k.pose ? Json(*k.pose) : Json(nullptr)}, {"seconds", drawn(k.seconds)}};
  json["frames"] = Json::array();
  for (const Eigen::Isometry3d& X : k.frames) json["frames"].push_back(placement_json(X));
  json["lines"] = Json::array();
  for (const auto& line : k.lines) {
    Json points = Json::array();
    for (const Eigen::Vector3d& p : line) points.push_back(point_json(p));
    json["lines"].push_back(points);
  }
  json["tip"] = placement_json(k.tip);
  json["targets"] = Json::array();
  for (const auto& target : k.targets) json["targets"].push_back(target ? point_json(*target) : Json(nullptr));
  if (!k.instrument.empty()) json["instrument"] = k.instrument;
  return json;
}

/// Lower triangle row by row, as written doubles: a page recomputes log det from it.
Json packed(const Eigen::MatrixXd& M) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < M.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) json.push_back(M(i, j));
  return json;
}

/// W = J R⁻¹ row by row, 32-bit integers in units of 2⁻³⁰, the least significant byte first, as base64. No entry
/// exceeds 1, since all WᵀW and the prior's part add to the identity: so an integer is finer than a 32-bit
/// floating-point number, and log det of the poses keeps ten digits, in a third of the bytes of their decimals.
std::string whitened_rows(const Eigen::MatrixXd& J, const Eigen::MatrixXd& R) {
  Eigen::MatrixXd W = R.transpose().triangularView<Eigen::Lower>().solve(J.transpose()).transpose();
  const Eigen::Index m = W.cols();
  // More rows than columns say no more than their triangle.
  if (W.rows() > m)
    W = Eigen::MatrixXd(Eigen::HouseholderQR<Eigen::MatrixXd>(W).matrixQR().topRows(m).triangularView<Eigen::Upper>());
  std::string bytes;
  bytes.reserve(std::size_t(4 * W.size()));
  for (Eigen::Index i = 0; i < W.rows(); ++i)
    for (Eigen::Index j = 0; j < m; ++j) {
      const auto value = std::uint32_t(std::int32_t(std::lround(W(i, j) * row_unit)));
      for (int k = 0; k < 4; ++k) bytes += char(value >> (8 * k) & 0xff);
    }
  return base64(bytes);
}

Json rows_json(const Eigen::MatrixXd& A) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < A.cols(); ++j) row.push_back(A(i, j));
    json.push_back(row);
  }
  return json;
}

Json information_json(const ReportInformation& information) {
  Json json = {{"factor", packed(information.triangle.transpose())}, {"poses", Json::array()}};
  for (const auto& [id, J] : information.poses)
    json["poses"].push_back({{"id", id}, {"rows", whitened_rows(J, information.triangle)}});
  json["prior"] = information.prior ? packed(*information.prior) : Json(nullptr);
  json["test"] = Json::array();
  for (const auto& [weight, A] : information.test) json["test"].push_back({{"weight", weight}, {"rows", rows_json(A)}});
  return json;
}

Json columns_json(const ReportInformation& information) {
  Json json = Json::array();
  for (const PlannedParameter& p : information.columns)
    json.push_back({{"name", p.label.name},
                    {"unit", p.label.unit},
                    {"tolerance", p.label.tolerance},
                    {"role", p.label.role == Role::interest ? "interest" : "nuisance"},
                    {"variant", p.variant}});
  return json;
}

Json candidates_json(const ReportCandidates& candidates) {
  Json positions = Json::array(), sensitivity = Json::array();
  for (const Eigen::Vector3d& p : candidates.positions)
    for (const double x : p) positions.push_back(drawn(x));
  for (const double d : candidates.sensitivity) sensitivity.push_back(drawn(d));
  return {{"sensitivity", sensitivity}, {"bound", 1.0}, {"positions", positions}, {"chosen", candidates.chosen}};
}

Json pixels_json(const std::vector<Eigen::Vector2d>& pixels) {
  Json json = Json::array();
  for (const Eigen::Vector2d& p : pixels)
    json.push_back(p.allFinite() ? Json({drawn(p.x()), drawn(p.y())}) : Json(nullptr));
  return json;
}

Json camera_json(const ReportCamera& camera) {
  Json json = {{"camera", {{"frame", camera.camera_frame}, {"placement", placement_json(camera.X_FrameCamera)}}},
               {"board", {{"frame", camera.board_frame}, {"placement", placement_json(camera.X_FrameBoard)}}},
               {"size", {camera.width, camera.height}},
               {"corners", Json::array()},
               {"names", Json::array()},
               {"points", Json::array()},
               {"pictures", Json::array()}};
  if (!camera.instrument.empty()) json["instrument"] = camera.instrument;
  if (!camera.with.empty()) json["with"] = camera.with;
  for (const Eigen::Vector3d& corner : camera.corners) json["corners"].push_back(point_json(corner));
  for (const auto& [name, position] : camera.points) {
    json["names"].push_back(name);
    json["points"].push_back(point_json(position));
  }
  for (const auto& [id, pixels] : camera.pictures)
    json["pictures"].push_back({{"pose", id}, {"pixels", pixels_json(pixels)}});
  return json;
}

Json bodies_json(const Report& report) {
  Json json = Json::array();
  for (const ReportBody& body : report.bodies)
    json.push_back({{"name", body.name},
                    {"kind", body.kind},
                    {"frame", body.frame},
                    {"placement", placement_json(body.X_FrameBody)},
                    {"shape", shape_json(body)}});
  for (std::size_t i = 0; i < report.bodies.size(); ++i)
    if (report.bodies[i].colour) json[i]["colour"] = *report.bodies[i].colour;
  return json;
}

/// What is drawn, whatever the page tells of it.
void add_scene(Json& json, const Report& report) {
  json["frames"] = report.frames;
  json["bodies"] = bodies_json(report);
  json["stations"] = Json::array();
  for (const ReportStation& station : report.stations) {
    json["stations"].push_back({{"name", station.name}, {"placement", placement_json(station.X_MeasureStation)}});
    if (!station.instrument.empty()) json["stations"].back()["instrument"] = station.instrument;
  }
  json["targets"] = report.targets;
  json["keyframes"] = Json::array();
  for (const ReportKeyframe& keyframe : report.keyframes) json["keyframes"].push_back(keyframe_json(keyframe));
  json["cameras"] = Json::array();
  for (const ReportCamera& camera : report.cameras) json["cameras"].push_back(camera_json(camera));
}

Json plan_report(const Report& report) {
  Json json = {{"schema", "posewright/report/1"},
               {"version", version},
               {"title", report.title},
               {"notes", report.notes},
               {"plan", parse_ordered_json(report.plan_json)},
               {"route", report.route_json.empty() ? Json(nullptr) : parse_ordered_json(report.route_json)}};
  add_scene(json, report);
  json["actuator_units"] = Json::object();
  for (const auto& [name, unit] : report.actuators) json["actuator_units"][name] = unit;
  json["columns"] = columns_json(report.information);
  json["information"] = information_json(report.information);
  json["singular_values"] = Json::array();
  for (const double s : report.information.singular_values) json["singular_values"].push_back(s);
  json["candidates"] = report.candidates ? candidates_json(*report.candidates) : Json(nullptr);
  json["position_errors"] = report.position_errors;
  json["curve"] = Json::array();
  for (const CurvePoint& point : report.curve) json["curve"].push_back(curve_point_json(point));
  json["prefix"] = Json::array();
  for (const auto& point : report.prefix) json["prefix"].push_back(point ? curve_point_json(*point) : Json(nullptr));
  return json;
}

}  // namespace

std::string report_json(const Report& report) { return json_text(plan_report(report), JsonLayout::one_line) + "\n"; }

std::string report_json(const ResultReport& report) {
  Json json = {{"schema", "posewright/report-of-result/1"},
               {"version", version},
               {"title", report.title},
               {"file", report.file},
               {"refresh", report.refresh},
               {"result", parse_ordered_json(report.result_json)}};
  return json_text(json, JsonLayout::one_line) + "\n";
}

std::string report_json(const ProblemReport& report) {
  Json json = {{"schema", "posewright/report-of-problem/1"},
               {"version", version},
               {"title", report.scene.title},
               {"problem", {{"file", report.file}, {"sha256", report.sha256}}},
               {"seed", report.seed},
               {"notes", report.scene.notes},
               {"faults", report.faults},
               {"reasons", report.reasons},
               {"verdicts", report.verdicts},
               {"evenly", report.evenly},
               {"cell", {{"frame", report.scene.cell_frame}, {"placement", placement_json(report.scene.X_FrameCell)}}}};
  add_scene(json, report.scene);
  return json_text(json, JsonLayout::one_line) + "\n";
}

std::string report_json(const TwoPlansReport& report) {
  Json json = {{"schema", "posewright/report-of-two-plans/1"},
               {"version", version},
               {"title", report.title},
               {"files", report.files},
               {"plans", {plan_report(report.plans[0]), plan_report(report.plans[1])}}};
  return json_text(json, JsonLayout::one_line) + "\n";
}

std::string report_json(const JudgedPoses& judged) {
  Json json = {{"schema", "posewright/judged-poses/1"},
               {"version", version},
               {"ranges", Json::array()},
               {"poses", Json::array()}};
  for (const JudgedPoses::Range& range : judged.ranges)
    json["ranges"].push_back({{"index", range.index}, {"lower", range.lower}, {"upper", range.upper}});
  for (const JudgedPose& one : judged.poses)
    json["poses"].push_back({{"reason", one.reason.empty() ? Json(nullptr) : Json(one.reason)},
                             {"pose", planned_pose_json(one.pose)},
                             {"keyframe", keyframe_json(one.drawn)},
                             {"packed", packed(one.information)},
                             {"pixels", one.pixels.empty() ? Json(nullptr) : pixels_json(one.pixels)}});
  return json_text(json, JsonLayout::one_line) + "\n";
}

}  // namespace posewright
