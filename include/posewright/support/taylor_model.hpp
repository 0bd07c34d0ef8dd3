#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace posewright {

/// Monomials of n variables up to a total degree, ascending in the degree, and where products of two of them are.
class Monomials {
 public:
  static constexpr int most_variables = 6, most_degree = 8;
  using Exponents = std::array<std::uint8_t, most_variables>;

  /// 1 ≤ variables ≤ 6, 0 ≤ degree ≤ 8; made once, kept for good.
  static const Monomials& of(int variables, int degree);

  int variables() const { return variables_; }
  int degree() const { return degree_; }
  std::size_t count() const { return exponents_.size(); }
  /// Monomials of degree d or less.
  std::size_t count_to(int d) const { return count_to_[std::size_t(d)]; }
  const Exponents& exponents(std::size_t i) const { return exponents_[i]; }
  int degree_of(std::size_t i) const { return degrees_[i]; }
  /// Positions of the products of monomial i with the monomials 0, 1, … of degree up to degree() − degree_of(i).
  const std::uint32_t* products(std::size_t i) const { return products_.data() + first_product_[i]; }

  Monomials(int variables, int degree);

 private:
  int variables_, degree_;
  std::vector<Exponents> exponents_;
  std::vector<int> degrees_;
  std::vector<std::size_t> count_to_, first_product_;
  std::vector<std::uint32_t> products_;
};

/// Enclosure of a function f of x in the box [−1, 1]^n: a polynomial p of total degree D at most and a radius with
/// |f(x) − p(x)| ≤ radius at every x (Makino and Berz 2003, Int. J. Pure Appl. Math. 4(4)). What sums and products cut
/// off and what they round is in the radius; an infinite one means that nothing is known of f.
class TaylorModel {
 public:
  /// A constant, of any number of variables.
  TaylorModel(double constant = 0.0) : coefficients_{constant} {}  // NOLINT(google-explicit-constructor)
  /// x_k taken from [−1, 1] to [lower, upper].
  static TaylorModel variable(const Monomials& monomials, int k, double lower, double upper);
  /// A number known to lie between these two.
  static TaylorModel between(double lower, double upper);

  /// Coefficients of the first monomials; the others are zero.
  std::span<const double> coefficients() const { return coefficients_; }
  /// Null: a constant.
  const Monomials* monomials() const { return monomials_; }
  double radius() const { return radius_; }
  double constant() const { return coefficients_[0]; }
  /// Σ |coefficients| of all monomials but 1, rounded up.
  double variation() const;
  bool known() const;
  /// Bounds of f in the box.
  double lower() const;
  double upper() const;
  /// f may be farther from p by this.
  TaylorModel widened(double by) const;
  /// Polynomial without the knowledge about f.
  TaylorModel with_radius(double radius) const;

  TaylorModel& operator+=(const TaylorModel& other);
  TaylorModel& operator-=(const TaylorModel& other);
  TaylorModel& operator*=(const TaylorModel& other) { return *this = *this * other; }
  TaylorModel& operator/=(const TaylorModel& other) { return *this = *this / other; }
  /// This += factor · other, without a model of the product.
  void add(double factor, const TaylorModel& other);

  friend TaylorModel operator+(TaylorModel a, const TaylorModel& b) { return a += b; }
  friend TaylorModel operator-(TaylorModel a, const TaylorModel& b) { return a -= b; }
  friend TaylorModel operator-(TaylorModel a);
  friend TaylorModel operator*(const TaylorModel& a, const TaylorModel& b);
  friend TaylorModel operator/(const TaylorModel& a, const TaylorModel& b) { return a * inverse(b); }

  /// 1/f; nothing is known of it where f may be zero.
  friend TaylorModel inverse(const TaylorModel& f);
  /// √f where f is not negative; of other places it says nothing.
  friend TaylorModel sqrt(const TaylorModel& f);
  friend TaylorModel sin(const TaylorModel& f);
  friend TaylorModel cos(const TaylorModel& f);

 private:
  static TaylorModel unknown();
  void take_monomials(const TaylorModel& other);
  TaylorModel without_constant() const;
  /// Σ series_k t^k.
  friend TaylorModel composed(const TaylorModel& t, std::span<const double> series);

  const Monomials* monomials_ = nullptr;
  std::vector<double> coefficients_;
  double radius_ = 0.0;
};

}  // namespace posewright

namespace Eigen {
template <>
struct NumTraits<posewright::TaylorModel> : GenericNumTraits<posewright::TaylorModel> {
  enum {
    IsInteger = 0,
    IsSigned = 1,
    IsComplex = 0,
    RequireInitialization = 1,
    ReadCost = 50,
    AddCost = 200,
    MulCost = 2000
  };
};
}  // namespace Eigen
