#pragma once

#include <cstddef>
#include <cstdint>

namespace posewright {

/// Inner loops of Taylor models over `taylor_lanes` boxes: coefficient i of box k stands at [taylor_lanes · i + k].
/// Without contraction, each box by itself: every instruction set computes the same bits.
constexpr std::size_t taylor_lanes = 8;

/// Products of monomials up to a total degree, as Monomials has them.
struct ProductTable {
  const std::uint32_t* products;  ///< of monomial i with 0, 1, …, from first[i] on
  const std::size_t* first;
  const std::size_t* terms;  ///< monomials up to each degree
  int degree;
};
/// out += a · b without the products with either constant, as far as the table goes.
using AddProducts = void(double* out, const double* a, std::size_t terms_a, const double* b, std::size_t terms_b,
                         const ProductTable& table);
/// to_i += factor · from_i. Sizes are Σ |from_i|, then Σ |to_i| as they are then.
using AddMultiple = void(double* to, const double* factor, const double* from, std::size_t terms, double* sizes);
/// to_i = factor · from_i, and Σ |to_i|.
using TakeMultiple = void(double* to, const double* factor, const double* from, std::size_t terms, double* sizes);
/// Σ |from_i|.
using SumSizes = void(const double* from, std::size_t terms, double* sizes);

struct TaylorKernels {
  AddProducts* add_products;
  AddMultiple* add_multiple;
  TakeMultiple* take_multiple;
  SumSizes* sum_sizes;
};

extern const TaylorKernels taylor_kernels_sse2;
#if defined(__x86_64__)
extern const TaylorKernels taylor_kernels_avx2, taylor_kernels_avx512;
#endif

}  // namespace posewright
