#include "deformers/gauss_newton.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace sinew {

namespace {

/// Rosenbrock's valley as least squares: f = (10 (y - x^2), 1 - x); and what the solver did with it.
struct Valley {
  double x = -1.2, y = 1, trial_x = 0, trial_y = 0;
  int hessians = 0;
  bool wrong_gradient = false, poisoned = false, singular = false;
  std::vector<double> accepted;

  static double value(double a, double b) { return 100 * (b - a * a) * (b - a * a) + (1 - a) * (1 - a); }

  GaussNewtonModel model() {
    GaussNewtonModel m;
    m.energy = [this] { return poisoned ? std::numeric_limits<double>::quiet_NaN() : value(x, y); };
    m.gradient = [this](std::span<double> g) {
      const double f0 = 10 * (y - x * x), f1 = 1 - x, sign = wrong_gradient ? -1 : 1;
      g[0] = sign * (-20 * x * f0 - f1);
      g[1] = sign * (10 * f0);
    };
    m.hessian = [this](BlockMatrix& H) {
      ++hessians;
      const double a = -20 * x;
      const double values[] = {a * a + 1, 10 * a, 10 * a, 100};
      std::copy(values, values + 4, H.values.begin());
      if (singular) std::fill(H.values.begin(), H.values.end(), std::numeric_limits<double>::quiet_NaN());
    };
    m.try_step = [this](std::span<const double> s, double h) {
      trial_x = x + h * s[0];
      trial_y = y + h * s[1];
    };
    m.trial_energy = [this] { return value(trial_x, trial_y); };
    m.held = {1, 1};
    m.accept = [this] {
      x = trial_x;
      y = trial_y;
      accepted.push_back(value(x, y));
    };
    return m;
  }
};

KeptFactor two_unknowns() {
  KeptFactor kept{block_pattern(2, 1, {}), {}, false};
  kept.cholesky.analyse(kept.H);
  return kept;
}

}  // namespace

TEST(GaussNewton, FindsTheMinimumAndNeverRises) {
  for (const bool keep : {false, true}) {
    Valley valley;
    KeptFactor kept = two_unknowns();
    GaussNewtonOptions options;
    options.keep_factor = keep;
    options.epsilon = 1e-12;
    options.max_iterations = 1000;
    double last = Valley::value(valley.x, valley.y);
    const GaussNewtonResult result = gauss_newton(valley.model(), kept, options);
    EXPECT_EQ(result.status, Status::Converged) << keep;
    EXPECT_NEAR(valley.x, 1, 1e-5);
    EXPECT_NEAR(valley.y, 1, 1e-5);
    for (const double F : valley.accepted) {
      EXPECT_LE(F, last);
      last = F;
    }
    EXPECT_EQ(result.factorizations, valley.hessians);
    if (!keep) {
      EXPECT_EQ(result.factorizations, result.iterations);
    }
  }
}

TEST(GaussNewton, AKeptFactorIsUsedAgainInTheNextSolve) {
  Valley valley;
  KeptFactor kept = two_unknowns();
  gauss_newton(valley.model(), kept, {});
  valley.hessians = 0;
  valley.x += 1e-4;
  const GaussNewtonResult result = gauss_newton(valley.model(), kept, {});
  EXPECT_EQ(result.status, Status::Converged);
  EXPECT_EQ(valley.hessians, 0);
}

TEST(GaussNewton, SaysHowItEnded) {
  {
    Valley valley;
    KeptFactor kept = two_unknowns();
    GaussNewtonOptions options;
    options.max_iterations = 2;
    EXPECT_EQ(gauss_newton(valley.model(), kept, options).status, Status::MaxIterations);
  }
  {
    Valley valley;
    KeptFactor kept = two_unknowns();
    GaussNewtonOptions options;
    options.on_iteration = [] { return false; };
    const GaussNewtonResult result = gauss_newton(valley.model(), kept, options);
    EXPECT_EQ(result.status, Status::Stopped);
    EXPECT_EQ(result.iterations, 1);
  }
  {
    Valley valley;
    valley.wrong_gradient = true;
    KeptFactor kept = two_unknowns();
    const double before = Valley::value(valley.x, valley.y);
    const GaussNewtonResult result = gauss_newton(valley.model(), kept, {});
    EXPECT_EQ(result.status, Status::Stalled);
    EXPECT_FALSE(result.message.empty());
    EXPECT_EQ(Valley::value(valley.x, valley.y), before);
  }
  {
    Valley valley;
    valley.poisoned = true;
    KeptFactor kept = two_unknowns();
    EXPECT_EQ(gauss_newton(valley.model(), kept, {}).status, Status::Failed);
  }
  {
    Valley valley;
    valley.singular = true;
    KeptFactor kept = two_unknowns();
    EXPECT_EQ(gauss_newton(valley.model(), kept, {}).status, Status::Failed);
    EXPECT_EQ(valley.x, -1.2);
  }
}

}  // namespace sinew
