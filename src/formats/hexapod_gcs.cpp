#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

// Commands: PI MS204E (C-887), GCS 2.0. Rotations: PI H-850 manual MS202E, "Rotation": the rotational axes move with
// the platform and are applied in the order U, V, W, so R = Rx(U) Ry(V) Rz(W); translations are in fixed axes.

namespace posewright::formats {
namespace {

const std::array<const char*, 6> coordinates = {"x", "y", "z", "rx", "ry", "rz"};
const std::array<const char*, 6> hexapod_axes = {"X", "Y", "Z", "U", "V", "W"};
constexpr int decimals = 4;
// Rotations below this are none, rad.
constexpr double no_rotation = 1e-12;

void require_platform(const PoseSequence& sequence) {
  bool fits = sequence.names.size() == 6;
  for (std::size_t k = 0; fits && k < 6; ++k)
    fits = sequence.names[k] == coordinates[k] && sequence.units[k] == (k < 3 ? "m" : "rad");
  if (!fits)
    throw CannotDo(
        fmt::format("hexapod-gcs is for six-legged platforms with coordinates x, y, z, rx, ry, rz; the plan has {}",
                    fmt::join(sequence.names, ", ")));
  if (has_changes(sequence))
    throw CannotDo("hexapod-gcs: a list of commands cannot wait for a change of station or load case");
}

/// X, Y, Z in mm and U, V, W in degrees of the plan's Rz(rz) Ry(ry) Rx(rx).
std::array<double, 6> commanded(const std::vector<double>& q) {
  using Eigen::AngleAxisd;
  const Eigen::Matrix3d R = (AngleAxisd(q[5], Eigen::Vector3d::UnitZ()) * AngleAxisd(q[4], Eigen::Vector3d::UnitY()) *
                             AngleAxisd(q[3], Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  if (!(std::abs(R(0, 2)) < 1 - 1e-9))
    throw CannotDo("hexapod-gcs: a platform turned by 90 deg has no U, V, W of its own");
  const double u = std::atan2(-R(1, 2), R(2, 2)), v = std::asin(R(0, 2)), w = std::atan2(-R(0, 1), R(0, 0));
  return {q[0] * 1e3, q[1] * 1e3, q[2] * 1e3, to_degrees(u), to_degrees(v), to_degrees(w)};
}

/// True if the platform is turned at a pose, at home or on the way.
bool turns(const PoseSequence& sequence) {
  const auto turned = [](const std::vector<double>& q) {
    return std::any_of(q.begin() + 3, q.end(), [](double x) { return std::abs(x) > no_rotation; });
  };
  if (sequence.from_home && turned(sequence.home)) return true;
  for (const SequenceMotion& motion : sequence.motions)
    if (std::any_of(motion.points.begin(), motion.points.end(), turned)) return true;
  return std::any_of(sequence.poses.begin(), sequence.poses.end(),
                     [&](const SequencePose& pose) { return turned(pose.values); });
}

std::string move(const std::vector<double>& q) {
  std::string text = "MOV";
  const auto values = commanded(q);
  for (std::size_t k = 0; k < 6; ++k) text += fmt::format(" {} {}", hexapod_axes[k], fixed(values[k], decimals));
  return text + "\nONT?\n";
}

Exported write_hexapod_gcs(const PoseSequence& all, const ExportOptions& options) {
  const PoseSequence sequence = to_measure(all);
  require_platform(sequence);
  allow_settings(options.controller, "hexapod-gcs", {"pivot_mm"});
  if (turns(sequence) && !options.controller.pivot_mm)
    throw InputError({}, "hexapod-gcs needs pivot_mm: [R, S, T] in --controller FILE",
                     "the platform turns about the origin of the problem's platform frame; set the controller's pivot "
                     "to it (SPI), or the platform reaches other poses");
  std::string text = "SVO X 1 Y 1 Z 1 U 1 V 1 W 1\n";
  text += fmt::format("VLS {}\n", fixed(options.speed.value_or(10.0) / 10, 1));
  if (const auto& pivot = options.controller.pivot_mm)
    text += fmt::format("MOV X 0 Y 0 Z 0 U 0 V 0 W 0\nONT?\nSPI R {} S {} T {}\n", fixed((*pivot)[0], decimals),
                        fixed((*pivot)[1], decimals), fixed((*pivot)[2], decimals));
  if (sequence.from_home) text += move(sequence.home);
  const auto via = [&](std::size_t index) {
    if (index >= sequence.motions.size()) return;
    const auto& points = sequence.motions[index].points;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) text += move(points[i]);
  };
  for (std::size_t k = 0; k < sequence.poses.size(); ++k) {
    if (sequence.from_home || k > 0) via(k - (sequence.from_home ? 0 : 1));
    text += move(sequence.poses[k].values) + "POS?\n";
  }
  if (sequence.closed && !sequence.motions.empty()) {
    via(sequence.motions.size() - 1);
    text += move(sequence.from_home ? sequence.home : sequence.poses.front().values);
  }
  std::vector<std::string> notes = {
      "send line by line: repeat ONT? until all axes answer 1, measure at POS?; reference first (FRF)",
      "zero must be the platform's reference position, axes parallel to the problem's base frame"};
  if (!sequence.is_route) notes.push_back("the motions between the poses are not checked: `posewright route`");
  return one_file("calposes.gcs", text, notes);
}

}  // namespace

PoseFormat hexapod_gcs() {
  return {.name = "hexapod-gcs",
          .description = "PI GCS commands of a hexapod",
          .used_by = "PI C-887 and the like, through a host that polls",
          .extension = ".gcs",
          .needs = "a six-legged platform; pivot_mm in --controller where it turns",
          .write = write_hexapod_gcs,
          .options = {"speed", "controller"},
          .controller = true,
          .any_coordinates = true};
}

}  // namespace posewright::formats
