#include <fmt/format.h>

#include <algorithm>

#include "calibration_parts.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {
using Json = nlohmann::ordered_json;

Json list_of(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// One leg's square of the picture.
class LegPlot {
 public:
  LegPlot(int leg, double actuator, double displacement)
      : left_(margin + (leg % 3) * (width + margin)),
        top_(margin + (leg / 3) * (height + margin)),
        actuator_(actuator),
        displacement_(displacement) {}

  double x(double rho) const { return left_ + width * (0.5 + 0.48 * rho / actuator_); }
  double y(double z) const { return top_ + height * (0.5 - 0.48 * z / displacement_); }

  std::string frame(const std::string& title) const {
    return fmt::format(
        "<rect x='{:.1f}' y='{:.1f}' width='{:.0f}' height='{:.0f}' fill='none' stroke='#999'/>"
        "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='#ddd'/>"
        "<text x='{:.1f}' y='{:.1f}'>{}</text>\n",
        left_, top_, width, height, left_, y(0), left_ + width, y(0), left_, top_ - 6, title);
  }

  static constexpr double width = 240, height = 180, margin = 40;

 private:
  double left_, top_, actuator_, displacement_;
};

}  // namespace

std::string platform_text(const PlatformDeformation& p) {
  std::string text =
      fmt::format("\nPlatform in {} images: its points keep one shape to {}", p.images, shown_value(p.rms, "m"));
  if (p.freedom > 0 && p.chi_square > 0) {
    const double probability = chi_square_exceeded(p.chi_square, p.freedom);
    text +=
        fmt::format("; chi-square {:.4g} for {} degrees of freedom (p {}): {}", p.chi_square, p.freedom,
                    chance_text(probability), probability < seldom ? "NOT RIGID" : "rigid as far as the noise shows");
  }
  Table table({"joint centre", "largest Δb_z", "σ of x", "y", "z", "κ", "σ", "left by κ", "left by K"});
  for (std::size_t i = 0; i < p.joints.size(); ++i) {
    const JointDeformation& j = p.joints[i];
    table.row({fmt::format("leg_{}", i + 1), shown_value(j.largest, "m"), shown_value(j.spread.x(), "m"),
               shown_value(j.spread.y(), "m"), shown_value(j.spread.z(), "m"), fmt::format("{:+.4f}", j.kappa),
               fmt::format("{:.4f}", j.kappa_sigma), shown_value(j.left_by_kappa, "m"), shown_value(j.left_by_K, "m")});
  }
  text += "\n" + table.text() + "  K, in thousandths (σ): Δb_z of a leg's centre by the actuators of all legs\n";
  for (const JointDeformation& j : p.joints) {
    text += "   ";
    for (Eigen::Index k = 0; k < j.K.size(); ++k)
      text += fmt::format(" {:+7.1f} ({:.1f})", 1e3 * j.K[k], 1e3 * j.K_sigma[k]);
    text += "\n";
  }
  return text;
}

Json matrix_json(const Eigen::MatrixXd& matrix) {
  return list_json(matrix.rowwise(), [](const auto& row) { return list_of(row.transpose()); });
}

Json platform_json(const PlatformDeformation& p) {
  Json joints = Json::array(), images = Json::array();
  for (const JointDeformation& j : p.joints)
    joints.push_back({{"largest", j.largest},
                      {"spread", list_of(j.spread)},
                      {"kappa", j.kappa},
                      {"kappa_sigma", j.kappa_sigma},
                      {"K", list_of(j.K.transpose())},
                      {"K_sigma", list_of(j.K_sigma.transpose())},
                      {"left_by_kappa", j.left_by_kappa},
                      {"left_by_K", j.left_by_K}});
  for (std::size_t i = 0; i < p.ids.size(); ++i) {
    images.push_back({{"id", p.ids[i]},
                      {"actuators", list_of(p.actuators[i])},
                      {"displacements", matrix_json(p.displacements[i].transpose())}});
  }
  return {{"chi_square", p.chi_square}, {"freedom", p.freedom}, {"rms", p.rms}, {"joints", joints}, {"images", images}};
}

std::string platform_svg(const PlatformDeformation& p) {
  double actuator = 0, displacement = 0;
  // Displacements are from the mean place, so that both laws go through the mean of the actuators.
  Eigen::VectorXd middle = Eigen::VectorXd::Zero(p.actuators.front().size());
  for (const Eigen::VectorXd& rho : p.actuators) middle += rho / double(p.actuators.size());
  for (std::size_t i = 0; i < p.ids.size(); ++i) {
    actuator = std::max(actuator, p.actuators[i].cwiseAbs().maxCoeff());
    displacement = std::max(displacement, p.displacements[i].row(2).cwiseAbs().maxCoeff());
  }
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' viewBox='0 0 {0:.0f} {1:.0f}' "
      "font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' fill='white'/>\n",
      3 * (LegPlot::width + LegPlot::margin) + LegPlot::margin,
      2 * (LegPlot::height + LegPlot::margin) + 2 * LegPlot::margin);
  for (std::size_t leg = 0; leg < p.joints.size(); ++leg) {
    const LegPlot plot(int(leg), actuator, displacement);
    svg += plot.frame(
        fmt::format("leg_{}: Δb_z, ±{:.1f} µm over Δρ, ±{:.2f} mm", leg + 1, 1e6 * displacement, 1e3 * actuator));
    const double kappa = p.joints[leg].kappa, at_middle = middle[Eigen::Index(leg)];
    svg +=
        fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='#c60'/>\n", plot.x(-actuator),
                    plot.y(kappa * (-actuator - at_middle)), plot.x(actuator), plot.y(kappa * (actuator - at_middle)));
    for (std::size_t i = 0; i < p.ids.size(); ++i) {
      const double rho = p.actuators[i][Eigen::Index(leg)];
      svg +=
          fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' fill='#246'/><path d='M{:.1f} {:.1f}h6' stroke='#2a2'/>\n",
                      plot.x(rho), plot.y(p.displacements[i](2, Eigen::Index(leg))), plot.x(rho) - 3,
                      plot.y(p.joints[leg].K.dot((p.actuators[i] - middle).transpose())));
    }
  }
  svg += fmt::format(
      "<text x='{0:.0f}' y='{1:.0f}'>● measured   <tspan fill='#c60'>—</tspan> κ of the own leg   "
      "<tspan fill='#2a2'>–</tspan> K, all legs</text>\n</svg>\n",
      LegPlot::margin, 2 * (LegPlot::height + LegPlot::margin) + LegPlot::margin);
  return svg;
}

}  // namespace posewright
