#include "posewright/problem/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "posewright/support/error.hpp"
#include "posewright/support/read_number.hpp"
#include "posewright/support/text.hpp"

namespace posewright {
namespace {

/// SI value = written value · times / over. One of both is 1 and the other exact if it can be, so that "1 mm" is
/// the double nearest to 0.001 and not a product of two rounded numbers.
struct Unit {
  std::string_view name;
  Quantity quantity;
  double times, over;
};

constexpr std::array<Unit, 25> units{{
    {"m", Quantity::length, 1, 1},
    {"mm", Quantity::length, 1, 1e3},
    {"um", Quantity::length, 1, 1e6},
    {"nm", Quantity::length, 1, 1e9},
    {"rad", Quantity::angle, 1, 1},
    {"mrad", Quantity::angle, 1, 1e3},
    {"urad", Quantity::angle, 1, 1e6},
    {"deg", Quantity::angle, std::numbers::pi, 180},
    {"N", Quantity::force, 1, 1},
    {"kN", Quantity::force, 1e3, 1},
    {"rad/Nm", Quantity::compliance, 1, 1},
    {"urad/Nm", Quantity::compliance, 1, 1e6},
    {"N/m", Quantity::stiffness, 1, 1},
    {"N/mm", Quantity::stiffness, 1e3, 1},
    {"N/um", Quantity::stiffness, 1e6, 1},
    {"s", Quantity::time, 1, 1},
    {"min", Quantity::time, 60, 1},
    {"rad/s", Quantity::turn_rate, 1, 1},
    {"deg/s", Quantity::turn_rate, std::numbers::pi, 180},
    {"m/s", Quantity::speed, 1, 1},
    {"mm/s", Quantity::speed, 1, 1e3},
    {"rad/s2", Quantity::turn_acceleration, 1, 1},
    {"deg/s2", Quantity::turn_acceleration, std::numbers::pi, 180},
    {"m/s2", Quantity::acceleration, 1, 1},
    {"mm/s2", Quantity::acceleration, 1, 1e3},
}};

/// Largest plausible values of robot, cell or instrument, SI: beyond, a unit was probably forgotten.
struct Plausible {
  Quantity quantity;
  double most;
  const char* text;
};
/// Of numbers without a unit: robots in millimetres and degrees stay below what can be.
constexpr std::array<Plausible, 2> plain{{
    {Quantity::length, 100, "100 m at most without a unit (is it mm?)"},
    {Quantity::angle, 30, "30 rad at most without a unit (is it deg?)"},
}};
constexpr std::array<Plausible, 10> plausible{{
    {Quantity::length, 1e3, "1000 m at most (is it mm?)"},
    {Quantity::angle, 1e3, "1000 rad at most (is it deg?)"},
    {Quantity::force, 1e8, "1e8 N at most"},
    {Quantity::compliance, 1, "1 rad/Nm at most (is it urad/Nm?)"},
    {Quantity::stiffness, 1e15, "1e15 N/m at most"},
    {Quantity::time, 1e7, "1e7 s at most"},
    {Quantity::turn_rate, 1e3, "1000 rad/s at most (is it deg/s?)"},
    {Quantity::speed, 1e2, "100 m/s at most (is it mm/s?)"},
    {Quantity::turn_acceleration, 1e5, "1e5 rad/s2 at most (is it deg/s2?)"},
    {Quantity::acceleration, 1e4, "10000 m/s2 at most (is it mm/s2?)"},
}};

[[noreturn]] void fail(std::string_view text, const std::string& what, const std::string& allowed) {
  throw InputError({}, in_quotes(text) + " " + what, allowed);
}

/// Reads the number at the front of `text` and cuts it off.
double take_number(std::string_view& text, const std::string& allowed) {
  const std::string_view whole = text;
  // read_number knows no plus sign; "+-1" must stay wrong.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, code] = read_number(text.data(), text.data() + text.size(), value);
  if (code == std::errc::result_out_of_range) fail(whole, "is out of range", "a finite double is needed");
  if (code != std::errc() || !std::isfinite(value)) fail(whole, "is not a finite number", allowed);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (text.size() > 1 && text[0] == ',' && text[1] >= '0' && text[1] <= '9')
    fail(whole, "has a decimal comma", "write a decimal point");
  return value;
}

/// Limits of a value with a unit, or of a plain number, which is of one of the kinds that are accepted.
void require_plausible(std::string_view text, double value, Quantity unit, std::initializer_list<Quantity> accepted) {
  const Plausible* widest = nullptr;
  const auto widen = [&](const Plausible& limit) {
    if (widest == nullptr || limit.most > widest->most) widest = &limit;
  };
  for (const Plausible& limit : plausible) {
    if (unit != Quantity::number) {
      if (limit.quantity == unit) widen(limit);
      continue;
    }
    if (std::find(accepted.begin(), accepted.end(), limit.quantity) == accepted.end()) continue;
    const auto* const less =
        std::find_if(plain.begin(), plain.end(), [&](const Plausible& p) { return p.quantity == limit.quantity; });
    widen(less != plain.end() ? *less : limit);
  }
  if (widest != nullptr && std::abs(value) > widest->most) fail(text, "is more than can be", widest->text);
}

}  // namespace

bool fits_unit(Quantity quantity, std::string_view unit) {
  switch (quantity) {
    case Quantity::angle:
    case Quantity::turn_rate:
    case Quantity::turn_acceleration:
      return unit == "rad";
    case Quantity::length:
    case Quantity::speed:
    case Quantity::acceleration:
      return unit == "m";
    default:
      return true;
  }
}

std::string allowed_units(std::initializer_list<Quantity> accepted) {
  std::string names;
  for (const Unit& unit : units)
    if (std::find(accepted.begin(), accepted.end(), unit.quantity) != accepted.end())
      names += (names.empty() ? "" : ", ") + std::string(unit.name);
  return names;
}

Measured parse_measured(std::string_view text, std::initializer_list<Quantity> accepted) {
  const std::string_view whole = trimmed_blanks(text);
  const std::string names = allowed_units(accepted);
  const std::string allowed =
      names.empty() ? "a plain number is needed" : "a number is needed, with unit (" + names + ") or in SI";
  if (whole.empty()) fail(whole, "is not a number", allowed);
  std::string_view rest = whole;
  const double number = take_number(rest, allowed);
  rest = trimmed_blanks(rest);
  if (rest.empty()) {
    require_plausible(whole, number, Quantity::number, accepted);
    return {number, Quantity::number};
  }

  const auto unit = std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.name == rest; });
  if (names.empty()) fail(whole, "has a unit", "a plain number is needed");
  if (unit == units.end()) fail(whole, "has the unknown unit " + in_quotes(rest), "allowed: " + names);
  if (std::find(accepted.begin(), accepted.end(), unit->quantity) == accepted.end())
    fail(whole, "has the wrong unit " + in_quotes(rest), "allowed: " + names);
  const double value = number * unit->times / unit->over;
  if (!std::isfinite(value)) fail(whole, "is out of range", "a finite double is needed");
  require_plausible(whole, value, unit->quantity, accepted);
  return {value, unit->quantity};
}

double parse_value(std::string_view text, Quantity quantity) { return parse_measured(text, {quantity}).value; }

}  // namespace posewright
