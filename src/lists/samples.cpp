#include "posewright/lists/samples.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "orientation_columns.hpp"
#include "posewright/controller/yaml_document.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/text.hpp"

// Forms: easy_handeye2's tests/data/easy_handeye2_demo_eih.samples (transforms as x, y, z and x, y, z, w; where the
// camera stands at the base, `robot` is the base in the tip), MoveIt Calibration's samples (4 × 4, row by row), and
// arguments of OpenCV's calibrateHandEye or calibrateRobotWorldHandEye in a cv::FileStorage, under their names.

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

void require_rotation(const Document& document, const YAML::Node& node, const Eigen::Matrix3d& R,
                      const std::string& expected) {
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 && R.determinant() > 0))
    document.fail(node, "is not a rotation", expected);
}

std::optional<Eigen::Isometry3d> matrix_of(const Document& document, const YAML::Node& node) {
  const std::vector<double> m = document.numbers(node, "the matrix");
  if (m.size() != 16) document.fail(node, fmt::format("has {} numbers", m.size()), "16 of a 4 x 4 matrix, row by row");
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) X.matrix()(i, j) = m[std::size_t(4 * i + j)];
  require_rotation(document, node, X.linear(), "a pose is expected: 4 x 4, row by row, the last row 0 0 0 1");
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
  const YAML::Node list = document.at(root, "samples");
  const YAML::Node parameters = root["parameters"];
  if (parameters.IsDefined() && parameters.IsMap() && parameters["calibration_type"].IsDefined()) {
    const YAML::Node type = parameters["calibration_type"];
    const std::string name = document.text(type, "calibration_type");
    if (name != "eye_in_hand" && name != "eye_on_base")
      document.fail(type, "calibration_type is " + in_quotes(name), "eye_in_hand or eye_on_base");
    table.samples.on_hand = name == "eye_in_hand";
  }
  for (const YAML::Node& sample : document.items(list, "samples")) {
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

/// The matrices of one argument, each as its numbers row by row: a list of matrices, one array with a matrix a row, or
/// one of three dimensions.
struct CvMatrices {
  YAML::Node node;
  std::vector<std::vector<double>> numbers;
};
CvMatrices cv_matrices(const Document& document, const YAML::Node& root, const std::string& name) {
  CvMatrices found{document.at(root, name), {}};
  if (found.node.IsSequence()) {
    for (const YAML::Node& item : document.items(found.node, name))
      found.numbers.push_back(document.numbers(document.at(item, "data"), "data"));
    return found;
  }
  const std::vector<double> all = document.numbers(document.at(found.node, "data"), "data");
  const YAML::Node sizes = found.node["sizes"];
  const double count = sizes.IsDefined() ? document.numbers(sizes, "sizes").front()
                                         : document.number(document.at(found.node, "rows"), "rows");
  const std::size_t matrices = count >= 1 && count <= double(all.size()) ? std::size_t(count) : 0;
  if (matrices == 0 || all.size() % matrices != 0)
    document.fail(found.node, fmt::format("{} has {} numbers for {} matrices", name, all.size(), count),
                  "as many for each");
  const std::size_t each = all.size() / matrices;
  for (std::size_t i = 0; i < all.size(); i += each)
    found.numbers.emplace_back(all.begin() + std::ptrdiff_t(i), all.begin() + std::ptrdiff_t(i + each));
  return found;
}

/// Poses by their rotations (3 × 3 or rotation vectors) and translations.
std::vector<Eigen::Isometry3d> cv_poses(const Document& document, const YAML::Node& root, const std::string& of) {
  const CvMatrices turns = cv_matrices(document, root, "R_" + of), places = cv_matrices(document, root, "t_" + of);
  if (turns.numbers.size() != places.numbers.size())
    document.fail(
        places.node,
        fmt::format("t_{} has {} matrices and R_{} has {}", of, places.numbers.size(), of, turns.numbers.size()),
        "as many of both");
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < turns.numbers.size(); ++i) {
    const std::vector<double>&turn = turns.numbers[i], &place = places.numbers[i];
    if ((turn.size() != 9 && turn.size() != 3) || place.size() != 3)
      document.fail(
          turns.node,
          fmt::format("R_{} and t_{} number {} have {} and {} numbers", of, of, i + 1, turn.size(), place.size()),
          "9 (or 3 of a rotation vector) and 3");
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    if (turn.size() == 3) {
      X.linear() = rotation_by(Eigen::Vector3d(turn.data()));
    } else {
      X.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(turn.data());
      require_rotation(document, turns.node, X.linear(),
                       fmt::format("number {} of R_{} is 3 x 3, row by row", i + 1, of));
    }
    X.translation() = Eigen::Vector3d(place.data());
    poses.push_back(X);
  }
  return poses;
}

Samples of_opencv(const Document& document, const YAML::Node& root) {
  const bool world = root["R_world2cam"].IsDefined(), tip_in_base = root["R_gripper2base"].IsDefined();
  const std::vector<Eigen::Isometry3d> robot = cv_poses(document, root, tip_in_base ? "gripper2base" : "base2gripper"),
                                       seen = cv_poses(document, root, world ? "world2cam" : "target2cam");
  if (robot.size() != seen.size())
    document.fail(root, fmt::format("has {} poses of the robot and {} of the target", robot.size(), seen.size()),
                  "as many of both");
  SampleTable table;
  for (std::size_t i = 0; i < robot.size(); ++i)
    table.add(document.line(root), tip_in_base ? robot[i] : robot[i].inverse(), seen[i]);
  return std::move(table.samples);
}

/// What a text of the kind has in it, and the reader; a new kind is one row.
struct SampleForm {
  bool (*is)(const std::string& text);
  Samples (*read)(const Document& document, const YAML::Node& root);
};
bool has(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }
constexpr SampleForm sample_forms[] = {
    {[](const std::string& text) { return has(text, "effector_wrt_world"); }, of_moveit},
    {[](const std::string& text) { return has(text, "R_gripper2base") || has(text, "R_base2gripper"); }, of_opencv},
    {[](const std::string& text) { return has(text, "samples:") && has(text, "tracking:"); }, of_easy_handeye2},
};

}  // namespace

std::optional<Samples> read_samples(const std::string& text, const std::string& file) {
  for (const SampleForm& form : sample_forms) {
    if (!form.is(text)) continue;
    // OpenCV begins with %YAML:1.0, which is no directive of YAML.
    std::string yaml = text;
    if (yaml.starts_with("%YAML:")) yaml[0] = '#';
    try {
      return form.read(Document(file), YAML::Load(yaml));
    } catch (const YAML::Exception& error) {
      throw InputError({file, std::max(error.mark.line + 1, 0)}, "is not valid YAML: " + in_quotes(error.msg), "");
    }
  }
  return std::nullopt;
}

PoseTable samples_or_csv(const std::string& text, const std::string& file) {
  if (std::optional<Samples> samples = read_samples(text, file)) return std::move(samples->table);
  return read_csv_table(text, file);
}

}  // namespace posewright
