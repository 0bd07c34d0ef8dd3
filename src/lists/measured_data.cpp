#include "posewright/lists/measured_data.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "measured_columns.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/instrument_view.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

/// Rows of a file of readings that look like no reading: a lost target as 0, 0, 0, a code such as −9999 for nothing,
/// the numbers of an earlier row again, an id that another configuration has.
class SuspiciousRows {
 public:
  explicit SuspiciousRows(const IdentificationModel& model) : model_(model) {}

  /// @param id  0: the row has none
  /// @param y   SI, NaN: not read
  void add(int id, int line, const std::vector<double>& q, const Eigen::VectorXd& y);
  /// One for each kind that was found, with the lines.
  std::vector<std::string> notes(const std::string& file) const;

 private:
  void look_for_codes(int line, const Eigen::VectorXd& y);
  void look_for_copies(int line, const std::vector<double>& q, const Eigen::VectorXd& y);
  bool moved(const std::vector<double>& from, const std::vector<double>& to) const;

  const IdentificationModel& model_;
  std::map<std::string, std::vector<int>> lines_;                                ///< of each kind
  std::map<int, std::vector<double>> configurations_;                            ///< of each id
  std::multimap<double, std::pair<std::vector<double>, Eigen::VectorXd>> rows_;  ///< by the sum of their readings
};

constexpr std::size_t most_lines = 5;
// Encoders jitter: rad and m that one configuration's rows differ by, and those of one that is called by its id.
constexpr double jitter = 1e-5, jitter_of_one_id = 1e-3;

/// Values that instruments write for no reading, in m and in mm.
bool is_code(double value) {
  for (const double code : {9999.0, 99999.0})
    for (const double unit : {1.0, 1e-3})
      if (std::abs(std::abs(value) - code * unit) < 1e-12 * code) return true;
  return false;
}

bool same_numbers(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size() || !a.array().isFinite().any()) return false;
  for (Eigen::Index i = 0; i < a.size(); ++i)
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
  return true;
}

bool SuspiciousRows::moved(const std::vector<double>& from, const std::vector<double>& to) const {
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!model_.coordinates()[i].discrete() && std::abs(from[i] - to[i]) > jitter_of_one_id) return true;
  return false;
}

void SuspiciousRows::look_for_codes(int line, const Eigen::VectorXd& y) {
  if (std::any_of(y.begin(), y.end(), is_code))
    lines_["9999 stands for no reading? Leave its cell empty"].push_back(line);
  const Eigen::Index size =
      model_.rows_per_target() > 0 ? model_.rows_per_target() : std::min<Eigen::Index>(3, y.size());
  for (Eigen::Index first = 0; first + size <= y.size(); first += size) {
    if (size > 1 && (y.segment(first, size).array() == 0.0).all()) {
      lines_["a target is read as 0: was it lost? Leave its cells empty"].push_back(line);
      return;
    }
    if (model_.rows_per_target() == 0) return;
  }
}

/// Some readings of noise are never the same to the last digit; one or two are, as of a touch or a gauge.
void SuspiciousRows::look_for_copies(int line, const std::vector<double>& q, const Eigen::VectorXd& y) {
  if (y.array().isFinite().count() < 3) return;
  double sum = 0;
  for (const double value : y)
    if (std::isfinite(value)) sum += value;
  const auto [first, last] = rows_.equal_range(sum);
  for (auto at = first; at != last; ++at) {
    const auto& [joints, readings] = at->second;
    if (!same_numbers(readings, y)) continue;
    lines_[moved(joints, q) ? "the readings of an earlier row, at other joints: was the instrument read again?"
                            : "the readings of an earlier row, to the last digit: leave it out if it is a copy"]
        .push_back(line);
    return;
  }
  rows_.emplace(sum, std::pair(q, y));
}

void SuspiciousRows::add(int id, int line, const std::vector<double>& q, const Eigen::VectorXd& y) {
  look_for_codes(line, y);
  look_for_copies(line, q, y);
  if (id > 0) {
    const auto [known, added] = configurations_.emplace(id, q);
    if (!added && moved(known->second, q)) lines_["an id that another configuration has"].push_back(line);
  }
}

std::vector<std::string> SuspiciousRows::notes(const std::string& file) const {
  std::vector<std::string> notes;
  for (const auto& [kind, lines] : lines_) {
    std::string note = file;
    for (std::size_t k = 0; k < std::min(most_lines, lines.size()); ++k)
      note += fmt::format("{}{}", k == 0 ? ":" : ", ", lines[k]);
    if (lines.size() > most_lines) note += fmt::format(" and {} more rows", lines.size() - most_lines);
    notes.push_back(note + ": " + kind);
  }
  return notes;
}

constexpr std::uintmax_t data_size_limit = 1'000'000'000;

/// One row of the file, in SI.
struct Row {
  int id = 0, line = 0;
  bool held_back = false;
  std::vector<double> q;
  Eigen::VectorXd y;
};

/// True if rows are readings of one configuration.
bool repeats(const std::vector<Coordinate>& coordinates, const Row& a, const Row& b) {
  const double allowed = a.id > 0 && a.id == b.id ? jitter_of_one_id : jitter;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (std::abs(a.q[i] - b.q[i]) > (coordinates[i].discrete() ? 0.0 : allowed)) return false;
  return a.held_back == b.held_back;
}

/// Rows of one configuration that follow each other become one pose with their mean.
class ReadingAverages {
 public:
  /// @param measurement  says how many readings a row is the mean of where no configuration has several rows
  ReadingAverages(const IdentificationModel& model, const MeasurementSpec& measurement, MeasuredData& data)
      : model_(model), measurement_(measurement), data_(data) {
    squares_.setZero(Eigen::Index(model.readings().size()));
    counts_ = squares_;
  }

  void add(Row row) {
    if (!group_.empty() && !repeats(model_.coordinates(), group_.front(), row)) close();
    group_.push_back(std::move(row));
  }

  void finish() {
    if (!group_.empty()) close();
    data_.repeats = double(data_.poses.size()) / inverse_repeats_;
    if (data_.repeated.empty()) {
      for (MeasuredPose& pose : data_.poses) pose.reading_share.resize(0, 0);
      return;
    }
    for (Eigen::Index i = 0; i < squares_.size(); ++i)
      data_.spread.push_back(counts_[i] > 0 ? std::sqrt(squares_[i] / counts_[i])
                                            : std::numeric_limits<double>::quiet_NaN());
  }

 private:
  void close() {
    inverse_repeats_ += 1.0 / double(group_.size());
    if (data_.poses.empty()) first_rows_ = group_.size();
    data_.same_repeats = data_.same_repeats && group_.size() == first_rows_;
    const int id = group_.front().id > 0 ? group_.front().id : int(data_.poses.size()) + 1;
    MeasuredPose pose{id, mean_configuration(), group_.size() == 1 ? group_.front().y : mean()};
    share_readings(pose);
    data_.poses.push_back(std::move(pose));
    data_.lines.push_back(group_.front().line);
    data_.held_back.push_back(group_.front().held_back);
    group_.clear();
  }

  /// Mean coordinates of averaged rows, so that encoders' jitter does not count as the robot's error.
  std::vector<double> mean_configuration() const {
    std::vector<double> q = group_.front().q;
    for (const Row& row : group_)
      for (std::size_t i = 0; i < q.size(); ++i) q[i] += (row.q[i] - group_.front().q[i]) / double(group_.size());
    return q;
  }

  /// A row of which all was read, so that orientations have something to be relative to; else the first.
  const Eigen::VectorXd& reference() const {
    const auto whole = std::find_if(group_.begin(), group_.end(), [](const Row& row) { return row.y.allFinite(); });
    return whole == group_.end() ? group_.front().y : whole->y;
  }

  Eigen::VectorXd mean() {
    const Eigen::VectorXd& first = reference();
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(first.size()), number = sum, change, mean;
    for (const Row& row : group_) {
      model_.difference(row.y, first, change);
      for (Eigen::Index i = 0; i < sum.size(); ++i)
        if (std::isfinite(change[i])) {
          sum[i] += change[i];
          number[i] += 1;
        }
    }
    model_.shifted(first, sum.cwiseQuotient(number), mean);
    for (Eigen::Index i = 0; i < sum.size(); ++i)
      if (!std::isfinite(mean[i]) && model_.readings()[std::size_t(i)].name.find("pose.r") == std::string::npos)
        mean[i] = plain_mean(i);
    add_spread(mean);
    return mean;
  }

  void add_spread(const Eigen::VectorXd& mean) {
    Eigen::VectorXd change, number = Eigen::VectorXd::Zero(mean.size());
    RepeatedReadings visit{mean_configuration(), Eigen::MatrixXd(mean.size(), Eigen::Index(group_.size()))};
    for (const Row& row : group_) {
      model_.difference(row.y, mean, change);
      visit.deviations.col(&row - group_.data()) = change;
      for (Eigen::Index i = 0; i < mean.size(); ++i)
        if (std::isfinite(change[i])) {
          squares_[i] += change[i] * change[i];
          number[i] += 1;
        }
    }
    counts_ += (number.array() - 1).max(0).matrix();
    data_.repeated.push_back(std::move(visit));
  }

  /// Numbers of rows behind each reading, and behind each pair of readings.
  void share_readings(MeasuredPose& pose) const {
    const Eigen::Index all = pose.y.size();
    Eigen::MatrixXd was_read(all, Eigen::Index(group_.size()));
    for (const Row& row : group_)
      was_read.col(&row - group_.data()) =
          row.y.array().isFinite().cast<double>() * pose.y.array().isFinite().cast<double>();
    const Eigen::MatrixXd together = was_read * was_read.transpose();
    const Eigen::VectorXd alone = together.diagonal().cwiseMax(1.0);
    const int repeats = instrument_at(measurement_, model_.coordinates(), pose.q).repeats;
    if ((together.array() == double(repeats)).all()) return;
    pose.reading_share = repeats * together.cwiseQuotient(alone * alone.transpose());
  }

  double plain_mean(Eigen::Index i) const {
    double sum = 0;
    int number = 0;
    for (const Row& row : group_)
      if (std::isfinite(row.y[i])) {
        sum += row.y[i];
        ++number;
      }
    return number > 0 ? sum / number : std::numeric_limits<double>::quiet_NaN();
  }

  const IdentificationModel& model_;
  const MeasurementSpec& measurement_;
  MeasuredData& data_;
  std::vector<Row> group_;
  Eigen::VectorXd squares_, counts_;
  double inverse_repeats_ = 0.0;
  std::size_t first_rows_ = 0;
};

int id_of(const std::string& cell, const SourcePlace& place) {
  int id = 0;
  const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), id);
  if (code != std::errc() || end != cell.data() + cell.size() || id < 1)
    throw InputError(place, "id '" + cell.substr(0, 40) + "'", "a whole number above 0 is expected");
  return id;
}

/// A row of a list's instrument has no readings of another one.
void require_own_readings(const Row& row, const MeasurementSpec& measurement, const IdentificationModel& model,
                          const SourcePlace& place) {
  if (instruments_of(measurement) == nullptr) return;
  Eigen::VectorXd own = row.y;
  model.blank_hidden(row.q, own);
  for (Eigen::Index i = 0; i < own.size(); ++i)
    if (std::isfinite(row.y[i]) && !std::isfinite(own[i]))
      throw InputError(
          place,
          fmt::format("has a value of '{}' in a row of instrument '{}'", model.readings()[std::size_t(i)].name,
                      instrument_at(measurement, model.coordinates(), row.q).name),
          "a row for each instrument, the cells of the others empty");
}

bool held_back(const std::string& cell, const SourcePlace& place) {
  if (cell == "validate") return true;
  if (cell != "fit") throw InputError(place, "use '" + cell.substr(0, 40) + "'", "allowed: fit, validate");
  return false;
}

/// The image of one row; nothing if a point is missing or the pose is out of reach.
std::optional<PlatformImage> image_of(const MeasuredColumns& columns, int row, const Row& read,
                                      const PlatformPoints& points, const IdentificationModel& model) {
  PlatformImage image;
  image.id = read.id > 0 ? read.id : row + 1;
  for (const TargetSpec& target : points.body) image.body.push_back(columns.point(row, target.name));
  for (const std::string& joint : points.joints) image.joints.push_back(columns.point(row, joint));
  for (const auto* list : {&image.body, &image.joints})
    for (const Eigen::Vector3d& p : *list)
      if (!p.allFinite()) return std::nullopt;
  image.actuators = actuator_moves(model, read.q);
  if (image.actuators.size() == 0) return std::nullopt;
  return image;
}

}  // namespace

MeasuredData read_measured_data(const std::filesystem::path& file, const Problem& problem,
                                const IdentificationModel& model) {
  return parse_measured_data(read_text(file, data_size_limit), file, problem, model);
}

MeasuredData parse_measured_data(const std::string& text, const std::filesystem::path& file, const Problem& problem,
                                 const IdentificationModel& model) {
  const MeasuredColumns columns(text, file.string(), problem.measurement, model);
  MeasuredData data;
  data.notes = columns.notes();
  data.rows = columns.rows();
  data.orientation = columns.orientation();
  ReadingAverages averaging(model, problem.measurement, data);
  SuspiciousRows suspicious(model);
  const std::optional<PlatformPoints> platform = platform_points(problem.robot, problem.measurement, model);
  for (int i = 0; i < columns.rows(); ++i) {
    Row row;
    row.line = columns.line(i);
    const SourcePlace place{file.string(), row.line};
    row.id = columns.text(i, "id").empty() ? 0 : id_of(columns.text(i, "id"), place);
    row.held_back = !columns.text(i, "use").empty() && held_back(columns.text(i, "use"), place);
    row.q = columns.configuration(i);
    row.y = columns.readings(i);
    require_own_readings(row, problem.measurement, model, place);
    if (!row.y.array().isFinite().any()) {
      data.notes.push_back(
          fmt::format("{}:{}: no target was read completely; the row is left out", file.string(), row.line));
      --data.rows;
      continue;
    }
    // Joined tips read 0 at all joints.
    const bool joined = joins_tips(instrument_at(problem.measurement, model.coordinates(), row.q));
    suspicious.add(row.id, row.line, row.q, joined ? Eigen::VectorXd::Constant(row.y.size(), std::nan("")) : row.y);
    if (platform)
      if (std::optional<PlatformImage> image = image_of(columns, i, row, *platform, model))
        data.images.push_back(std::move(*image));
    averaging.add(std::move(row));
  }
  if (data.rows == 0) throw InputError({file.string(), 0}, "has no readings", "at least one line with some");
  averaging.finish();
  std::ranges::move(suspicious.notes(file.string()), std::back_inserter(data.notes));
  return data;
}

std::string measured_data_csv(const IdentificationModel& model, const std::vector<MeasuredPose>& poses) {
  std::string text = "id";
  for (const Coordinate& c : model.coordinates())
    text += c.choice() ? "," + c.name : fmt::format(",{} [{}]", c.name, c.unit);
  for (const Reading& reading : model.readings())
    text += reading.unit == "px" ? "," + reading.name : fmt::format(",{} [{}]", reading.name, reading.unit);
  text += "\n";
  for (const MeasuredPose& pose : poses) {
    text += std::to_string(pose.id);
    for (std::size_t i = 0; i < pose.q.size(); ++i) {
      const Coordinate& c = model.coordinates()[i];
      text += c.choice() ? "," + c.label_at(pose.q[i]) : fmt::format(",{}", pose.q[i]);
    }
    for (const double value : pose.y) text += std::isfinite(value) ? fmt::format(",{}", value) : ",";
    text += "\n";
  }
  return text;
}

std::optional<PlatformPoints> platform_points(const RobotSpec& robot, const MeasurementSpec& measurement,
                                              const IdentificationModel& model) {
  if (std::get_if<SixLegsSpec>(&robot) == nullptr) return std::nullopt;
  const InstrumentView view = view_of(measurement);
  if (!view.point_noise) return std::nullopt;  // another at every distance: no single shape's
  PlatformPoints points{view.targets, *view.point_noise, {}};
  if (points.body.size() < 3) return std::nullopt;
  for (const Coordinate& actuator : model.actuators())
    points.joints.push_back(actuator.name.substr(0, actuator.name.rfind('.')));
  return points;
}

Eigen::VectorXd actuator_moves(const IdentificationModel& model, const std::vector<double>& q) {
  const auto legs = model.actuators().size();
  std::vector<double> at(legs), reference(legs);
  const std::vector<double> zero(model.coordinates().size(), 0.0);
  if (!model.actuator_values(q, at) || !model.actuator_values(zero, reference)) return {};
  return Eigen::Map<const Eigen::VectorXd>(at.data(), Eigen::Index(legs)) -
         Eigen::Map<const Eigen::VectorXd>(reference.data(), Eigen::Index(legs));
}

}  // namespace posewright
