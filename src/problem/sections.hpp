#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "yaml_section.hpp"

/// One reader for each section of the problem file.
namespace posewright {

/// `folder` is what the path of the URDF file is relative to.
RobotSpec read_robot(const yaml::Value& value, const std::filesystem::path& folder);

MeasurementSpec read_measurement(const yaml::Value& value);

std::vector<VariantSpec> read_variants(const yaml::Value& value);

/// The kind of robot decides which keys there are.
WorkspaceSpec read_workspace(const yaml::Value& value, const RobotSpec& robot);

/// Throws where the design names none of the variants.
DesignSpec read_design(const yaml::Value& value, const std::vector<VariantSpec>& variants);

/// {position, rpy}, both optional and zero by default.
Placement read_placement(const yaml::Section& section);

/// x, y, z, rx, ry, rz as the file writes the components of a pose.
inline constexpr std::array<std::string_view, 6> pose_components{"x", "y", "z", "rx", "ry", "rz"};

}  // namespace posewright
