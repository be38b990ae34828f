#include "deformers/gauss_newton.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "deformers/curvature.h"

namespace sinew {

namespace {

using Vector = Eigen::VectorXd;

std::span<double> span_of(Vector& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

/// Halves the step until F does not rise; the trial is then x + scale * step. With a factor that is not of this x only
/// the whole step is tried: where that rises, a new factor helps more than a short step. F is infinite where nothing
/// went down.
struct Trial {
  double scale = 1, F = INFINITY;
};
Trial line_search(const GaussNewtonModel& model, Vector& step, double F, bool fresh) {
  Trial trial;
  for (; trial.scale > 1e-10; trial.scale *= 0.5) {
    model.try_step(span_of(step), trial.scale);
    trial.F = model.trial_energy();
    if (trial.F <= F) return trial;
    if (!fresh) break;
  }
  trial.F = INFINITY;
  return trial;
}

/// The three tests of eq. 12, and the relative one. The gradient of F is 2 J'f = 2 g.
bool converged(const GaussNewtonOptions& options, double F, double decrease, const Vector& g, const Vector& step) {
  if (options.by_expectation) return std::max(decrease, -2 * g.dot(step)) <= options.relative_decrease * (F + 1e-6);
  const double largest_step = step.lpNorm<Eigen::Infinity>();
  const double root = std::cbrt(options.epsilon);
  return decrease < options.epsilon * (1 + F) && 2 * g.lpNorm<Eigen::Infinity>() < root * (1 + F) &&
         largest_step < root * (1 + largest_step) &&
         (options.relative_decrease <= 0 || decrease <= options.relative_decrease * F);
}

}  // namespace

/// The free motions of a part without anything fixed are null directions of J'J, which a damping of 1e-9 of the mean
/// diagonal holds still without being felt elsewhere.
bool make_factor(const GaussNewtonModel& model, KeptFactor& kept, std::span<const double> g) {
  model.hessian(kept.H);
  const std::size_t n = kept.H.size() * static_cast<std::size_t>(kept.H.block);
  double mean = 0;
  for (Index j = 0; j < kept.H.size(); ++j)
    for (int c = 0; c < kept.H.block; ++c) mean += kept.H.at(kept.H.offsets[j])[c * (kept.H.block + 1)];
  mean /= static_cast<double>(n);

  // Of the unknowns that the factor has.
  const Vector b = Eigen::Map<const Vector>(g.data(), static_cast<Eigen::Index>(n));
  Vector x(b.size()), y(b.size());
  for (double share = 1e-9; share < 1; share *= 1000) {
    std::vector<double> damping(n);
    for (std::size_t i = 0; i < n; ++i) damping[i] = share * mean * model.held[i % model.held.size()];
    kept.usable = kept.cholesky.factorize(kept.H, damping);
    if (!kept.usable) continue;
    x = b;
    kept.cholesky.solve(span_of(x));
    if (!x.allFinite()) continue;
    multiply(kept.H, span_of(x), span_of(y));
    y += Eigen::Map<const Vector>(damping.data(), y.size()).cwiseProduct(x);
    if ((y - b).norm() <= 1e-6 * b.norm()) return true;
  }
  kept.usable = false;
  return false;
}

GaussNewtonResult gauss_newton(const GaussNewtonModel& model, KeptFactor& kept, const GaussNewtonOptions& options) {
  GaussNewtonResult result;
  const auto of_factor = static_cast<Eigen::Index>(kept.H.size()) * kept.H.block;
  const auto n = model.unknowns > 0 ? static_cast<Eigen::Index>(model.unknowns) : of_factor;
  const auto inverse = [&](Vector& x) {
    model.precondition ? model.precondition(kept.cholesky, span_of(x)) : kept.cholesky.solve(span_of(x));
  };
  double F = model.energy();
  result.energy = F;
  if (n == 0) return result;
  if (!std::isfinite(F)) {
    result.status = Status::Failed;
    result.message = "the energy at the start is not finite";
    return result;
  }
  Vector g(n), former_g(n), step(n);
  // J'J lacks the second derivatives of f: alone it converges linearly where f is not small at the minimum.
  Curvature curvature(6, 1e-10);
  bool fresh = false, accepted = false, renew = !options.keep_factor || !kept.usable;
  double former_length = 0;
  int steps_with_factor = 0;
  result.status = Status::MaxIterations;

  while (result.iterations < options.max_iterations) {
    model.gradient(span_of(g));
    if (accepted && !renew) curvature.add(step, g - former_g);
    accepted = false;
    if (renew) {
      if (!make_factor(model, kept, span_of(g))) {
        result.status = Status::Failed;
        result.message = "the linear system could not be solved to working precision";
        break;
      }
      ++result.factorizations;
      fresh = true;
      renew = false;
      steps_with_factor = 0;
    }
    curvature.solve(inverse, g, step);

    const Trial trial = line_search(model, step, F, fresh);
    if (!std::isfinite(trial.F)) {
      if (!fresh) {
        renew = true;
        curvature.clear();
        continue;
      }
      // Not even a tiny step goes down: rounding level, or a model that does not fit its derivatives.
      const bool flat = 2 * g.lpNorm<Eigen::Infinity>() < std::cbrt(options.epsilon) * (1 + F);
      result.status = flat ? Status::Converged : Status::Stalled;
      if (!flat) result.message = "no step along the Gauss-Newton direction lowers the energy";
      break;
    }
    model.accept();
    accepted = true;
    former_g = g;
    step *= trial.scale;
    ++result.iterations;
    const double decrease = F - trial.F, length = step.norm();
    F = trial.F;
    if (options.on_iteration && !options.on_iteration()) {
      result.status = Status::Stopped;
      break;
    }
    if (converged(options, F, decrease, g, step)) {
      result.status = Status::Converged;
      break;
    }
    // A factor costs about as much as ten steps with it: a new one pays when that many went by and progress is slow
    // still.
    const bool worn = ++steps_with_factor >= 10 && length > 0.7 * former_length;
    renew = !options.keep_factor || worn || trial.scale < 1 || decrease > options.far * (F + decrease);
    if (renew) curvature.clear();
    fresh = false;
    former_length = length;
  }
  result.energy = F;
  return result;
}

}  // namespace sinew
