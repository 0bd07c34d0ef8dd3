#include "cell_in_si.hpp"

#include <fmt/format.h>

namespace posewright {

double cell_in_si(const std::string& cell, const std::string& unit, const std::string& column, Quantity quantity,
                  const SourcePlace& place) {
  try {
    return parse_value(unit.empty() ? cell : cell + " " + unit, quantity);
  } catch (const InputError&) {
    throw InputError(place, fmt::format("'{}' of '{}' is not a value", cell.substr(0, 40), column),
                     "a number; in the header, a unit: " + allowed_units({quantity}));
  }
}

}  // namespace posewright
