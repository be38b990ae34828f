#include "deformers/sparse_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <random>

#include "deformers/small_gemm.h"
#include "tests/deformers/dense.h"

namespace sinew {

namespace {

/// A symmetric positive definite block matrix on a random graph of n nodes.
BlockMatrix random_spd(int block, Index n, double degree, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<std::pair<Index, Index>> pairs;
  for (Index i = 0; n > 1 && i < static_cast<Index>(degree * n / 2); ++i)
    pairs.emplace_back(random() % n, random() % n);
  BlockMatrix H = block_pattern(block, n, pairs);
  for (double& x : H.values) x = value(random);
  for (Index j = 0; j < n; ++j) {
    Eigen::Map<Eigen::MatrixXd> D(H.at(H.offsets[j]), block, block);
    D = (D + D.transpose()).eval();
    D.diagonal().array() += 4 * block * (degree + 2);
  }
  return H;
}

double solve_error(const BlockMatrix& H) {
  SparseCholesky cholesky;
  cholesky.analyse(H);
  EXPECT_TRUE(cholesky.factorize(H));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(H.size() * H.block, -1, 2);
  Eigen::VectorXd x = b;
  cholesky.solve({x.data(), static_cast<std::size_t>(x.size())});
  return (x - dense(H).ldlt().solve(b)).norm() / b.norm();
}

}  // namespace

TEST(SmallGemm, EqualsTheProductForEverySize) {
  for (const int m : {1, 5, 16, 17, 30})
    for (const int n : {1, 2, 3, 4, 5, 6, 7, 12, 13})
      for (const int k : {1, 6, 31}) {
        Eigen::MatrixXd A = Eigen::MatrixXd::Random(m + static_cast<int>(gemm_rows), k),
                        B = Eigen::MatrixXd::Random(n, k);
        Eigen::MatrixXd C = Eigen::MatrixXd::Zero(m + static_cast<int>(gemm_rows), n);
        gemm_abt(m, n, k, A.data(), A.rows(), B.data(), n, C.data(), C.rows());
        EXPECT_LT((C.topRows(m) - A.topRows(m) * B.transpose()).norm(), 1e-13 * k * m) << m << ' ' << n << ' ' << k;
      }
}

TEST(SparseCholesky, SolvesAsADenseFactorizationDoes) {
  for (const int block : {1, 3, 6, 12})
    for (const Index n : {1u, 2u, 7u, 40u, 150u})
      for (const double degree : {0.0, 1.5, 4.0, 9.0})
        EXPECT_LT(solve_error(random_spd(block, n, degree, 7 * n + static_cast<unsigned>(block))), 1e-12)
            << block << ' ' << n << ' ' << degree;
}

TEST(SparseCholesky, MultiplyUsesBothTriangles) {
  const BlockMatrix H = random_spd(3, 20, 5, 1);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(60, 0, 1);
  Eigen::VectorXd y(60);
  multiply(H, {x.data(), 60}, {y.data(), 60});
  EXPECT_LT((y - dense(H) * x).norm(), 1e-12 * y.norm());
}

TEST(SparseCholesky, DampingIsAddedToTheDiagonal) {
  BlockMatrix H = random_spd(6, 30, 6, 3);
  std::vector<double> damping(180);
  for (std::size_t i = 0; i < damping.size(); ++i) damping[i] = 0.1 * static_cast<double>(i);
  SparseCholesky cholesky;
  cholesky.analyse(H);
  ASSERT_TRUE(cholesky.factorize(H, damping));
  Eigen::MatrixXd D = dense(H);
  for (int i = 0; i < 180; ++i) D(i, i) += damping[static_cast<std::size_t>(i)];
  Eigen::VectorXd x = Eigen::VectorXd::Ones(180);
  cholesky.solve({x.data(), 180});
  EXPECT_LT((D * x - Eigen::VectorXd::Ones(180)).norm(), 1e-11);
}

TEST(SparseCholesky, RefusesWhatIsNotPositiveDefinite) {
  BlockMatrix H = random_spd(6, 30, 6, 5);
  SparseCholesky cholesky;
  cholesky.analyse(H);
  ASSERT_TRUE(cholesky.factorize(H));
  for (const Index j : {0u, 13u, 29u}) {
    for (const double bad : {-1e6, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      BlockMatrix broken = H;
      broken.at(broken.offsets[j])[7] = bad;  // a diagonal entry
      EXPECT_FALSE(cholesky.factorize(broken)) << j << ' ' << bad;
      EXPECT_FALSE(cholesky.factorized());
    }
  }
  EXPECT_TRUE(cholesky.factorize(H));
}

TEST(SparseCholesky, TheSameBitsEveryTime) {
  const BlockMatrix H = random_spd(6, 120, 8, 9);
  std::vector<std::vector<double>> results;
  for (int run = 0; run < 2; ++run) {
    SparseCholesky cholesky;
    cholesky.analyse(H);
    ASSERT_TRUE(cholesky.factorize(H));
    std::vector<double> x(720, 1.0);
    cholesky.solve(x);
    results.push_back(x);
  }
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace sinew
