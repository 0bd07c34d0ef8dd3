#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/model/explicit_model.hpp"
#include "posewright/problem/measurement_specs.hpp"

namespace posewright {

/// Name of the coordinate that chooses among the instruments of a list.
inline constexpr const char* instrument_coordinate = "instrument";

/// One instrument of a list, with its robot.
struct InstrumentOfList {
  std::string name;
  std::unique_ptr<ExplicitModel> model;  ///< of the robot at its nominal parameters
  double noise_factor = 1.0;             ///< readings have so many times the noise of the model
  std::vector<char> moving{};            ///< as moving_coordinates(); empty for all: of one tip
  /// It is made of others of the list: its own parameters and its readings are theirs, by their names in the list.
  bool together = false;
};

/// Name of an instrument's reading in a list: "NAME.P1.x".
std::string reading_in(const std::string& instrument, const std::string& reading);

/// One robot and several instruments, of which one reads at each pose: the discrete coordinate `instrument`, the last,
/// says which, and so which tip's pose counts where the instruments see several. Parameters: the robot's, once, then
/// each instrument's own, as "target@NAME.P1.x" (name_in()). Rows and readings are those of all instruments, one after
/// the other ("NAME.P1.x"); those that read together are a choice of their own without rows of its own. Readings of
/// those that do not read are NaN, their rows zero with unit noise, so that they tell nothing; and columns are zero
/// where an instrument does not depend on a parameter (another one's, tool.* where targets stand for the tool).
class InstrumentChoice : public IdentificationModel {
 public:
  /// @param instruments  of the same robot, no two names alike
  explicit InstrumentChoice(std::vector<InstrumentOfList> instruments);

  /// A point and selected parameters as the model of the instrument that reads there has them.
  struct Inside {
    const ExplicitModel& model;
    double variance;                        ///< of its readings, times that of the model
    const std::vector<Eigen::Index>& rows;  ///< of the model's rows among all
    std::vector<double> q, correction;
    std::vector<int> selected;              ///< those that it has
    std::vector<Eigen::Index> selected_at;  ///< where these are among all that are selected
  };
  Inside inside(const Point& at, std::span<const int> selected) const;

 private:
  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override;
  bool do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                    const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const override;
  bool do_read(const Point& at, Eigen::VectorXd& y) const override;
  void do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                     Eigen::VectorXd& out) const override;
  void do_shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const override;
  bool do_configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const override;
  void do_take_loads_at(std::span<const double> correction) override;
  int do_block_rows(std::span<const int> selected) const override;
  bool do_linearise_factored(const Point& at, std::span<const int> selected, Linearisation& out) const override;
  bool do_measurable(const Point& at) const override;
  bool do_actuator_values(const Point& at, std::span<double> values) const override;
  Eigen::Isometry3d do_tool_pose(const Point& at) const override;
  bool do_reading_twists(const Point& at, Twists& twists) const override;
  void do_blank_unread(std::span<const double> q, Eigen::VectorXd& y) const override;

  /// One choice and where its own things are among all.
  struct Part {
    std::unique_ptr<ExplicitModel> model;
    double variance = 1.0;           ///< of its readings, times that of the model
    bool together = false;           ///< as InstrumentOfList::together
    std::vector<Eigen::Index> rows;  ///< of the model's rows among all
    std::vector<int> parameters;     ///< of the model's parameters among all
    std::vector<int> inside;         ///< of all parameters in the model; −1: its readings do not depend on it
  };
  void add_own(const InstrumentOfList& instrument, Part& part);
  void find_own(const InstrumentOfList& instrument, Part& part) const;
  const Part& part_at(std::span<const double> q) const { return parts_[std::size_t(q.back())]; }
  std::vector<double> correction_of(const Part& part, std::span<const double> correction) const;
  int index_in(const Part& part, int index) const;
  Point tip_point(const Part& part, const Point& at) const;
  template <class Apply>
  void segment_by_segment(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& out,
                          const Apply& apply) const;

  std::vector<Part> parts_;
};

/// The instrument that reads at q: of a list the one that the coordinate `instrument` says, else the only one.
const MeasurementSpec& instrument_at(const MeasurementSpec& measurement, const std::vector<Coordinate>& coordinates,
                                     std::span<const double> q);

/// Index of the coordinate `instrument`, whose value is the index of an instrument; none without a list.
std::optional<std::size_t> instrument_index(const std::vector<Coordinate>& coordinates);

/// First row of the pose that is read at q by an instrument, or by one of a list in which each reads a whole pose.
Eigen::Index pose_row(const std::vector<Coordinate>& coordinates, std::span<const double> q);

}  // namespace posewright
