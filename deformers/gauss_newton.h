#pragma once
/// Gauss-Newton with a factor that is kept: minimises F(x) = f'f by steps -(J'J)^-1 J'f [Sumner et al. 2007, eq. 10-12;
/// Madsen, Nielsen, Tingleff 2004]. F never rises: a step that would raise it is halved. A factor of J'J serves several
/// iterations (and solves) until progress slows, because a step with it costs a tenth of making it; limited-memory BFGS
/// around it makes up for what it lacks. The limit is the same, since the gradient is always exact.

#include <cmath>
#include <functional>
#include <vector>

#include "deformers/sparse_cholesky.h"
#include "engine/geometry/deformer.h"

namespace sinew {

/// What is minimised. x is held by whoever makes the model.
struct GaussNewtonModel {
  std::function<double()> energy;                   ///< F(x)
  std::function<void(std::span<double>)> gradient;  ///< J'f at x (half the gradient of F)
  std::function<void(BlockMatrix&)> hessian;        ///< J'J at x
  std::function<void(std::span<const double>, double)>
      try_step;                          ///< a trial x + scale * step; energy_of_trial goes with it
  std::function<double()> trial_energy;  ///< F(trial)
  std::function<void()> accept;          ///< x <- trial
  /// How strongly each unknown of a block is held where nothing else determines it (`block` numbers, about 1): a free
  /// part moves along those that are held least.
  std::vector<double> held;
  /// How many unknowns there are, where the kept factor has fewer: it is then of the first ones. 0: as many.
  std::size_t unknowns = 0;
  /// x <- M^-1 x, M near J'J, with the help of the kept factor. Empty: x <- factor^-1 x.
  std::function<void(const SparseCholesky&, std::span<double>)> precondition;
};

/// A matrix with its factor and the damping that it needed; kept between solves of the same pattern.
struct KeptFactor {
  BlockMatrix H;
  SparseCholesky cholesky;
  bool usable = false;  ///< a factor of some earlier H is there
};

struct GaussNewtonOptions {
  int max_iterations = 100;
  double epsilon = 1e-6;         ///< of the three tests of eq. 12
  double relative_decrease = 0;  ///< if positive: F must also fall by less than this share of itself
  /// In place of eq. 12: F fell by less than relative_decrease of (1e-6 + F), and no more was to be expected of the
  /// step. For energies that are as steep in some directions as to make the size of their gradient say nothing.
  bool by_expectation = false;
  bool keep_factor = true;  ///< false: the plain method, a new factor in every iteration
  double far = INFINITY;  ///< a step that lowered F by more than this share of it came from afar: a new factor follows
  std::function<bool()> on_iteration;  ///< after each accepted step; false stops
};

struct GaussNewtonResult {
  Status status = Status::Converged;
  std::string message;
  int iterations = 0, factorizations = 0;
  double energy = 0;
};

/// Makes the factor of J'J at x, with the smallest damping that solves J'J s = b exactly; false where none does.
[[nodiscard]] bool make_factor(const GaussNewtonModel& model, KeptFactor& kept, std::span<const double> b);

/// `kept.H` has the pattern and `kept.cholesky` has analysed it.
GaussNewtonResult gauss_newton(const GaussNewtonModel& model, KeptFactor& kept, const GaussNewtonOptions& options);

}  // namespace sinew
