// The mathematical functions of the program are musl's to the last bit (cmake/mathematics.cmake), as WebAssembly has
// them. At every place of the table glibc 2.36 with fused multiplication has another last digit.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

namespace {

using Function = double (*)(double, double);

const std::map<std::string, Function> functions = {
    {"sin", [](double x, double) { return std::sin(x); }},
    {"cos", [](double x, double) { return std::cos(x); }},
    {"tan", [](double x, double) { return std::tan(x); }},
    {"asin", [](double x, double) { return std::asin(x); }},
    {"acos", [](double x, double) { return std::acos(x); }},
    {"atan", [](double x, double) { return std::atan(x); }},
    {"atan2", [](double x, double y) { return std::atan2(x, y); }},
    {"hypot", [](double x, double y) { return std::hypot(x, y); }},
    {"exp", [](double x, double) { return std::exp(x); }},
    {"expm1", [](double x, double) { return std::expm1(x); }},
    {"log", [](double x, double) { return std::log(x); }},
    {"log10", [](double x, double) { return std::log10(x); }},
    {"log1p", [](double x, double) { return std::log1p(x); }},
    {"pow", [](double x, double y) { return std::pow(x, y); }},
    {"erf", [](double x, double) { return std::erf(x); }},
};

struct Known {
  const char* function;
  double x, y, value;
};

// clang-format off
constexpr Known known[] = {
    {"sin", 0x1.7e5370744d8p-1, 0, 0x1.5bc5b496f2984p-1},
    {"sin", 0x1.f5c50fc9f8bp+1, 0, -0x1.6786d7db27646p-1},
    {"cos", 0x1.9b28ed1b432p-1, 0, 0x1.6397dbff7298ap-1},
    {"cos", -0x1.2358be0bdda4p+1, 0, -0x1.4bedf62e945cp-1},
    {"tan", -0x1.f8d7458b966cp-1, 0, -0x1.82b1f45486114p+0},
    {"tan", -0x1.589055f3add6p-1, 0, -0x1.981ec9a078a2p-1},
    {"asin", -0x1.a86a2d2d90d4p-1, 0, -0x1.f453b3723cc7p-1},
    {"asin", -0x1.d50df507706cp-1, 0, -0x1.288637ea78604p+0},
    {"acos", 0x1.f380230cf02p-2, 0, 0x1.0fad2955e3ffp+0},
    {"acos", -0x1.eee6a659ee08p-1, 0, 0x1.70f34857017fcp+1},
    {"atan", 0x1.113d10654388p+0, 0, 0x1.a2cb84fabed98p-1},
    {"atan", -0x1.6f2db818bc0ep+1, 0, -0x1.3c40ea28eef38p+0},
    {"exp", -0x1.26fcebab6c3ep+0, 0, 0x1.437e01b251e96p-2},
    {"exp", -0x1.6a23c1e3ebfap+1, 0, 0x1.e3cff5f763bbp-5},
    {"expm1", 0x1.49004be9ea68p-2, 0, 0x1.83ffd94007e8fp-2},
    {"expm1", 0x1.7132cc5ef12p-3, 0, 0x1.9491df559b75ap-3},
    {"log", 0x1.1ca97b80d72f2p+0, 0, 0x1.b2b0593518c74p-4},
    {"log", 0x1.cd9c260d361eap-1, 0, -0x1.a85d06e81b0bcp-4},
    {"log10", 0x1.c2f17e2970ac2p+2, 0, 0x1.b2257401a98c3p-1},
    {"log10", 0x1.25c6d53478937p+0, 0, 0x1.e9b23aa9c6082p-5},
    {"log1p", 0x1.a1c5ed0652b8p-2, 0, 0x1.5e5e73cf08c6p-2},
    {"log1p", 0x1.710423e527cap-2, 0, 0x1.3b24118c902a2p-2},
    {"erf", -0x1.e69dfb4ffep-2, 0, -0x1.fe696753849bdp-2},
    {"erf", -0x1.7e11a3a76574p+0, 0, -0x1.ee2e680f5a185p-1},
    {"atan2", 0x1.157aa0f831fe6p-2, 0x1.2163f4e129a8ap+0, 0x1.e1d594b3c5cdp-3},
    {"atan2", 0x1.317654d290ccdp-3, 0x1.cc9e655650753p-1, 0x1.5079bc4414d7ep-3},
    {"hypot", 0x1.91ebad741b0fap+0, 0x1.63640ababcf8ap+0, 0x1.0c4141fdce5dap+1},
    {"hypot", 0x1.832c0696476bdp+1, 0x1.91c5615372413p-1, 0x1.8ffd1553af405p+1},
    {"pow", 0x1.546c01b9e078dp+1, 0x1.b2393ff56a32ap+0, 0x1.504dee710e066p+2},
    {"pow", 0x1.63eecc1fe9d6dp+1, 0x1.36aaa07f261f5p+1, 0x1.7ef6cd0f27f8cp+3},
};
// clang-format on

TEST(Mathematics, FunctionsAreThoseOfMusl) {
  for (const Known& k : known) {
    const volatile double x = k.x, y = k.y;  // no compiler computes them
    EXPECT_EQ(functions.at(k.function)(x, y), k.value) << k.function << " of " << k.x << " " << k.y;
  }
}

// A compiler calls one function for both.
TEST(Mathematics, SineAndCosineTogetherAreThoseAlone) {
  for (double x = -7.0; x < 7.0; x += 0.013) {
    const volatile double first = x, second = x;
    const double both = first;
    const double sine = std::sin(both), cosine = std::cos(both);
    EXPECT_EQ(sine, std::sin(second));
    EXPECT_EQ(cosine, std::cos(second));
  }
}

}  // namespace
