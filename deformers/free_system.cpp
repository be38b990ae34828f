#include "deformers/free_system.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "engine/geometry/check.h"

namespace sinew {

void FreeSystem::make() {
  refinements_ = 0;
  residual_ = 0;
  if (free.empty()) return;
  factor_.analyse(H);
  std::vector<double> damping;
  for (double d = 1e-13; !factor_.factorize(H, damping); d *= 100) {
    CHECK(d < 1, d, free.size());
    damping.resize(free.size());
    for (Index j = 0; j < H.size(); ++j) damping[j] = d * H.values[H.offsets[j]];
  }
  std::vector<Vec3> b(free.size());
  double largest = 0;
  for (Index j = 0; j < H.size(); ++j) {
    b[j] = H.values[H.offsets[j]] * Vec3(std::sin(1.0 * j), std::cos(1.7 * j), std::sin(0.3 * j + 1));
    largest = std::max(largest, b[j].norm());
  }
  for (;; ++refinements_) {
    residual_ = 0;
    for (const Vec3& r : residual_of(b, solve(b))) residual_ = std::max(residual_, r.norm() / largest);
    if (residual_ < 1e-11 || refinements_ == 5) return;
  }
}

std::vector<Vec3> FreeSystem::solve(const std::vector<Vec3>& b) const {
  CHECK(b.size() == free.size(), b.size(), free.size());
  std::vector<Vec3> x = b;
  solve_once(x);
  for (int k = 0; k < refinements_; ++k) {
    std::vector<Vec3> r = residual_of(b, x);
    solve_once(r);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += r[i];
  }
  return x;
}

std::vector<Vec3> FreeSystem::residual_of(std::span<const Vec3> b, std::span<const Vec3> x) const {
  std::vector<Vec3> r(b.begin(), b.end());
  for (Index j = 0; j < H.size(); ++j)
    for (Index e = H.offsets[j]; e < H.offsets[j + 1]; ++e) {
      const Index i = H.rows[e];
      r[i] -= H.values[e] * x[j];
      if (i != j) r[j] -= H.values[e] * x[i];
    }
  return r;
}

void FreeSystem::solve_once(std::vector<Vec3>& x) const {
  if (!x.empty()) factor_.solve_three({x.front().data(), 3 * x.size()});
}

}  // namespace sinew
