#include "posewright/proof/harmonic_rows.hpp"

#include <utility>

#include "explicit_rows.hpp"
#include "posewright/model/explicit_model.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/load_difference.hpp"

namespace posewright {
namespace {

std::unique_ptr<HarmonicRows> rows_of_difference(const LoadDifference& model, std::span<const double> q,
                                                 std::span<const int> selected, std::string& why_not) {
  auto loaded = harmonic_expansion(model.inside(), q, selected, why_not);
  auto unloaded =
      loaded != nullptr ? harmonic_expansion(model.inside(), model.unloaded(q), selected, why_not) : nullptr;
  if (unloaded == nullptr) return nullptr;
  if (loaded->parts().size() != 1 || loaded->parts().front().distance >= 0 || unloaded->parts().size() != 1) {
    why_not = "loaded minus unloaded readings whose noise is not the same everywhere";
    return nullptr;
  }
  return harmonic_difference(std::move(loaded), std::move(unloaded));
}

}  // namespace

std::unique_ptr<HarmonicRows> harmonic_expansion(const IdentificationModel& model, std::span<const double> q,
                                                 std::span<const int> selected, std::string& why_not) {
  if (const auto* difference = dynamic_cast<const LoadDifference*>(&model))
    return rows_of_difference(*difference, q, selected, why_not);
  if (const auto* of_a_tip = dynamic_cast<const ExplicitModel*>(&model))
    return explicit_rows(of_a_tip->tip(), of_a_tip->measurement(), of_a_tip->repeatability(),
                         of_a_tip->tip_parameters(), model.nominal_point(q), selected, why_not);
  if (dynamic_cast<const InstrumentChoice*>(&model) != nullptr) why_not = "a list of instruments";
  else if (model.tips() > 1) why_not = "readings of two configurations at a time, which have twice as many joints";
  else if (!model.actuators().empty()) why_not = "sensors in the joints of a parallel robot";
  else why_not = "readings that are not of one tip alone";
  return nullptr;
}

std::unique_ptr<HarmonicRows> harmonic_rows(const IdentificationModel& model, std::span<const double> q,
                                            std::span<const int> selected, std::string& why_not) {
  auto rows = harmonic_expansion(model, q, selected, why_not);
  if (rows == nullptr || rows->remainders().empty()) return rows;
  return with_remainders(std::move(rows));
}

}  // namespace posewright
