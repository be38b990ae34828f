#pragma once
/// C = A B' for the small column-major panels of a sparse factorization. For a fixed column k both A(:,k) and B(:,k)
/// are contiguous, so no packing is needed: a tile of C stays in registers while k runs.

#include <cstddef>

namespace sinew {

#if defined(__AVX512F__)
inline constexpr std::size_t gemm_lanes = 8;
#else
inline constexpr std::size_t gemm_lanes = 4;
#endif
inline constexpr std::size_t gemm_rows = 2 * gemm_lanes;  ///< rows of a tile
inline constexpr std::size_t gemm_columns = 6;            ///< columns of a tile

/// C (m x n, stride c) = A (m x k, stride a) * B (n x k, stride b)'. C is written, and A read, in whole tiles: memory
/// must go on for gemm_rows - 1 values after the last row of the last column, and c >= m rounded up to gemm_rows.
void gemm_abt(std::size_t m, std::size_t n, std::size_t k, const double* A, std::size_t a, const double* B,
              std::size_t b, double* C, std::size_t c);

}  // namespace sinew
