#include "posewright/calibration/conventions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>

#include "posewright/calibration/hand_eye.hpp"
#include "posewright/model/board_pose.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

constexpr double falls_by = 10.0, as_good = 2.0;
// A single pose that is wrong at the end of a list is no shift.
constexpr std::size_t most_poses = 60, least_sights = 6, least_shifted = 3;
// A pose is seen as three points this far apart: half a millimetre weighs as much as two milliradians.
constexpr double arm = 0.25;
constexpr double degree = std::numbers::pi / 180;

/// A row of the file: what the joints count and what the instrument reads.
struct Row {
  int id = 0;
  std::vector<double> q;
  Eigen::VectorXd y;
};

/// One line of the table. What it leaves out stays as the file has it.
struct Hypothesis {
  std::string condition, remedy;
  std::function<void(Row&)> row = nullptr;
  std::function<Eigen::Isometry3d(const Eigen::Isometry3d&)> seen = nullptr;  ///< of poses that were seen
  bool mirrored = false, free_scale = false;
  int late = 0;           ///< rows by which readings are late
  std::size_t first = 0;  ///< row from which on they are
};

constexpr std::array<std::array<int, 3>, 6> orders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

/// The orientation whose quaternion w, x, y, z was taken for x, y, z, w.
Eigen::Matrix3d scalar_first(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
}

/// Three numbers that belong to axes x, y, z and were taken for turns about moving axes in some order.
struct TakenForTurns {
  std::string condition;
  EulerTurns as{};
  bool vector = false;  ///< they are a rotation vector, half a turn at most
  bool far = false;     ///< the second turn is beyond 90 deg, where both are possible
  std::function<Eigen::Matrix3d(const Eigen::Vector3d&)> meant = nullptr;

  /// The numbers from the orientation that they were made to.
  Eigen::Vector3d numbers(const Eigen::Matrix3d& R) const {
    const Eigen::Vector3d turns = as.angles(R);
    const Eigen::Vector3d near_ones = by_axis(turns);
    const Eigen::Vector3d far_ones =
        by_axis({turns[0] + std::numbers::pi, std::numbers::pi - turns[1], turns[2] + std::numbers::pi});
    const bool allowed = !vector || (far ? far_ones : near_ones).norm() <= std::numbers::pi;
    return far == allowed ? far_ones : near_ones;
  }
  Eigen::Vector3d by_axis(const Eigen::Vector3d& turns) const {
    Eigen::Vector3d v;
    for (std::size_t k = 0; k < 3; ++k) v[as.axes[k]] = std::remainder(turns[Eigen::Index(k)], 2 * std::numbers::pi);
    return v;
  }
};

std::string order_name(const EulerTurns& turns) { return turns.name().substr(7); }

Eigen::Matrix3d turned_by_axis(const EulerTurns& turns, const Eigen::Vector3d& v) {
  return turns.rotation({v[turns.axes[0]], v[turns.axes[1]], v[turns.axes[2]]});
}

/// Every way in which three numbers or four were taken for others.
std::vector<TakenForTurns> taken_for_turns() {
  std::vector<TakenForTurns> all;
  for (const auto& taken : orders)
    for (const bool far : {false, true}) {
      const EulerTurns as{true, taken};
      for (const auto& meant : orders)
        if (const EulerTurns turns{true, meant}; meant != taken)
          all.push_back({"turns about moving axes " + order_name(turns) + " that were taken for " + order_name(as), as,
                         false, far, [turns](const Eigen::Vector3d& v) { return turned_by_axis(turns, v); }});
      all.push_back({"rotation vectors that were taken for turns about moving axes " + order_name(as), as, true, far,
                     rotation_by});
    }
  const EulerTurns any{true, orders[0]};
  all.push_back({"quaternions w, x, y, z that were taken for x, y, z, w", any, false, false,
                 [any](const Eigen::Vector3d& v) { return scalar_first(turned_by_axis(any, v)); }});
  return all;
}

// --- robots
// -----------------------------------------------------------------------------------------------------------

bool is_continuous(const Coordinate& c) { return !c.choice(); }

/// Coordinates that turn about three axes at right angles: a controller's pose in place of joints.
class PoseRobot {
 public:
  /// @param tip  in the base at a configuration
  static std::optional<PoseRobot> of(const std::vector<Coordinate>& coordinates,
                                     const std::function<Eigen::Isometry3d(const std::vector<double>&)>& tip) {
    PoseRobot robot;
    std::vector<double> q(coordinates.size(), 0.0);
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      if (coordinates[i].choice()) q[i] = coordinates[i].values.front();
      else if (coordinates[i].unit == "rad") robot.at_.push_back(i);
    }
    if (robot.at_.size() != 3) return std::nullopt;
    robot.zero_ = tip(q).linear();
    for (std::size_t k = 0; k < 3; ++k)
      if (!robot.take_axis(k, q, tip)) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) q[robot.at_[k]] = 0.3 + 0.2 * double(k);
    const bool as_said = robot.axes_[0] != robot.axes_[1] && robot.axes_[1] != robot.axes_[2] &&
                         robot.axes_[0] != robot.axes_[2] &&
                         (robot.turns().rotation(robot.angles(q)) * robot.zero_).isApprox(tip(q).linear(), 1e-6);
    return as_said ? std::optional(robot) : std::nullopt;
  }

  EulerTurns turns() const { return {true, axes_}; }
  /// In the order of the joints.
  Eigen::Vector3d angles(const std::vector<double>& q) const {
    return {sign_[0] * q[at_[0]], sign_[1] * q[at_[1]], sign_[2] * q[at_[2]]};
  }
  void turn_to(const Eigen::Matrix3d& R, std::vector<double>& q) const {
    const Eigen::Vector3d own = turns().angles(R);
    for (std::size_t k = 0; k < 3; ++k) q[at_[k]] = sign_[k] * own[Eigen::Index(k)];
  }
  std::size_t coordinate(std::size_t k) const { return at_[k]; }

 private:
  bool take_axis(std::size_t k, std::vector<double> q,
                 const std::function<Eigen::Isometry3d(const std::vector<double>&)>& tip) {
    constexpr double angle = 0.1;
    q[at_[k]] = angle;
    const Eigen::Vector3d axis = rotation_vector(tip(q).linear() * zero_.transpose()) / angle;
    Eigen::Index along = 0;
    if (!(axis.cwiseAbs().maxCoeff(&along) > 1 - 1e-6)) return false;
    axes_[k] = int(along);
    sign_[k] = axis[along] > 0 ? 1 : -1;
    return true;
  }

  std::vector<std::size_t> at_;
  std::array<int, 3> axes_{};
  std::array<double, 3> sign_{};
  Eigen::Matrix3d zero_;
};

void add_pose_robot(const PoseRobot& robot, const std::vector<Coordinate>& coordinates,
                    std::vector<Hypothesis>& table) {
  const std::string names = coordinates[robot.coordinate(0)].name + ", " + coordinates[robot.coordinate(1)].name +
                            ", " + coordinates[robot.coordinate(2)].name;
  for (const TakenForTurns& taken : taken_for_turns())
    table.push_back(
        {names + " come from " + taken.condition,
         "convert the robot's orientations to turns about moving axes " + order_name(robot.turns()) +
             ", as these joints are",
         [robot, taken](Row& row) {
           const Eigen::Vector3d own = robot.angles(row.q);
           // The joints' own order keeps the numbers as they were written.
           const bool written = taken.as.axes == robot.turns().axes && !taken.far;
           robot.turn_to(taken.meant(written ? taken.by_axis(own) : taken.numbers(robot.turns().rotation(own))), row.q);
         }});
}

void add_joint(const std::string& name, std::size_t j, bool turns, std::vector<Hypothesis>& table) {
  table.push_back(
      {name + " counts the other way", "change the sign of its column", [j](Row& row) { row.q[j] = -row.q[j]; }});
  if (!turns) return;
  for (const int zero : {-90, 90, 180})
    table.push_back(
        {fmt::format("the zero of {} is {} deg off", name, std::abs(zero)),
         fmt::format("{} {} deg {} its column", zero > 0 ? "add" : "take", std::abs(zero), zero > 0 ? "to" : "from"),
         [j, zero](Row& row) { row.q[j] += zero * degree; }});
}

void add_coupling(const std::string& name, std::size_t j, const std::string& other, std::size_t k,
                  std::vector<Hypothesis>& table) {
  for (const double sign : {-1.0, 1.0}) {
    const std::string sum = name + (sign > 0 ? " + " : " - ") + other;
    const std::string parameter = name + ".coupling." + other;
    table.push_back(
        {fmt::format("{} turns by {} (a controller's coupling {:+.0f}, as where an axis counts from the horizontal)",
                     name, sum, sign),
         fmt::format(
             "write {} into its column, or in the problem file robot: joint_effects: {{{}: {{coupling: [{}]}}}} "
             "and in the variant parameters: [auto, {}], tolerance: {{{}: 1}}",
             sum, name, other, parameter, parameter),
         [j, k, sign](Row& row) { row.q[j] += sign * row.q[k]; }});
  }
}

void add_joints(const std::vector<Coordinate>& coordinates, std::vector<Hypothesis>& table) {
  std::vector<std::size_t> turning;
  for (std::size_t j = 0; j < coordinates.size(); ++j) {
    if (!is_continuous(coordinates[j])) continue;
    const bool turns = coordinates[j].unit == "rad";
    add_joint(coordinates[j].name, j, turns, table);
    if (turns) turning.push_back(j);
  }
  for (const std::size_t j : turning)
    for (const std::size_t k : turning)
      if (j != k) add_coupling(coordinates[j].name, j, coordinates[k].name, k, table);
  table.push_back(
      {"angles of the joints are degrees",
       "state the unit in the header, as in " + (turning.empty() ? "joint" : coordinates[turning[0]].name) + " [deg]",
       [turning](Row& row) {
         for (const std::size_t j : turning) row.q[j] *= degree;
       }});
}

// --- instruments
// ------------------------------------------------------------------------------------------------------

/// Three columns of a rotation vector that are something else.
void add_columns(std::vector<Hypothesis>& table) {
  constexpr std::array<const char*, 3> columns = {"pose.rx", "pose.ry", "pose.rz"};
  for (const auto& order : orders) {
    const EulerTurns turns{true, order};
    table.push_back({"pose.rx, pose.ry, pose.rz are turns about moving axes " + order_name(turns),
                     fmt::format("name {}, {}, {} pose.{}.1, .2, .3", columns[std::size_t(order[0])],
                                 columns[std::size_t(order[1])], columns[std::size_t(order[2])], turns.name()),
                     [turns](Row& row) {
                       const Eigen::Vector3d v = row.y.tail<3>();
                       row.y.tail<3>() = rotation_vector(turned_by_axis(turns, v));
                     }});
  }
  table.push_back({"pose.rx, pose.ry, pose.rz are degrees", "state the unit in the header, as in pose.rx [deg]",
                   [](Row& row) { row.y.tail<3>() *= degree; }});
}

void add_orientations(const OrientationForm& form, std::vector<Hypothesis>& table) {
  if (form.kind == OrientationForm::vector) add_columns(table);
  for (const TakenForTurns& taken : taken_for_turns())
    table.push_back({"orientations that were read come from " + taken.condition,
                     form.kind == OrientationForm::quaternion
                         ? "convert them, or if w stands first, rename the columns pose.qx, pose.qy, pose.qz, pose.qw "
                           "to pose.qw, pose.qx, pose.qy, pose.qz"
                         : "convert them, or name the columns by what they are",
                     nullptr, [taken](const Eigen::Isometry3d& X) {
                       Eigen::Isometry3d turned = X;
                       turned.linear() = taken.meant(taken.numbers(X.linear()));
                       return turned;
                     }});
}

void add_poses(bool robot_is_pose, std::vector<Hypothesis>& table) {
  table.push_back({robot_is_pose ? "poses of the instrument or those of the robot are inverted (the target in the "
                                   "camera for the camera in the target, or the base in the flange)"
                                 : "poses of the instrument are inverted (the target in the camera for the camera in "
                                   "the target)",
                   "write measurement: mount: hand or fixed, whichever is the case, or the inverse of each", nullptr,
                   [](const Eigen::Isometry3d& X) { return X.inverse(); }});
  table.push_back({"orientations of the instrument are transposed", "turn each the other way", nullptr,
                   [](const Eigen::Isometry3d& X) {
                     Eigen::Isometry3d turned = X;
                     turned.linear() = X.linear().transpose();
                     return turned;
                   }});
}

void add_picture(const CameraMeasurement& camera, std::vector<Hypothesis>& table) {
  const auto add = [&](const std::string& condition, const std::string& remedy,
                       const std::function<void(Eigen::VectorXd&)>& change) {
    table.push_back({condition, remedy, [change](Row& row) { change(row.y); }});
  };
  const auto every_pixel = [](const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& pixel) {
    return [pixel](Eigen::VectorXd& y) {
      for (Eigen::Index i = 0; i + 1 < y.size(); i += 2) y.segment<2>(i) = pixel(Eigen::Vector2d(y.segment<2>(i)));
    };
  };
  add("the picture is flipped", "write width - u for u",
      every_pixel([w = camera.width](const Eigen::Vector2d& p) { return Eigen::Vector2d(w - p.x(), p.y()); }));
  add("u and v are exchanged", "exchange the columns .u and .v",
      every_pixel([](const Eigen::Vector2d& p) { return Eigen::Vector2d(p.y(), p.x()); }));
  add("focal lengths of u and v are exchanged", "write camera: focal: [fy, fx]",
      every_pixel([camera](const Eigen::Vector2d& p) {
        const double ratio = camera.fx / camera.fy;
        return Eigen::Vector2d((p.x() - camera.cx) * ratio + camera.cx, (p.y() - camera.cy) / ratio + camera.cy);
      }));
  add("points of the board are counted column by column", "count them row by row", [camera](Eigen::VectorXd& y) {
    const Eigen::VectorXd by_column = y;
    for (int i = 0; i < camera.rows * camera.columns; ++i)
      y.segment<2>(2 * i) = by_column.segment<2>(2 * (i % camera.columns * camera.rows + i / camera.columns));
  });
  table.push_back({camera.on_hand ? "the camera is fixed and the board on the hand" : "the camera is on the hand",
                   std::string("write measurement: mount: ") + (camera.on_hand ? "fixed" : "hand"), nullptr,
                   [](const Eigen::Isometry3d& X) { return X.inverse(); }});
}

struct Unit {
  double size;
  const char *condition, *remedy;
};

/// Name of one factor on all measured lengths.
Convention scaled(double scale, const MeasurementSpec& measurement) {
  if (const auto* camera = std::get_if<CameraMeasurement>(&measurement.instrument))
    return {fmt::format("squares of the board are {:.4g} mm", 1e3 * scale * camera->spacing),
            fmt::format("measure the board, and write its spacing in the problem file")};
  constexpr const char* header = "state the unit in the header, as in pose.x [mm]";
  for (const Unit& unit :
       {Unit{1e-3, "lengths that were read are mm", header}, Unit{0.0254, "lengths that were read are inches", header},
        Unit{0.01, "lengths that were read are cm", header},
        Unit{1e3, "lengths that were read are m, or those of the robot mm",
             "state the unit in the header, as in pose.x [m], or the robot's lengths in m"},
        Unit{1 / 0.0254, "lengths of the robot are inches", "state the robot's lengths in m"}})
    if (std::abs(std::log(scale / unit.size)) < 0.02) return {unit.condition, unit.remedy};
  return {fmt::format("lengths are {:.5g} times those that were read", scale),
          "look for the scale of instrument or robot"};
}

// --- the search
// -------------------------------------------------------------------------------------------------------

/// Rows of one station and one campaign, of which most were measured, in the order of the file.
std::vector<Row> rows_of(const IdentificationModel& model, const std::vector<MeasuredPose>& poses) {
  std::map<std::vector<double>, std::vector<Row>> groups;
  for (const MeasuredPose& pose : poses) {
    std::vector<double> key;
    for (std::size_t i = 0; i < pose.q.size(); ++i)
      if (const std::string& name = model.coordinates()[i].name; name == "station" || name == "campaign")
        key.push_back(pose.q[i]);
    groups[key].push_back({pose.id, pose.q, pose.y});
  }
  if (groups.empty()) return {};
  std::vector<Row> rows =
      std::ranges::max_element(groups, {}, [](const auto& group) { return group.second.size(); })->second;
  if (rows.size() > most_poses) rows.resize(most_poses);
  return rows;
}

class Search {
 public:
  Search(const Problem& problem, const IdentificationModel& model, const std::vector<MeasuredPose>& poses)
      : problem_(problem), model_(model), rows_(rows_of(model, poses)) {
    if (const auto* arm_spec = std::get_if<SerialArmSpec>(&problem.robot)) base_ = isometry(arm_spec->placement);
  }

  /// True if the instrument reads a place in space.
  bool sees_places() const {
    const InstrumentSpec& instrument = problem_.measurement.instrument;
    if (problem_.measurement.loaded_minus_unloaded || rows_.size() < least_sights) return false;
    if (const auto* pose = std::get_if<PoseMeasurement>(&instrument)) return pose->components.size() == 6;
    if (const auto* points = std::get_if<PointsMeasurement>(&instrument)) return points->components.size() == 3;
    return std::holds_alternative<CameraMeasurement>(instrument);
  }

  std::vector<Hypothesis> table(const OrientationForm& form) const {
    std::vector<Hypothesis> table;
    std::optional<PoseRobot> robot;
    if (std::holds_alternative<SerialArmSpec>(problem_.robot)) {
      robot = PoseRobot::of(model_.coordinates(), [this](const std::vector<double>& q) { return tip(q); });
      if (robot) add_pose_robot(*robot, model_.coordinates(), table);
      add_joints(model_.coordinates(), table);
    }
    if (const auto* camera = std::get_if<CameraMeasurement>(&problem_.measurement.instrument)) {
      add_picture(*camera, table);
    } else if (std::holds_alternative<PoseMeasurement>(problem_.measurement.instrument)) {
      add_orientations(form, table);
      add_poses(robot.has_value(), table);
    }
    table.push_back({"the instrument's axes or the robot's are left-handed (mirrored)",
                     "change the sign of one coordinate, as of y, or exchange two axes", nullptr, nullptr, true});
    add_shifts(table);
    table.push_back({"", "", nullptr, nullptr, false, true});
    return table;
  }

  /// Residuals with base and tool alone.
  HandEye left(const Hypothesis& hypothesis) const {
    std::vector<SeenPoints> seen;
    for (const Row& written : rows_) {
      Row row = written;
      if (hypothesis.row) hypothesis.row(row);
      seen.push_back({tip(row.q), points(row, hypothesis)});
      if (hypothesis.mirrored) mirror(seen.back().points);
    }
    shift(seen, hypothesis.late, hypothesis.first);
    return hand_eye(seen, hypothesis.free_scale);
  }

  const MeasurementSpec& measurement() const { return problem_.measurement; }

 private:
  void add_shifts(std::vector<Hypothesis>& table) const {
    for (const int late : {1, -1, 2, -2, 3, -3})
      for (std::size_t first = 0; first + std::size_t(std::abs(late)) + least_shifted <= rows_.size(); ++first)
        table.push_back({fmt::format("readings{} belong {} row{} {}",
                                     first == 0 ? "" : fmt::format(" from pose {} on", rows_[first].id), std::abs(late),
                                     std::abs(late) == 1 ? "" : "s", late > 0 ? "earlier" : "later"),
                         fmt::format("move them {} row{} {}", std::abs(late), std::abs(late) == 1 ? "" : "s",
                                     late > 0 ? "up" : "down"),
                         nullptr, nullptr, false, false, late, first});
  }

  Eigen::Isometry3d tip(const std::vector<double>& q) const { return base_.inverse() * model_.tool_pose(q); }

  bool sees_poses() const { return !std::holds_alternative<PointsMeasurement>(problem_.measurement.instrument); }

  /// Pose of what is on the tip, seen by what is fixed.
  std::optional<Eigen::Isometry3d> pose(const Row& row) const {
    if (const auto* camera = std::get_if<CameraMeasurement>(&problem_.measurement.instrument)) {
      const std::optional<Eigen::Isometry3d> board = board_pose(*camera, row.y);
      return board && camera->on_hand ? board->inverse() : board;
    }
    if (!row.y.allFinite()) return std::nullopt;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = row.y.head<3>();
    X.linear() = rotation_by(row.y.tail<3>());
    const auto* pose = std::get_if<PoseMeasurement>(&problem_.measurement.instrument);
    return pose != nullptr && pose->on_hand ? X.inverse() : X;
  }

  Eigen::Matrix3Xd points(const Row& row, const Hypothesis& hypothesis) const {
    if (!sees_poses()) return row.y.reshaped(3, row.y.size() / 3);
    std::optional<Eigen::Isometry3d> X = pose(row);
    Eigen::Matrix3d corners;
    corners << Eigen::Vector3d::Zero(), arm * Eigen::Vector3d::UnitX(), arm * Eigen::Vector3d::UnitY();
    if (!X) return Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
    if (hypothesis.seen) X = hypothesis.seen(*X);
    return (X->linear() * corners).colwise() + X->translation();
  }

  /// Poses keep their orientation: what is mirrored at all axes differs from one that is mirrored at one by a turn.
  void mirror(Eigen::Matrix3Xd& points) const {
    if (!sees_poses()) points = -points;
    else points.colwise() -= Eigen::Vector3d(2 * points.col(0));
  }

  /// Poses go of which no reading is left.
  static void shift(std::vector<SeenPoints>& seen, int late, std::size_t first) {
    const auto by = std::size_t(std::abs(late));
    if (late > 0) {
      for (std::size_t i = first; i + by < seen.size(); ++i) seen[i].points = seen[i + by].points;
      seen.resize(seen.size() - by);
    }
    if (late < 0) {
      for (std::size_t i = seen.size() - 1; i >= first + by; --i) seen[i].points = seen[i - by].points;
      seen.erase(seen.begin() + std::ptrdiff_t(first), seen.begin() + std::ptrdiff_t(first + by));
    }
  }

  const Problem& problem_;
  const IdentificationModel& model_;
  std::vector<Row> rows_;
  Eigen::Isometry3d base_ = Eigen::Isometry3d::Identity();
};

/// Hypotheses nearly as good as the best, for each remedy the first one of the table.
void keep_best(std::vector<Convention>& found) {
  double best = std::numeric_limits<double>::infinity();
  for (const Convention& c : found) best = std::min(best, c.left);
  std::vector<Convention> kept;
  for (Convention& c : found) {
    const auto alike = [&](const Convention& other) { return other.remedy == c.remedy; };
    if (c.left <= as_good * best && std::ranges::none_of(kept, alike)) kept.push_back(std::move(c));
  }
  found = std::move(kept);
}

}  // namespace

ConventionSearch find_conventions(const Problem& problem, const IdentificationModel& model,
                                  const std::vector<MeasuredPose>& poses, const OrientationForm& form) {
  const Search search(problem, model, poses);
  ConventionSearch result;
  if (!search.sees_places()) return result;
  result.left = search.left({}).rms;
  for (const Hypothesis& hypothesis : search.table(form)) {
    const HandEye fit = search.left(hypothesis);
    // Where all lengths shrink to nothing, so does what is left of them.
    const double left = fit.rms / std::min(fit.scale, 1.0);
    if (!(left * falls_by < result.left)) continue;
    Convention found = hypothesis.free_scale ? scaled(fit.scale, search.measurement())
                                             : Convention{hypothesis.condition, hypothesis.remedy};
    found.left = left;
    result.found.push_back(std::move(found));
  }
  keep_best(result.found);
  return result;
}

}  // namespace posewright
