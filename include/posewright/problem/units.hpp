#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace posewright {

/// Quantity of a value. SI inside: m, rad, N, rad/(N·m), N/m, s, rad/s, m/s, rad/s², m/s².
enum class Quantity {
  number,
  length,
  angle,
  force,
  compliance,
  stiffness,
  time,
  turn_rate,
  speed,
  turn_acceleration,
  acceleration
};

/// A value in SI together with the quantity its unit names; `number` where no unit was written.
struct Measured {
  double value = 0.0;
  Quantity quantity = Quantity::number;
};

/// Reads "1.3 mm", "30 deg", "5 urad" or a plain number, which is taken as SI. The unit must name one of the
/// `accepted` quantities; a plain number always passes. The decimal separator is a point; the space before the unit
/// may be left out. Throws InputError without a place where the text is anything else or not finite in SI.
Measured parse_measured(std::string_view text, std::initializer_list<Quantity> accepted);

/// Overload for one quantity; only a plain number passes as `Quantity::number`.
double parse_value(std::string_view text, Quantity quantity);

/// True if a value of that quantity, or its rate, belongs to a coordinate in `unit` ("rad" or "m"); plain numbers do.
bool fits_unit(Quantity quantity, std::string_view unit);

/// Units that may be written, for messages: "m, mm, um, nm".
std::string allowed_units(std::initializer_list<Quantity> accepted);

}  // namespace posewright
