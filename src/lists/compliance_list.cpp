#include "posewright/lists/compliance_list.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

constexpr std::uintmax_t compliances_size_limit = 10'000'000;
constexpr std::uintmax_t longest_header = 100'000;
// Printed correlations have few digits.
constexpr double correlation_slack = 1e-3;

/// A table with the columns that are asked for.
class ComplianceTable {
 public:
  ComplianceTable(PoseTable table, std::string file) : table_(std::move(table)), file_(std::move(file)) {}

  std::size_t column(const std::string& name, const std::string& allowed) const {
    const auto found = std::find(table_.names.begin(), table_.names.end(), name);
    if (found == table_.names.end()) throw InputError({file_, table_.header}, "has no column '" + name + "'", allowed);
    return std::size_t(found - table_.names.begin());
  }

  double value(std::size_t row, std::size_t column, Quantity quantity) const {
    const PoseRow& line = table_.rows[row];
    const std::string* const written =
        column < line.cells.size() ? std::get_if<std::string>(&line.cells[column]) : nullptr;
    std::string cell = written != nullptr ? *written : "";
    const std::string unit = table_.units.empty() ? "" : table_.units[column];
    if (!unit.empty()) cell += " " + unit;
    try {
      return parse_value(cell, quantity);
    } catch (const InputError&) {
      throw InputError({file_, line.line}, "'" + cell + "' of '" + table_.names[column] + "' is not a value",
                       "a number; in the header, a unit: " + allowed_units({quantity}));
    }
  }

  double positive(std::size_t row, std::size_t column) const {
    const double number = value(row, column, Quantity::compliance);
    if (!(number > 0))
      throw InputError({file_, table_.rows[row].line}, "'" + table_.names[column] + "' is not positive",
                       "more than 0 rad/Nm");
    return number;
  }

  std::size_t rows() const { return table_.rows.size(); }
  bool has(const std::string& name) const {
    return std::find(table_.names.begin(), table_.names.end(), name) != table_.names.end();
  }
  SourcePlace line(std::size_t row) const { return {file_, table_.rows[row].line}; }

 private:
  PoseTable table_;
  std::string file_;
};

/// Correlations of the lines with one another; without columns of that name none.
Eigen::MatrixXd correlations(const ComplianceTable& table) {
  const auto n = Eigen::Index(table.rows());
  Eigen::MatrixXd R = Eigen::MatrixXd::Identity(n, n);
  if (!table.has("correlation_1")) return R;
  for (Eigen::Index j = 0; j < n; ++j) {
    const std::size_t column = table.column("correlation_" + std::to_string(j + 1), "one for every line");
    for (Eigen::Index i = 0; i < n; ++i) R(i, j) = table.value(std::size_t(i), column, Quantity::number);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      if (!(std::abs(R(i, j) - (i == j ? 1 : R(j, i))) < correlation_slack) || !(std::abs(R(i, j)) <= 1))
        throw InputError(table.line(std::size_t(i)), "this is not a matrix of correlations",
                         "symmetric, from -1 to 1, 1 of a line with itself");
  return R.selfadjointView<Eigen::Lower>();
}

}  // namespace

bool lists_compliances(const std::filesystem::path& file) {
  FileReader reader(file);
  std::string begin(std::min<std::uintmax_t>(reader.size(), longest_header), '\0');
  begin.resize(reader.read(begin.data(), begin.size()));
  std::size_t from = 0;
  while (from < begin.size() && begin[from] == '#') from = std::min(begin.find('\n', from), begin.size() - 1) + 1;
  for (const std::string& cell : csv_cells(begin.substr(from, begin.find('\n', from) - from)))
    if (cell == "compliance" || cell.starts_with("compliance ") || cell.starts_with("compliance[")) return true;
  return false;
}

ListedCompliances read_compliances(const std::string& bytes, const std::string& file, const std::string& joint) {
  const ComplianceTable table(read_csv_table(bytes, file), file);
  const std::size_t at = table.column(joint, "the joint's positions are needed");
  const std::size_t compliance = table.column("compliance", "compliances are needed");
  const std::size_t sigma =
      table.column("sigma", "compliances without covariance cannot be weighed: 1σ of each in a column sigma");
  ListedCompliances listed;
  const auto n = Eigen::Index(table.rows());
  listed.compliance.resize(n);
  Eigen::VectorXd sigmas(n);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    listed.at.push_back(table.value(row, at, Quantity::angle));
    listed.compliance[Eigen::Index(row)] = table.positive(row, compliance);
    sigmas[Eigen::Index(row)] = table.positive(row, sigma);
  }
  listed.covariance = sigmas.asDiagonal() * correlations(table) * sigmas.asDiagonal();
  return listed;
}

CompensatorConstants compensator_of_list(const RobotSpec& robot, const std::filesystem::path& file) {
  const auto* arm = std::get_if<SerialArmSpec>(&robot);
  if (arm == nullptr || !arm->elastostatic || !arm->elastostatic->derived_compensator)
    throw InputError({file.string(), 0}, "lists compliances, but the problem has no compensator that follows from them",
                     "elastostatic: compensator_from: compliances");
  const CompensatorSpec& geometry = *arm->elastostatic->derived_compensator;
  return compensator_from_compliances(
      geometry, read_compliances(read_text(file, compliances_size_limit), file.string(), geometry.joint.value));
}

}  // namespace posewright
