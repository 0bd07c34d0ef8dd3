#include "obstacle_files.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "posewright/model/link_geometry.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

std::vector<PlacedShape> read_urdf_shapes(const ObstacleFileSpec& spec, const NamedFiles&) {
  std::vector<PlacedShape> shapes;
  for (LinkGeometry& link : read_urdf_still(spec.file))
    for (LinkShape& shape : link.shapes)
      shapes.push_back({link.name, std::move(shape.shape), shape.X_FrameShape, link.line});
  return shapes;
}

constexpr std::uintmax_t largest_world = 200'000'000;  // bytes

/// Readers by ending; a new kind of file is one row.
struct ObstacleReader {
  std::string_view ending;
  std::vector<PlacedShape> (*read)(const ObstacleFileSpec& spec, const NamedFiles& files);
};
constexpr std::array<ObstacleReader, 4> readers{{
    {".sdf", read_sdf_shapes},
    {".world", read_sdf_shapes},
    {".urdf", read_urdf_shapes},
    {".scene", [](const ObstacleFileSpec& spec, const NamedFiles&) { return read_moveit_shapes(spec); }},
}};

/// True if `except` names the body, the model it is part of, or one that this is in.
bool is_within(const std::string& name, const std::string& except) {
  return name == except || name.starts_with(except + "::");
}

/// True if a world names the model, even if it was left out before its shapes were read.
bool names_model(const std::filesystem::path& world, const std::string& name) {
  return read_xml_text(world, largest_world).find(name) != std::string::npos;
}

}  // namespace

std::vector<PlacedShape> read_obstacle_file(const ObstacleFileSpec& spec, const NamedFiles& files) {
  const SourcePlace place = files.problem.at(spec.line);
  const std::string ending = spec.file.extension().string();
  const auto reader = std::find_if(readers.begin(), readers.end(), [&](const auto& r) { return r.ending == ending; });
  if (reader == readers.end())
    throw InputError(place, "'" + spec.file.string() + "' has an unknown format", ".sdf, .world, .urdf, .scene");
  std::error_code code;
  if (!std::filesystem::is_regular_file(spec.file, code))
    throw InputError(place, "'" + spec.file.string() + "' is not there", "a file of obstacles is needed");
  std::vector<PlacedShape> shapes = reader->read(spec, files);
  const bool is_world = ending == ".sdf" || ending == ".world";
  for (const Located<std::string>& except : spec.except)
    if (std::erase_if(shapes, [&](const PlacedShape& s) { return is_within(s.name, except.value); }) == 0 &&
        !(is_world && names_model(spec.file, except.value))) {
      std::string names;
      for (const PlacedShape& s : shapes) names += (names.empty() ? "" : ", ") + s.name;
      throw InputError(files.problem.at(except.line),
                       "'" + except.value + "' is not in " + spec.file.filename().string(),
                       names.empty() ? "no obstacle is left" : "allowed: " + names);
    }
  return shapes;
}

}  // namespace posewright
