#include "posewright/support/read_number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>

// WebAssembly's reader beside the standard library's.
#define read_number read_number_of_wasm  // NOLINT(cppcoreguidelines-macro-usage): the same function under another name
#include "src/support/wasm/read_number.cpp"
#undef read_number

namespace posewright {
namespace {

template <class Number>
void expect_the_same(const std::string& text) {
  Number known = -7, found = -7;
  const char *first = text.data(), *last = first + text.size();
  const auto a = std::from_chars(first, last, known);
  const auto b = read_number_of_wasm(first, last, found);
  EXPECT_EQ(a.ec, b.ec) << text;
  EXPECT_EQ(a.ptr - first, b.ptr - first) << text;
  EXPECT_EQ(std::isnan(known), std::isnan(found)) << text;
  if (!std::isnan(known)) {
    EXPECT_EQ(std::memcmp(&known, &found, sizeof known), 0) << text << ": " << known << " and " << found;
  }
}

TEST(ReadNumber, OfWasmIsTheStandardLibrarys) {
  for (const char* text : {"",
                           "-",
                           "+1",
                           " 1",
                           "1 ",
                           ".",
                           "-.",
                           ".5",
                           "5.",
                           "-5.e",
                           "1e",
                           "1e+",
                           "1e-",
                           "1e5",
                           "1E-5",
                           "1e+05x",
                           "0x10",
                           "inf",
                           "-inf",
                           "INFINITY",
                           "infinit",
                           "nan",
                           "-nan",
                           "nan(1_a)",
                           "nan(1",
                           "nano",
                           "1e999",
                           "-1e999",
                           "1e-999",
                           "0e-999",
                           "0e999",
                           "1e-310",
                           "4.9e-324",
                           "2e-324",
                           "1.7976931348623157e308",
                           "1.7976931348623159e308",
                           "3.4028235e38",
                           "3.4028236e38",
                           "1e-40",
                           "1e-46",
                           "-0",
                           "-0.0",
                           "00012",
                           "1,5",
                           "1.2.3",
                           "0.1000000000000000055511151231257827021181583404541015625"}) {
    expect_the_same<double>(text);
    expect_the_same<float>(text);
  }
}

TEST(ReadNumber, OfWasmIsTheStandardLibrarysForDrawnTexts) {
  std::mt19937_64 draw(3);
  constexpr std::string_view letters = "0123456789.-+eE nifa";
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (std::size_t length = draw() % 12; length > 0; --length) text += letters[draw() % letters.size()];
    expect_the_same<double>(text);
    expect_the_same<float>(text);
    double value = 0;
    const std::uint64_t bits = draw();
    std::memcpy(&value, &bits, sizeof value);
    expect_the_same<double>(std::to_string(value / 3));
    std::snprintf(text.assign(60, '\0').data(), 60, "%.*g", int(draw() % 20), value);
    expect_the_same<double>(text.c_str());
  }
}

TEST(ReadDouble, TakesTheWholeTextOrNothing) {
  EXPECT_EQ(read_double("-1.5e3"), -1500.0);
  for (const char* text : {"", " 1", "1 ", "1x", "+1", "1e999"}) EXPECT_FALSE(read_double(text)) << text;
}

}  // namespace
}  // namespace posewright
