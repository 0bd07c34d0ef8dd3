#include "posewright/lists/samples.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "orientation_columns.hpp"
#include "posewright/controller/yaml_document.hpp"
#include "posewright/support/text.hpp"

// Forms: easy_handeye2's tests/data/easy_handeye2_demo_eih.samples (transforms as x, y, z and x, y, z, w; where the
// camera stands at the base, `robot` is the base in the tip), and MoveIt Calibration's samples (4 × 4, row by row).

namespace posewright {
namespace {

using yaml::Document;

/// A pose that was not measured is written as .nan.
bool is_unmeasured(const YAML::Node& number) {
  return number.IsScalar() && (number.Scalar() == ".nan" || number.Scalar() == "nan" || number.Scalar() == ".NaN");
}

std::optional<Eigen::Isometry3d> transform_of(const Document& document, const YAML::Node& node) {
  Eigen::Vector3d p;
  Eigen::Vector4d q;
  const YAML::Node translation = document.at(node, "translation"), rotation = document.at(node, "rotation");
  for (const int k : {0, 1, 2, 3}) {
    const std::string name(1, "xyzw"[k]);
    const YAML::Node turn = document.at(rotation, name);
    if (is_unmeasured(turn)) return std::nullopt;
    q[k] = document.number(turn, name);
    if (k == 3) continue;
    const YAML::Node place = document.at(translation, name);
    if (is_unmeasured(place)) return std::nullopt;
    p[k] = document.number(place, name);
  }
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = rotation_of_quaternion(q, document.place(rotation));
  X.translation() = p;
  return X;
}

std::optional<Eigen::Isometry3d> matrix_of(const Document& document, const YAML::Node& node) {
  const std::vector<double> m = document.numbers(node, "the matrix");
  if (m.size() != 16) document.fail(node, fmt::format("has {} numbers", m.size()), "16 of a 4 x 4 matrix, row by row");
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) X.matrix()(i, j) = m[std::size_t(4 * i + j)];
  const Eigen::Matrix3d R = X.linear();
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 && R.determinant() > 0))
    document.fail(node, "is not a rotation and a translation", "4 x 4, row by row, the last row 0 0 0 1");
  return X;
}

class SampleTable {
 public:
  SampleTable() {
    samples.table.names = {"id"};
    for (const char* of : {"robot", "pose"})
      for (const char* end : {"x", "y", "z", "qx", "qy", "qz", "qw"})
        samples.table.names.push_back(std::string(of) + "." + end);
  }

  void add(int line, const Eigen::Isometry3d& robot, const std::optional<Eigen::Isometry3d>& seen) {
    PoseRow row;
    row.line = line;
    row.cells.emplace_back(std::to_string(samples.table.rows.size() + 1));
    put(row, robot);
    put(row, seen);
    samples.table.rows.push_back(std::move(row));
  }

  Samples samples;

 private:
  static void put(PoseRow& row, const std::optional<Eigen::Isometry3d>& X) {
    if (!X) {
      row.cells.insert(row.cells.end(), 7, std::string("nan"));
      return;
    }
    for (const double v : X->translation()) row.cells.emplace_back(fmt::format("{}", v));
    const Eigen::Quaterniond q(X->linear());
    for (const double v : q.coeffs()) row.cells.emplace_back(fmt::format("{}", v));
  }
};

Samples of_easy_handeye2(const Document& document, const YAML::Node& root) {
  SampleTable table;
  const YAML::Node parameters = root["parameters"];
  if (parameters.IsDefined() && parameters.IsMap() && parameters["calibration_type"].IsDefined()) {
    const YAML::Node type = parameters["calibration_type"];
    const std::string name = document.text(type, "calibration_type");
    if (name != "eye_in_hand" && name != "eye_on_base")
      document.fail(type, "calibration_type is " + in_quotes(name), "eye_in_hand or eye_on_base");
    table.samples.on_hand = name == "eye_in_hand";
  }
  for (const YAML::Node& sample : document.items(root["samples"], "samples")) {
    const std::optional<Eigen::Isometry3d> robot = transform_of(document, document.at(sample, "robot"));
    if (!robot) document.fail(sample, "the robot's pose is not a number", "numbers");
    table.add(document.line(sample), table.samples.on_hand.value_or(true) ? *robot : robot->inverse(),
              transform_of(document, document.at(sample, "tracking")));
  }
  return std::move(table.samples);
}

Samples of_moveit(const Document& document, const YAML::Node& root) {
  SampleTable table;
  for (const YAML::Node& sample : document.items(root, "samples"))
    table.add(document.line(sample), *matrix_of(document, document.at(sample, "effector_wrt_world")),
              matrix_of(document, document.at(sample, "object_wrt_sensor")));
  return std::move(table.samples);
}

}  // namespace

std::optional<Samples> read_samples(const std::string& text, const std::string& file) {
  const bool easy = text.find("samples:") != std::string::npos && text.find("tracking:") != std::string::npos;
  const bool moveit = text.find("effector_wrt_world") != std::string::npos;
  if (!easy && !moveit) return std::nullopt;
  const Document document(file);
  try {
    const YAML::Node root = YAML::Load(text);
    if (moveit) return of_moveit(document, root);
    document.at(root, "samples");
    return of_easy_handeye2(document, root);
  } catch (const YAML::Exception& error) {
    throw InputError({file, std::max(error.mark.line + 1, 0)}, "is not valid YAML: " + in_quotes(error.msg), "");
  }
}

PoseTable samples_or_csv(const std::string& text, const std::string& file) {
  if (std::optional<Samples> samples = read_samples(text, file)) return std::move(samples->table);
  return read_csv_table(text, file);
}

}  // namespace posewright
