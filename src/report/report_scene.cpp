#include "report_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"

namespace posewright {
namespace {

// Between two pictures a joint turns by no more than this (rad; m), unless there would be too many of them.
constexpr double turn_step = 0.15, slide_step = 0.05;
constexpr double most_keyframes = 600;
constexpr double same_stop = 1e-9;  // rad, m

/// One overload a shape.
struct Fill {
  ReportBody& body;
  const TriangleMesh& mesh;
  void operator()(const BoxShape& s) const {
    body.shape = ReportBody::Shape::box;
    body.size = s.size;
  }
  void operator()(const CylinderShape& s) const {
    body.shape = ReportBody::Shape::cylinder;
    body.radius = s.radius;
    body.length = s.length;
  }
  void operator()(const SphereShape& s) const {
    body.shape = ReportBody::Shape::sphere;
    body.radius = s.radius;
  }
  void operator()(const HalfSpaceShape& s) const {
    body.shape = ReportBody::Shape::plane;
    body.size = s.normal;
  }
  void operator()(const std::shared_ptr<const TrianglesShape>&) const { (*this)(MeshShape{}); }
  void operator()(const MeshShape&) const {
    body.shape = ReportBody::Shape::mesh;
    body.vertices = mesh.vertices;
    body.triangles = mesh.triangles;
  }
};

class MotionRecorder {
 public:
  MotionRecorder(Report& report, const Drawing& drawing, const std::vector<Coordinate>& coordinates)
      : report_(report), drawing_(drawing), coordinates_(coordinates) {}

  void show(std::optional<int> pose, std::span<const double> q) {
    ReportKeyframe keyframe = keyframe_at(drawing_, q);
    keyframe.pose = pose;
    keyframe.seconds = seconds_;
    report_.keyframes.push_back(std::move(keyframe));
  }

  void play(const nlohmann::json& route, const std::vector<std::pair<int, std::vector<double>>>& poses) {
    for (const auto& name : route.at("names")) {
      const auto at = std::find_if(coordinates_.begin(), coordinates_.end(),
                                   [&](const Coordinate& c) { return c.name == name.get<std::string>(); });
      if (at == coordinates_.end()) throw std::invalid_argument("no coordinate " + name.get<std::string>());
      places_.push_back(std::size_t(at - coordinates_.begin()));
    }
    for (const auto& stop : route.at("poses")) require_same(stop, poses);
    const std::size_t stops = route.at("poses").size();
    const nlohmann::json& all = route.at("seconds");
    // The file has the sums alone: every stop takes its share, and the last keyframe is at the time of the whole route.
    const double still = stops > 0 ? (all.at("settle").get<double>() + all.value("reading", 0.0)) / double(stops) : 0.0;
    choose_step(route);
    if (const nlohmann::json& motions = route.at("motions"); !motions.empty()) {
      const int first = motions.front().at("from").get<int>();
      show(first, with(base(poses, first), motions.front().at("points").front().get<std::vector<double>>()));
      if (first > 0) seconds_ += still;
      for (const nlohmann::json& motion : motions) {
        move(motion, base(poses, motion.at("to").get<int>()));
        seconds_ += still;
      }
    } else {
      for (const auto& id : route.at("order")) show(id.get<int>(), base(poses, id.get<int>()));
    }
  }

 private:
  /// A stop of the route is where the plan's pose of that id is; joints may stand on another turn.
  void require_same(const nlohmann::json& stop, const std::vector<std::pair<int, std::vector<double>>>& poses) const {
    const int id = stop.at("id").get<int>();
    const std::vector<double>& q = base(poses, id);
    std::size_t k = 0;
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      if (coordinates_[i].choice()) continue;
      const double off = stop.at("configuration").at(k++).get<double>() - q[i];
      if (!(std::abs(coordinates_[i].unit == "rad" ? std::remainder(off, 2 * std::numbers::pi) : off) < same_stop))
        throw std::invalid_argument("pose " + std::to_string(id) + " is elsewhere");
    }
  }

  /// Whole configuration of a pose; of home, whose choices show nothing, that of the first one.
  static const std::vector<double>& base(const std::vector<std::pair<int, std::vector<double>>>& poses, int id) {
    for (const auto& [own, q] : poses)
      if (own == id || id == 0) return q;
    throw std::invalid_argument("no pose " + std::to_string(id));
  }

  std::vector<double> with(std::vector<double> q, const std::vector<double>& moving) const {
    if (moving.size() != places_.size()) throw std::invalid_argument("a point of another length");
    for (std::size_t i = 0; i < moving.size(); ++i) q[places_[i]] = moving[i];
    return q;
  }

  /// Steps that the way between two points needs, at steps of the standard length times `coarse_`.
  double steps(const nlohmann::json& from, const nlohmann::json& to) const {
    double most = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const double way = std::abs(to.at(i).get<double>() - from.at(i).get<double>());
      most = std::max(most, way / (coordinates_[places_[i]].unit == "m" ? slide_step : turn_step));
    }
    return std::ceil(std::max(1.0, most / coarse_));
  }

  void choose_step(const nlohmann::json& route) {
    double count = 0;
    for (const nlohmann::json& motion : route.at("motions"))
      for (std::size_t k = 1; k < motion.at("points").size(); ++k)
        count += steps(motion.at("points")[k - 1], motion.at("points")[k]);
    coarse_ = std::max(1.0, count / most_keyframes);
  }

  void move(const nlohmann::json& motion, const std::vector<double>& q) {
    seconds_ += motion.at("change_seconds").get<double>();
    const nlohmann::json& points = motion.at("points");
    double all = 0, done = 0;
    for (std::size_t k = 1; k < points.size(); ++k) all += steps(points[k - 1], points[k]);
    const double begin = seconds_, length = motion.at("seconds").get<double>();
    for (std::size_t k = 1; k < points.size(); ++k) {
      const auto from = points[k - 1].get<std::vector<double>>(), to = points[k].get<std::vector<double>>();
      const int count = int(steps(points[k - 1], points[k]));
      for (int s = 1; s <= count; ++s) {
        std::vector<double> between(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) between[i] = from[i] + (to[i] - from[i]) * s / count;
        seconds_ = begin + length * ++done / all;
        const bool arrived = s == count && k + 1 == points.size();
        show(arrived ? std::optional(motion.at("to").get<int>()) : std::nullopt, with(q, between));
      }
    }
  }

  Report& report_;
  const Drawing& drawing_;
  const std::vector<Coordinate>& coordinates_;
  std::vector<std::size_t> places_;
  double seconds_ = 0.0, coarse_ = 1.0;
};

ReportCamera camera_of(const DrawnCamera& drawn) {
  return {drawn.instrument,
          drawn.with,
          drawn.camera.frame,
          drawn.board.frame,
          drawn.camera.X_FrameThing,
          drawn.board.X_FrameThing,
          drawn.image.width,
          drawn.image.height,
          drawn.image.corners,
          drawn.points,
          {}};
}

}  // namespace

ReportKeyframe keyframe_at(const Drawing& drawing, std::span<const double> q) {
  DrawnPose drawn = drawing.at(q);
  return {std::nullopt,
          0.0,
          std::move(drawn.frames),
          std::move(drawn.lines),
          drawn.tip,
          std::move(drawn.targets),
          std::move(drawn.instrument)};
}

std::vector<Eigen::Vector2d> predicted_pixels(const IdentificationModel& model, const std::string& instrument,
                                              std::size_t count, std::span<const double> q) {
  Eigen::VectorXd pixels;
  std::vector<Eigen::Vector2d> points;
  if (!model.predict(q, {}, pixels)) return points;
  // Readings of a list are those of all instruments, one after the other.
  const auto first = std::ranges::find_if(model.readings(), [&](const Reading& reading) {
    return instrument.empty() || reading.name.starts_with(instrument + ".");
  });
  const auto at = Eigen::Index(first - model.readings().begin());
  if (std::isnan(pixels[at])) return points;
  for (Eigen::Index k = at; k < at + 2 * Eigen::Index(count); k += 2) points.emplace_back(pixels[k], pixels[k + 1]);
  return points;
}

void fill_scene(Report& report, const Drawing& drawing, const std::vector<std::pair<int, std::vector<double>>>& poses,
                const std::vector<Coordinate>& coordinates, const std::filesystem::path& route_file) {
  if (!drawing.warning().empty()) report.notes.push_back(drawing.warning());
  if (!drawing.robot().empty()) report.title = drawing.robot();
  report.frames = drawing.frames();
  report.cell_frame = drawing.cell().frame;
  report.X_FrameCell = drawing.cell().X_FrameRoot;
  for (const DrawnStation& s : drawing.stations())
    report.stations.push_back({s.instrument, s.name, s.X_MeasureStation});
  report.targets = drawing.targets();
  for (const DrawnBody& drawn : drawing.bodies()) {
    ReportBody body{drawn.name, drawn.kind, drawn.colour, drawn.frame, drawn.X_FrameBody};
    std::visit(Fill{body, drawn.mesh}, drawn.shape);
    report.bodies.push_back(std::move(body));
  }
  for (const DrawnCamera& camera : drawing.cameras()) report.cameras.push_back(camera_of(camera));
  MotionRecorder film(report, drawing, coordinates);
  if (report.route_json.empty()) {
    for (const auto& [id, q] : poses) film.show(id, q);
    return;
  }
  try {
    film.play(parse_json(report.route_json), poses);
  } catch (const nlohmann::json::exception&) {
    throw InputError({route_file.string(), 0}, "is not a route", "route.json as posewright writes it");
  } catch (const std::invalid_argument& error) {
    throw InputError({route_file.string(), 0}, std::string("does not fit the plan: ") + error.what(),
                     "a route of the same plan");
  }
}

}  // namespace posewright
