#include "posewright/problem/units.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "posewright/support/error.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

struct Good {
  const char* text;
  Quantity quantity;
  double value;
};

TEST(Units, WrittenValueBecomesTheNearestSiValue) {
  constexpr double pi = std::numbers::pi;
  const Good table[] = {{"1.3 mm", Quantity::length, 0.0013},
                        {"2 m", Quantity::length, 2},
                        {"10 um", Quantity::length, 1e-5},
                        {"7 nm", Quantity::length, 7e-9},
                        {"-46.53 mm", Quantity::length, -0.04653},
                        {"0.1mm", Quantity::length, 1e-4},
                        {" 5\tm ", Quantity::length, 5},
                        {"1e-3", Quantity::length, 1e-3},
                        {"180 deg", Quantity::angle, pi},
                        {"30 deg", Quantity::angle, pi / 6},
                        {"5 urad", Quantity::angle, 5e-6},
                        {"0.1 mrad", Quantity::angle, 1e-4},
                        {"1.5 rad", Quantity::angle, 1.5},
                        {"0.25", Quantity::angle, 0.25},
                        {"-12.6", Quantity::angle, -12.6},
                        {"75 rad", Quantity::angle, 75},
                        {"80", Quantity::length, 80},
                        {"800 m", Quantity::length, 800},
                        {"3 N", Quantity::force, 3},
                        {"1.5 kN", Quantity::force, 1500},
                        {"-2.5E+2", Quantity::number, -250},
                        {"+7", Quantity::number, 7},
                        {"1e-3 mm", Quantity::length, 1e-6},
                        {".5", Quantity::number, 0.5},
                        {"0", Quantity::force, 0},
                        {"+1 mm", Quantity::length, 1e-3}};
  for (const Good& row : table) EXPECT_DOUBLE_EQ(parse_value(row.text, row.quantity), row.value) << row.text;
}

TEST(Units, ThousandthsAreExactlyTheLiteral) {
  EXPECT_EQ(parse_value("0.3 mm", Quantity::length), 0.3 / 1e3);
  EXPECT_EQ(parse_value("1.3 mm", Quantity::length), 0.0013);
  EXPECT_EQ(parse_value("10 um", Quantity::length), 1e-5);
}

struct BadUnit {
  const char* text;
  Quantity quantity;
  const char* message;
};

TEST(Units, WrongTextIsRefusedWithTheReason) {
  const BadUnit table[] = {{"1,3 mm", Quantity::length, "decimal comma"},
                           {"1,5", Quantity::number, "decimal comma"},
                           {"nan", Quantity::length, "not a finite number"},
                           {"inf mm", Quantity::length, "not a finite number"},
                           {"-inf", Quantity::number, "not a finite number"},
                           {"1e400", Quantity::number, "out of range"},
                           {"1e308 kN", Quantity::force, "out of range"},
                           {"1e308 deg", Quantity::angle, "finite"},
                           {"", Quantity::length, "not a number"},
                           {"  ", Quantity::length, "not a number"},
                           {"mm", Quantity::length, "not a finite number"},
                           {"+-1", Quantity::number, "not a finite number"},
                           {"+", Quantity::number, "not a finite number"},
                           {"--1", Quantity::number, "not a finite number"},
                           {"1 inch", Quantity::length, "unknown unit 'inch'; allowed: m, mm, um, nm"},
                           {"1 MM", Quantity::length, "unknown unit 'MM'"},
                           {"1 \xC2\xB5m", Quantity::length, "unknown unit '\xC2\xB5m'; allowed: m, mm, um, nm"},
                           {"1 mm mm", Quantity::length, "unknown unit 'mm mm'"},
                           {"0x10", Quantity::length, "unknown unit 'x10'"},
                           {"5 deg", Quantity::length, "wrong unit 'deg'; allowed: m, mm, um, nm"},
                           {"5 mm", Quantity::angle, "wrong unit 'mm'; allowed: rad, mrad, urad, deg"},
                           {"5 mm", Quantity::force, "wrong unit 'mm'; allowed: N, kN"},
                           {"5 mm", Quantity::number, "plain number"},
                           {"180", Quantity::length, "100 m at most without a unit (is it mm?)"},
                           {"-35", Quantity::angle, "30 rad at most without a unit (is it deg?)"},
                           {"1001 m", Quantity::length, "1000 m at most (is it mm?)"},
                           {"1\nm", Quantity::length, "unknown unit '\\x0am'"}};
  for (const BadUnit& row : table) {
    try {
      parse_value(row.text, row.quantity);
      ADD_FAILURE() << row.text << " was accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(row.message)) << row.text;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST(Units, UnitTellsTheQuantityWhereSeveralAreAccepted) {
  const auto parse = [](const char* text) { return parse_measured(text, {Quantity::length, Quantity::angle}); };
  EXPECT_EQ(parse("1 mm").quantity, Quantity::length);
  EXPECT_EQ(parse("1 deg").quantity, Quantity::angle);
  EXPECT_EQ(parse("1").quantity, Quantity::number);
  EXPECT_THROW(parse("1 N"), InputError);
}

}  // namespace
}  // namespace posewright
