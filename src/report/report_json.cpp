#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../results/sight_json.hpp"
#include "posewright/report/report.hpp"
#include "posewright/support/json.hpp"
#include "posewright/version.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

// What is drawn needs no more than 10 µm and 10 µrad.
constexpr double drawn_step = 1e5;

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
  return json;
}

/// Lower triangle row by row, as written doubles: a page recomputes log det from it.
Json packed(const Eigen::MatrixXd& M) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < M.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) json.push_back(M(i, j));
  return json;
}

Json information_json(const ReportInformation& information) {
  Json json = {{"poses", Json::array()}};
  for (const auto& [id, M] : information.poses) json["poses"].push_back({{"id", id}, {"packed", packed(M)}});
  json["prior"] = information.prior ? packed(*information.prior) : Json(nullptr);
  json["test"] = Json::array();
  for (const auto& [weight, M] : information.test) json["test"].push_back({{"weight", weight}, {"packed", packed(M)}});
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

Json numbers_json(const Eigen::VectorXd& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(value);
  return json;
}

Json exact_placement(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  Eigen::VectorXd values(7);
  values << X.translation(), q.coeffs();
  return numbers_json(values);
}

Json chain_json(const ReportChain& chain) {
  Json json = {{"base", exact_placement(chain.X_MeasureBase)}, {"tip", exact_placement(chain.X_LastTip)}};
  json["joints"] = Json::array();
  for (const ReportChain::Joint& joint : chain.joints)
    json["joints"].push_back({{"placement", exact_placement(joint.X_ParentJoint)},
                              {"axis", numbers_json(joint.axis)},
                              {"prismatic", joint.prismatic},
                              {"multiplier", joint.multiplier},
                              {"offset", joint.offset},
                              {"coordinate", joint.coordinate}});
  json["targets"] = Json::array();
  for (const Eigen::Vector3d& target : chain.targets) json["targets"].push_back(numbers_json(target));
  return json;
}

Json camera_json(const ReportCamera& camera) {
  Json json = {{"on_tip", camera.on_tip},
               {"camera", placement_json(camera.X_CarrierCamera)},
               {"board", placement_json(camera.X_CarrierBoard)},
               {"size", {camera.width, camera.height}},
               {"corners", Json::array()},
               {"names", Json::array()},
               {"points", Json::array()},
               {"pictures", Json::array()}};
  for (const Eigen::Vector3d& corner : camera.corners) json["corners"].push_back(point_json(corner));
  for (const auto& [name, position] : camera.points) {
    json["names"].push_back(name);
    json["points"].push_back(point_json(position));
  }
  for (const auto& [id, pixels] : camera.pictures) {
    Json list = Json::array();
    for (const Eigen::Vector2d& p : pixels)
      list.push_back(p.allFinite() ? Json({drawn(p.x()), drawn(p.y())}) : Json(nullptr));
    json["pictures"].push_back({{"pose", id}, {"pixels", list}});
  }
  return json;
}

/// Two bytes a number, the lower one first, as base64 (RFC 4648).
std::string base64(const std::vector<std::int16_t>& numbers) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes, text;
  for (const std::int16_t number : numbers) {
    bytes.push_back(char(std::uint16_t(number) & 0xff));
    bytes.push_back(char(std::uint16_t(number) >> 8));
  }
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? std::uint8_t(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Json neighbours_json(const ReportNeighbours& n) {
  constexpr double clearance_step = 1e4;  // a tenth of a millimetre
  Json json = {{"reach", n.reach},
               {"coordinates", Json::array()},
               {"places", n.places},
               {"reasons", n.reasons},
               {"bodies", n.bodies},
               {"errors", {{"efficiency", n.efficiency_error}, {"sigma", n.sigma_error}, {"rho0", n.accuracy_error}}},
               {"poses", Json::array()}};
  for (const ReportNeighbours::Coordinate& c : n.coordinates)
    json["coordinates"].push_back({{"index", c.index}, {"step", c.step}, {"lower", c.lower}, {"upper", c.upper}});
  for (const ReportNeighbours::Pose& pose : n.poses) {
    Json one = {{"id", pose.id}, {"steps", pose.steps}, {"verdicts", pose.verdicts}, {"told", Json::array()}};
    for (const bool told : pose.told) one["told"].push_back(told ? 1 : 0);
    one["clearance"] = Json::array();
    for (const double distance : pose.clearance) one["clearance"].push_back(std::lround(distance * clearance_step));
    one["between"] = pose.between;
    one["rows"] = pose.rows;
    one["scale"] = pose.scale;
    one["terms"] = base64(pose.terms);
    one["drawn"] = Json::array();
    for (const ReportKeyframe& keyframe : pose.drawn) one["drawn"].push_back(keyframe_json(keyframe));
    json["poses"].push_back(std::move(one));
  }
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
  for (const auto& [name, X] : report.stations)
    json["stations"].push_back({{"name", name}, {"placement", placement_json(X)}});
  json["targets"] = report.targets;
  json["keyframes"] = Json::array();
  for (const ReportKeyframe& keyframe : report.keyframes) json["keyframes"].push_back(keyframe_json(keyframe));
  json["chain"] = report.chain ? chain_json(*report.chain) : Json(nullptr);
  json["camera"] = report.camera ? camera_json(*report.camera) : Json(nullptr);
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
  json["neighbours"] = report.neighbours ? neighbours_json(*report.neighbours) : Json(nullptr);
  if (!report.neighbours) json["why_no_neighbours"] = report.why_no_neighbours;
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
               {"evenly", report.evenly}};
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

}  // namespace posewright
