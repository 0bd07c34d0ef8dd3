#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "posewright/results/plan.hpp"

namespace posewright {

/// A body as the report's 3-D view draws it, m.
struct ReportBody {
  std::string name, kind;                         ///< kind: robot, tool, obstacle
  std::optional<std::array<double, 3>> colour{};  ///< of the URDF: red, green, blue, 0 to 1
  int frame = 0;                                  ///< index into Report::frames
  Eigen::Isometry3d X_FrameBody = Eigen::Isometry3d::Identity();
  enum class Shape { box, cylinder, sphere, plane, mesh } shape = Shape::box;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< edges of a box; normal of a plane (solid behind it)
  double radius = 0.0, length = 0.0;
  std::vector<Eigen::Vector3d> vertices{};
  std::vector<std::array<int, 3>> triangles{};
};

/// The robot at one moment, measurement frame.
struct ReportKeyframe {
  std::optional<int> pose;  ///< where it stands still: pose id, 0 for home; none on the way
  double seconds = 0.0;     ///< since the start of the route
  std::vector<Eigen::Isometry3d> frames{};
  std::vector<std::vector<Eigen::Vector3d>> lines{};
  Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  std::vector<std::optional<Eigen::Vector3d>> targets{};  ///< none: not drawn here
  std::string instrument{};                               ///< of a list: that reads
};

/// Data for figures of any subset of the poses, columns in units of their tolerance, nuisance columns first.
struct ReportInformation {
  std::vector<PlannedParameter> columns;                 ///< of the first variant
  std::vector<std::pair<int, Eigen::MatrixXd>> poses;    ///< pose id, whitened rows J (r × m)
  std::optional<Eigen::MatrixXd> prior;                  ///< counts beside the poses, m × m
  Eigen::MatrixXd triangle;                              ///< R, upper: RᵀR = Σ JᵀJ + prior
  std::vector<std::pair<double, Eigen::MatrixXd>> test;  ///< weight, A of a test point (3 × m, m)
  Eigen::VectorXd singular_values;                       ///< interest columns, nuisance eliminated, descending
};

/// Gain of each candidate at the best weights.
struct ReportCandidates {
  std::vector<double> sensitivity;         ///< divided by what a candidate must reach to be worth measuring
  std::vector<Eigen::Vector3d> positions;  ///< of the tip, m
  std::vector<int> chosen;                 ///< those that are poses of the plan
};

/// An instrument that stands still.
struct ReportStation {
  std::string instrument;  ///< of a list
  std::string name;
  Eigen::Isometry3d X_MeasureStation = Eigen::Isometry3d::Identity();
};

/// A camera, its board and where the camera will see the board's points.
struct ReportCamera {
  std::string instrument;                 ///< of a list
  std::vector<std::string> with;          ///< as DrawnCamera::with
  int camera_frame = 0, board_frame = 0;  ///< index into Report::frames: what carries it
  Eigen::Isometry3d X_FrameCamera = Eigen::Isometry3d::Identity(), X_FrameBoard = Eigen::Isometry3d::Identity();
  double width = 0, height = 0;                                 ///< px
  std::vector<Eigen::Vector3d> corners;                         ///< lines of sight of the picture's corners, z = 1
  std::vector<std::pair<std::string, Eigen::Vector3d>> points;  ///< board frame, m
  /// By pose id: u, v of every point, px; NaN: not predicted.
  std::vector<std::pair<int, std::vector<Eigen::Vector2d>>> pictures;
};

/// Data of the report's page besides plan and route.
struct Report {
  std::string title;
  std::vector<std::string> notes;     ///< what the reader should know before trusting it
  std::string plan_json, route_json;  ///< as their files are; route empty: none
  std::vector<std::string> frames;    ///< the first is fixed
  int cell_frame = 0;                 ///< index into frames: carries the cell, in which obstacles have their positions
  Eigen::Isometry3d X_FrameCell = Eigen::Isometry3d::Identity();
  std::vector<ReportBody> bodies;
  std::vector<ReportStation> stations;
  std::vector<std::string> targets;
  std::vector<std::pair<std::string, std::string>> actuators;  ///< of a parallel robot: name and unit of each
  std::vector<ReportKeyframe> keyframes;                       ///< in measuring order
  ReportInformation information;
  std::optional<ReportCandidates> candidates;
  std::vector<ReportCamera> cameras;
  std::vector<double> position_errors;  ///< predicted, at feasible configurations spread like the candidates, m
  std::vector<CurvePoint> curve;        ///< other numbers of poses; worst_sigma is σ / tolerance
  std::vector<std::optional<CurvePoint>> prefix;  ///< after each pose in measuring order; none: not identifiable yet
};

/// Result of another command than plan, for the page.
struct ResultReport {
  std::string title;        ///< the robot
  std::string file;         ///< where the result was read from
  std::string result_json;  ///< as the file is
  bool ended = false;       ///< the result itself says that nothing more comes
  double refresh = 0.0;     ///< s after which the page reads itself again; 0: never
};

/// A problem before any plan.
struct ProblemReport {
  std::string file, sha256;
  std::uint64_t seed = 0;
  Report scene;  ///< drawn parts alone; keyframes: home (pose 0), then what was looked at (1, 2, …)
  std::vector<std::string> faults;   ///< messages of checks that cannot be made, `file:line: …`
  std::vector<std::string> reasons;  ///< that forbid configurations
  std::vector<int> verdicts;         ///< one a keyframe: index into reasons; −1: feasible
  int evenly = 0;                    ///< keyframes 1 to this were drawn evenly, those behind are feasible
};

/// Two plans beside each other.
struct TwoPlansReport {
  std::string title;
  std::array<std::string, 2> files;
  std::array<Report, 2> plans;
};

/// Schemas posewright/report/1, posewright/report-of-result/1, posewright/report-of-problem/1,
/// posewright/report-of-two-plans/1 (docs/report.md).
std::string report_json(const Report& report);
std::string report_json(const ResultReport& report);
std::string report_json(const TwoPlansReport& report);
std::string report_json(const ProblemReport& report);
/// The page: one file, no network.
std::string report_html(const Report& report);
std::string report_html(const ResultReport& report);
std::string report_html(const TwoPlansReport& report);
std::string report_html(const ProblemReport& report);

}  // namespace posewright
