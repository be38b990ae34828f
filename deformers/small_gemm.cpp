#include "deformers/small_gemm.h"

#include <cstring>

namespace sinew {

namespace {

typedef double Lanes __attribute__((vector_size(gemm_lanes * sizeof(double))));

Lanes load(const double* from) {
  Lanes x;
  std::memcpy(&x, from, sizeof(x));
  return x;
}

void store(double* to, Lanes x) {
  std::memcpy(to, &x, sizeof(x));
}

/// One tile of `columns` <= gemm_columns columns; the count is a template argument so that the sums stay in registers.
template <std::size_t columns>
void tile(std::size_t k, const double* A, std::size_t a, const double* B, std::size_t b, double* C, std::size_t c) {
  Lanes low[columns] = {}, high[columns] = {};
  for (std::size_t l = 0; l < k; ++l) {
    const Lanes x = load(A + l * a), y = load(A + l * a + gemm_lanes);
    for (std::size_t j = 0; j < columns; ++j) {
      const double s = B[l * b + j];
      low[j] += x * s;
      high[j] += y * s;
    }
  }
  for (std::size_t j = 0; j < columns; ++j) {
    store(C + j * c, low[j]);
    store(C + j * c + gemm_lanes, high[j]);
  }
}

}  // namespace

void gemm_abt(std::size_t m, std::size_t n, std::size_t k, const double* A, std::size_t a, const double* B,
              std::size_t b, double* C, std::size_t c) {
  static constexpr decltype(&tile<1>) tiles[] = {nullptr, tile<1>, tile<2>, tile<3>, tile<4>, tile<5>, tile<6>};
  for (std::size_t j = 0; j < n; j += gemm_columns) {
    const auto multiply = tiles[n - j < gemm_columns ? n - j : gemm_columns];
    for (std::size_t i = 0; i < m; i += gemm_rows) multiply(k, A + i, a, B + j, b, C + i + j * c, c);
  }
}

}  // namespace sinew
