#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "posewright/problem/measurement_specs.hpp"

namespace posewright {

/// Targets and stations of an instrument, for lines of sight, drawings and lists.
struct InstrumentView {
  /// One place that it looks from; `parameters` is the prefix of those that move it ("station.A", "camera").
  struct Place {
    StationSpec station;
    std::string parameters;
    std::string words;  ///< "station A", "the camera"
  };
  /// One point that it looks at.
  struct Point {
    std::string name;
    Eigen::Vector3d position;  ///< m, in the frame of `points_at`
    std::string parameters;    ///< prefix of those that move it ("target.P1"); empty: none
  };

  std::vector<TargetSpec> targets;    ///< points fixed to the tip that its readings are made of, tip frame, m
  bool fits_pose = false;             ///< the reading is a pose, fitted to the targets
  std::optional<double> point_noise;  ///< 1σ of a coordinate of a target where it is the same everywhere, m

  bool has_places = false;  ///< its device says where it stands; else the cell may
  std::vector<Place> places;
  bool places_on_tip = false;                       ///< places are in the tip's frame, else in the measurement frame
  bool all_places = false;                          ///< every place looks at the same time
  std::vector<Point> points;                        ///< empty: lines of sight have no meaning
  Placement points_at;                              ///< of the points' frame in the tip's or the measurement frame
  std::string points_parameters;                    ///< prefix of those that move that frame ("board"); empty: none
  bool points_on_tip = true;                        ///< the points ride on the tip
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< of its field of view, frame of the place
  /// The picture that it takes; none: it takes none.
  struct Image {
    double width = 0, height = 0;  ///< px
    std::vector<Eigen::Vector3d>
        corners;  ///< lines of sight of its corners, frame of the place, z = 1: 0 0, w 0, w h, 0 h
  };
  std::optional<Image> image;
  std::optional<double> half_angle;  ///< rad, of the cone about `axis` that is in the picture everywhere
};

/// The view of a problem file's instrument; parameters of one of a list have their names in the list (name_in()).
InstrumentView view_of(const MeasurementSpec& measurement);

}  // namespace posewright
