#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <utility>
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
  const std::vector<std::size_t>& counts() const { return count_to_; }
  const Exponents& exponents(std::size_t i) const { return exponents_[i]; }
  int degree_of(std::size_t i) const { return degrees_[i]; }
  /// Positions of the products of monomial i with the monomials 0, 1, … of degree up to degree() − degree_of(i).
  const std::uint32_t* products(std::size_t i) const { return products_.data() + first_product_[i]; }
  /// The same of all monomials in turn: where those of monomial i begin.
  const std::vector<std::size_t>& first_products() const { return first_product_; }

  Monomials(int variables, int degree);

 private:
  int variables_, degree_;
  std::vector<Exponents> exponents_;
  std::vector<int> degrees_;
  std::vector<std::size_t> count_to_, first_product_;
  std::vector<std::uint32_t> products_;
};

/// So many bytes from the start of a cache line on. What a thread gave back it uses again, some hundred blocks of each
/// size: models are made and dropped by the million, and the general allocator took a third of a proof.
void* take_lines(std::size_t bytes);
void give_back_lines(void* block, std::size_t bytes);

/// Allocator of the above; doubles are left as they are until they are written.
template <class T>
struct LineAligned {
  using value_type = T;
  LineAligned() = default;
  template <class Other>
  LineAligned(const LineAligned<Other>&) {}  // NOLINT(google-explicit-constructor)
  T* allocate(std::size_t count) { return static_cast<T*>(take_lines(count * sizeof(T))); }
  void deallocate(T* block, std::size_t count) { give_back_lines(block, count * sizeof(T)); }
  void construct(T* place) { ::new (static_cast<void*>(place)) T; }
  template <class... Of>
  void construct(T* place, Of&&... of) {
    ::new (static_cast<void*>(place)) T(std::forward<Of>(of)...);
  }
  friend bool operator==(const LineAligned&, const LineAligned&) { return true; }
};

/// Enclosures of a function f on several boxes side by side, so that one instruction serves all. Each is of x in the
/// box [−1, 1]^n: a polynomial p of total degree D at most and a radius with |f(x) − p(x)| ≤ radius at every x (Makino
/// and Berz 2003, Int. J. Pure Appl. Math. 4(4)). What sums and products cut off and what they round is in the radius;
/// an infinite one means that nothing is known of f on that box.
class TaylorModel {
 public:
  static constexpr std::size_t boxes = 8;
  using Values = std::array<double, boxes>;  ///< one of each box

  /// A constant, of any number of variables.
  TaylorModel(double constant = 0.0);  // NOLINT(google-explicit-constructor)
  static TaylorModel constants(const Values& constants);
  /// x_k taken from [−1, 1] to [lower, upper].
  static TaylorModel variable(const Monomials& monomials, int k, const Values& lower, const Values& upper);
  static TaylorModel variable(const Monomials& monomials, int k, double lower, double upper);

  /// Coefficients of the first so many monomials; the others are zero.
  std::size_t terms() const { return coefficients_.size() / boxes; }
  double coefficient(std::size_t i, std::size_t box = 0) const { return coefficients_[boxes * i + box]; }
  /// Coefficients of each box of the first monomial, then of the second, …
  const double* coefficients() const { return coefficients_.data(); }
  /// Null: a constant.
  const Monomials* monomials() const { return monomials_; }
  double radius(std::size_t box = 0) const { return radius_[box]; }
  double constant(std::size_t box = 0) const { return coefficients_[box]; }
  /// Zero and nothing else, on every box.
  bool is_zero() const;
  /// Σ |coefficients| of all monomials but 1, rounded up.
  Values variations() const;
  bool known(std::size_t box = 0) const;
  /// Bounds of f in each box.
  Values lowers() const;
  Values uppers() const;
  double lower(std::size_t box = 0) const { return lowers()[box]; }
  double upper(std::size_t box = 0) const { return uppers()[box]; }
  /// No |f| in the box is larger.
  Values farthest() const;
  /// f may be farther from p by this.
  TaylorModel widened(const Values& by) const;
  /// Polynomials without the knowledge about f.
  TaylorModel with_radius(double radius) const;

  /// Of this box nothing but that f lies between these two.
  void put_between(std::size_t box, double lower, double upper);
  void put_unknown(std::size_t box);
  /// Polynomials of boxes of which nothing is known become 0.
  void clear_unknown();
  /// The other's enclosure of this box.
  void take_box(std::size_t box, const TaylorModel& other);

  TaylorModel& operator+=(const TaylorModel& other) { return add_multiple(1.0, other); }
  TaylorModel& operator-=(const TaylorModel& other) { return add_multiple(-1.0, other); }
  TaylorModel& operator*=(const TaylorModel& other) { return *this = *this * other; }
  TaylorModel& operator/=(const TaylorModel& other) { return *this = *this / other; }
  /// This += factor · other, without a model of the product. A factor of 0 takes nothing of that box.
  void add(double factor, const TaylorModel& other);
  void add(const Values& factor, const TaylorModel& other);

  friend TaylorModel operator+(TaylorModel a, const TaylorModel& b) { return std::move(a += b); }
  friend TaylorModel operator-(TaylorModel a, const TaylorModel& b) { return std::move(a -= b); }
  friend TaylorModel operator-(const TaylorModel& a);
  friend TaylorModel operator*(const TaylorModel& a, const TaylorModel& b);
  friend TaylorModel operator/(const TaylorModel& a, const TaylorModel& b) { return a * inverse(b); }

  /// 1/f; nothing is known of it where f may be zero.
  friend TaylorModel inverse(const TaylorModel& f);
  /// √f where f is not negative; of other places it says nothing.
  friend TaylorModel sqrt(const TaylorModel& f);
  friend TaylorModel sin(const TaylorModel& f);
  friend TaylorModel cos(const TaylorModel& f);

 private:
  using Coefficients = std::vector<double, LineAligned<double>>;

  void take_monomials(const TaylorModel& other);
  TaylorModel& add_multiple(double sign, const TaylorModel& other);
  TaylorModel without_constant() const;
  void put_constant(std::size_t box, double constant);
  friend TaylorModel scaled(const Values& factor, const Values& radius, const TaylorModel& f);
  /// Σ series_k t^k.
  friend TaylorModel composed(const TaylorModel& t, std::span<const Values> series);

  const Monomials* monomials_ = nullptr;
  Coefficients coefficients_;
  Values radius_{};
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
