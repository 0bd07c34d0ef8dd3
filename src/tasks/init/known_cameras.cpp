#include "posewright/tasks/known_cameras.hpp"

#include <cmath>
#include <numbers>

#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"

namespace posewright {
namespace {

constexpr double most_pixels = 100000;

/// Focal length in px from the angle of view over so many px.
double of_view(double pixels, double degrees) {
  return std::round(pixels / 2 / std::tan(degrees / 2 * std::numbers::pi / 180));
}

/// From a lens in mm and pixels in um.
double of_lens(double millimetres, double micrometres) { return std::round(1000 * millimetres / micrometres); }

}  // namespace

double KnownCamera::horizontal_view() const { return 2 * std::atan(width / (2 * focal)); }
double KnownCamera::vertical_view() const { return 2 * std::atan(height / (2 * focal)); }

const std::vector<KnownCamera>& known_cameras() {
  static const std::string realsense = "Intel RealSense D400 series data sheet 337029, ";
  static const std::vector<KnownCamera> table = {
      {"realsense-d405", 1280, 720, of_view(1280, 87), realsense + "view 87 x 58 deg (colour from the depth sensor)"},
      {"realsense-d415", 1920, 1080, of_view(1920, 69.4),
       realsense + "colour sensor, view 69.4 x 42.5 deg (each +- 3)"},
      {"realsense-d435", 1920, 1080, of_view(1920, 69.4),
       realsense + "colour sensor, view 69.4 x 42.5 deg (each +- 3)"},
      {"realsense-d455", 1280, 800, of_view(1280, 90), realsense + "colour sensor, view 90 x 65 deg (each +- 3)"},
      {"azure-kinect", 3840, 2160, of_view(3840, 90), "Microsoft, Azure Kinect DK hardware specification, 90 x 59 deg"},
      {"femto-bolt", 3840, 2160, of_view(3840, 80), "Orbbec, Femto Bolt compared with Azure Kinect DK, 80 x 51 deg"},
      {"zed", 1920, 1080, 1400, "Stereolabs support, focal length and field of view: HD1080 1400 px (ZED, ZED Mini)"},
      {"oak-d-s2", 4056, 3040, of_view(4056, 66), "Luxonis, OAK-D S2 with auto focus, IMX378: 66 x 54 deg"},
      {"logitech-c920", 1920, 1080, of_view(std::hypot(1920, 1080), 78), "Logitech C920: 78 deg along the diagonal"},
      {"imx392-8mm", 1920, 1200, of_lens(8, 3.45), "8 mm lens on a Sony IMX392 (3.45 um pixels): 8 mm / 3.45 um"},
      {"imx250-8mm", 2448, 2048, of_lens(8, 3.45), "8 mm lens on a Sony IMX250 (3.45 um pixels): 8 mm / 3.45 um"},
  };
  return table;
}

KnownCamera find_camera(const std::string& text) {
  std::vector<std::string> names;
  for (const KnownCamera& camera : known_cameras()) {
    if (camera.name == text) return camera;
    names.push_back(camera.name);
  }
  KnownCamera own{text, 0, 0, 0, "from the command line"};
  int end = 0;
  if (std::sscanf(text.c_str(), "%dx%d@%lf%n", &own.width, &own.height, &own.focal, &end) == 3 &&
      std::size_t(end) == text.size() && own.width > 0 && own.height > 0 && own.focal > 0 && own.width < most_pixels &&
      own.height < most_pixels && own.focal < most_pixels)
    return own;
  std::string list;
  for (const std::string& name : names) list += name + ", ";
  throw InputError({}, "camera " + in_quotes(text) + " is not known" + meant_instead(text, names),
                   "known: " + list + "or WIDTHxHEIGHT@FOCAL in pixels (1920x1200@2300)");
}

}  // namespace posewright
