// Compiled once per instruction set, each time with another TAYLOR_KERNELS. Includes nothing that has inline functions:
// code built here for AVX must not be merged with the same function built elsewhere without.

#include "kernels.hpp"

namespace posewright {
namespace {

typedef double Lanes __attribute__((vector_size(64), aligned(8)));
typedef long long Bits __attribute__((vector_size(64), aligned(8)));

inline Lanes load(const double* from) { return *reinterpret_cast<const Lanes*>(from); }
inline void store(double* to, Lanes x) { *reinterpret_cast<Lanes*>(to) = x; }
inline Lanes size_of(Lanes x) { return reinterpret_cast<Lanes>(reinterpret_cast<Bits>(x) & 0x7fffffffffffffffLL); }

inline bool is_zero(Lanes x) {
  const Bits bits = reinterpret_cast<Bits>(x) << 1;
  long long any = 0;
  for (std::size_t k = 0; k < taylor_lanes; ++k) any |= bits[k];
  return any == 0;
}

void add_products(double* __restrict out, const double* a, std::size_t terms_a, const double* b, std::size_t terms_b,
                  const ProductTable& table) {
  for (int degree = 1; degree < table.degree; ++degree) {
    const std::size_t left = table.terms[table.degree - degree], terms = terms_b < left ? terms_b : left;
    const std::size_t last = table.terms[degree] < terms_a ? table.terms[degree] : terms_a;
    for (std::size_t i = table.terms[degree - 1]; i < last; ++i) {
      const Lanes factor = load(a + taylor_lanes * i);
      if (is_zero(factor)) continue;
      const std::uint32_t* to = table.products + table.first[i];
      for (std::size_t j = 1; j < terms; ++j) {
        double* place = out + taylor_lanes * to[j];
        store(place, load(place) + factor * load(b + taylor_lanes * j));
      }
    }
  }
}

void add_multiple(double* to, const double* factor, const double* from, std::size_t terms, double* sizes) {
  const Lanes times = load(factor);
  Lanes of_from{}, of_to{};
  for (std::size_t i = 0; i < taylor_lanes * terms; i += taylor_lanes) {
    const Lanes next = load(from + i), sum = load(to + i) + times * next;
    store(to + i, sum);
    of_from += size_of(next);
    of_to += size_of(sum);
  }
  store(sizes, of_from);
  store(sizes + taylor_lanes, of_to);
}

void take_multiple(double* to, const double* factor, const double* from, std::size_t terms, double* sizes) {
  const Lanes times = load(factor);
  Lanes sum{};
  for (std::size_t i = 0; i < taylor_lanes * terms; i += taylor_lanes) {
    const Lanes next = times * load(from + i);
    store(to + i, next);
    sum += size_of(next);
  }
  store(sizes, sum);
}

void sum_sizes(const double* from, std::size_t terms, double* sizes) {
  Lanes sum{};
  for (std::size_t i = 0; i < taylor_lanes * terms; i += taylor_lanes) sum += size_of(load(from + i));
  store(sizes, sum);
}

}  // namespace

const TaylorKernels TAYLOR_KERNELS = {add_products, add_multiple, take_multiple, sum_sizes};

}  // namespace posewright
