#include "calibration_notes.hpp"

#include <fmt/format.h>

#include <vector>

#include "posewright/support/table.hpp"

namespace posewright {

std::string note_of_step(const std::optional<FrameStep>& step) {
  if (!step) return {};
  return fmt::format(
      "from pose {} on, the {} stands elsewhere than up to pose {} ({:.3g} % of the squared residuals, p {}): was {}? "
      "Split the file there and give both parts",
      step->after, step->frame, step->before, 100 * step->share,
      step->chance < 1e-6 ? "below 1e-6" : fmt::format("= {:.2g}", step->chance),
      step->frame == "base" ? "the instrument moved" : "it remounted");
}

std::string note_of_visits(const std::optional<VisitErrors>& visits) {
  if (!visits) return {};
  std::vector<std::string> parts;
  if (visits->translation > 0) parts.push_back("position " + shown_value(visits->translation, "m"));
  if (visits->rotation > 0) parts.push_back("rotation " + shown_value(visits->rotation, "rad"));
  return fmt::format(
      "targets of a pose err together: counted as repeatability, {}; state it, or look for an effect left out",
      fmt::join(parts, ", "));
}

std::string note_of_instruments(const std::vector<InstrumentResiduals>& instruments) {
  std::vector<std::string> parts;
  for (const InstrumentResiduals& one : instruments) {
    if (one.noise_factor > 1)
      parts.push_back(
          fmt::format("{} counts with {:.3g} times its stated noise, as its residuals are: state it, or look "
                      "for an effect of this instrument",
                      one.name, one.noise_factor));
    if (one.help && one.help->harms())
      parts.push_back(
          fmt::format("with the readings of {0} the other instruments' poses, left out of the estimate, are "
                      "predicted {1:.0f} % worse ({2:.1f} standard errors): leave the rows of {0} out",
                      one.name, 100 * (one.help->with / one.help->without - 1), -one.help->gain));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace posewright
