#include "deformers/gauss_newton.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace sinew {

namespace {

using Vector = Eigen::VectorXd;

std::span<double> span_of(Vector& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

/// Factorizes J'J with the smallest damping that makes the solve exact: the free motions of a part without anything
/// fixed are null directions of J'J, which a damping of 1e-9 of the mean diagonal holds still without being felt
/// elsewhere.
bool factorize(const GaussNewtonModel& model, KeptFactor& kept, const Vector& g) {
  model.hessian(kept.H);
  const std::size_t n = kept.H.size() * static_cast<std::size_t>(kept.H.block);
  double mean = 0;
  for (Index j = 0; j < kept.H.size(); ++j)
    for (int c = 0; c < kept.H.block; ++c) mean += kept.H.at(kept.H.offsets[j])[c * (kept.H.block + 1)];
  mean /= static_cast<double>(n);

  Vector x(g.size()), y(g.size());
  for (double share = 1e-9; share < 1; share *= 1000) {
    std::vector<double> damping(n);
    for (std::size_t i = 0; i < n; ++i) damping[i] = share * mean * model.held[i % model.held.size()];
    kept.usable = kept.cholesky.factorize(kept.H, damping);
    if (!kept.usable) continue;
    x = g;
    kept.cholesky.solve(span_of(x));
    if (!x.allFinite()) continue;
    multiply(kept.H, span_of(x), span_of(y));
    y += Eigen::Map<const Vector>(damping.data(), y.size()).cwiseProduct(x);
    if ((y - g).norm() <= 1e-6 * g.norm()) return true;
  }
  kept.usable = false;
  return false;
}

}  // namespace

GaussNewtonResult gauss_newton(const GaussNewtonModel& model, KeptFactor& kept, const GaussNewtonOptions& options) {
  GaussNewtonResult result;
  const auto n = static_cast<Eigen::Index>(kept.H.size()) * kept.H.block;
  double F = model.energy();
  result.energy = F;
  if (n == 0) return result;
  if (!std::isfinite(F)) {
    result.status = Status::Failed;
    result.message = "the energy at the start is not finite";
    return result;
  }
  const double root = std::cbrt(options.epsilon);
  Vector g(n), step(n);
  bool fresh = false, renew = !options.keep_factor || !kept.usable;
  double former_length = 0;
  result.status = Status::MaxIterations;

  while (result.iterations < options.max_iterations) {
    model.gradient(span_of(g));
    if (renew) {
      if (!factorize(model, kept, g)) {
        result.status = Status::Failed;
        result.message = "the linear system could not be solved to working precision";
        break;
      }
      ++result.factorizations;
      fresh = true;
      renew = false;
    }
    step = -g;
    kept.cholesky.solve(span_of(step));

    double scale = 1, F_trial = INFINITY;
    for (; scale > 1e-10; scale *= 0.5) {
      model.try_step({step.data(), static_cast<std::size_t>(n)}, scale);
      F_trial = model.trial_energy();
      if (F_trial <= F) break;
      if (!fresh) break;  // an old factor gave a bad step: make a new one rather than a short step
    }
    if (!(F_trial <= F)) {
      if (!fresh) {
        renew = true;
        continue;
      }
      // Not even a tiny step goes down: rounding level, or a model that does not fit its derivatives.
      const bool flat = 2 * g.lpNorm<Eigen::Infinity>() < root * (1 + F);
      result.status = flat ? Status::Converged : Status::Stalled;
      if (!flat) result.message = "no step along the Gauss-Newton direction lowers the energy";
      break;
    }
    model.accept();
    ++result.iterations;
    const double decrease = F - F_trial, length = scale * step.norm(), largest = scale * step.lpNorm<Eigen::Infinity>();
    F = F_trial;

    // Eq. 12; the gradient of F is 2 J'f.
    const bool energy_still = decrease < options.epsilon * (1 + F) &&
                              (options.relative_decrease <= 0 || decrease <= options.relative_decrease * F);
    const bool flat = 2 * g.lpNorm<Eigen::Infinity>() < root * (1 + F);
    const bool at_rest = largest < root * (1 + largest);
    if (options.on_iteration && !options.on_iteration()) {
      result.status = Status::Stopped;
      break;
    }
    if (energy_still && flat && at_rest) {
      result.status = Status::Converged;
      break;
    }
    // A new factor pays when the steps with the old one shrink too slowly, or had to be cut.
    const bool slow = former_length > 0 && length > 0.3 * former_length;
    renew = !options.keep_factor || slow || scale < 1;
    fresh = false;
    former_length = renew ? 0 : length;
  }
  result.energy = F;
  return result;
}

}  // namespace sinew
