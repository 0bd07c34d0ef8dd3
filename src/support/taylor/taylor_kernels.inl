// Compiled once per instruction set, each time with another TAYLOR_KERNELS. Includes nothing that has inline functions:
// code built here for AVX must not be merged with the same function built elsewhere without.

#include "taylor_kernels.hpp"

namespace posewright {
namespace {

// As wide as the registers: wider vectors are taken apart by way of memory.
#if defined(__AVX512F__)
constexpr std::size_t width = 8;
#elif defined(__AVX2__)
constexpr std::size_t width = 4;
#else
constexpr std::size_t width = 2;
#endif
typedef double Part __attribute__((vector_size(8 * width), aligned(8)));
typedef long long Bits __attribute__((vector_size(8 * width), aligned(8)));

inline Part load(const double* from) { return *reinterpret_cast<const Part*>(from); }
inline void store(double* to, Part x) { *reinterpret_cast<Part*>(to) = x; }
inline Part size_of(Part x) { return reinterpret_cast<Part>(reinterpret_cast<Bits>(x) & 0x7fffffffffffffffLL); }

inline bool is_zero(const double* lanes) {
  for (std::size_t k = 0; k < taylor_lanes; ++k)
    if (lanes[k] != 0) return false;
  return true;
}

void add_products(double* __restrict out, const double* a, std::size_t terms_a, const double* b, std::size_t terms_b,
                  const ProductTable& table) {
  for (int degree = 1; degree < table.degree; ++degree) {
    const std::size_t left = table.terms[table.degree - degree], terms = terms_b < left ? terms_b : left;
    const std::size_t last = table.terms[degree] < terms_a ? table.terms[degree] : terms_a;
    for (std::size_t i = table.terms[degree - 1]; i < last; ++i) {
      if (is_zero(a + taylor_lanes * i)) continue;
      const std::uint32_t* to = table.products + table.first[i];
      for (std::size_t part = 0; part < taylor_lanes; part += width) {
        const Part factor = load(a + taylor_lanes * i + part);
        for (std::size_t j = 1; j < terms; ++j) {
          double* place = out + taylor_lanes * to[j] + part;
          store(place, load(place) + factor * load(b + taylor_lanes * j + part));
        }
      }
    }
  }
}

void add_multiple(double* to, const double* factor, const double* from, std::size_t terms, double* sizes) {
  for (std::size_t part = 0; part < taylor_lanes; part += width) {
    const Part times = load(factor + part);
    Part of_from{}, of_to{};
    for (std::size_t i = part; i < taylor_lanes * terms; i += taylor_lanes) {
      const Part next = load(from + i), sum = load(to + i) + times * next;
      store(to + i, sum);
      of_from += size_of(next);
      of_to += size_of(sum);
    }
    store(sizes + part, of_from);
    store(sizes + taylor_lanes + part, of_to);
  }
}

void take_multiple(double* to, const double* factor, const double* from, std::size_t terms, double* sizes) {
  for (std::size_t part = 0; part < taylor_lanes; part += width) {
    const Part times = load(factor + part);
    Part sum{};
    for (std::size_t i = part; i < taylor_lanes * terms; i += taylor_lanes) {
      const Part next = times * load(from + i);
      store(to + i, next);
      sum += size_of(next);
    }
    store(sizes + part, sum);
  }
}

void sum_sizes(const double* from, std::size_t terms, double* sizes) {
  for (std::size_t part = 0; part < taylor_lanes; part += width) {
    Part sum{};
    for (std::size_t i = part; i < taylor_lanes * terms; i += taylor_lanes) sum += size_of(load(from + i));
    store(sizes + part, sum);
  }
}

}  // namespace

const TaylorKernels TAYLOR_KERNELS = {add_products, add_multiple, take_multiple, sum_sizes};

}  // namespace posewright
