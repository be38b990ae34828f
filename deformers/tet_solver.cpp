#include "deformers/tet_solver.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "deformers/curvature.h"
#include "engine/geometry/check.h"
#include "engine/geometry/union_find.h"

namespace sinew {

namespace {

using Vector = Eigen::VectorXd;

}  // namespace

TetSolver::TetSolver(std::vector<Vec3> vertices, std::vector<Tet> tets)
    : rest_(std::move(vertices)), x_(rest_), tets_(std::move(tets)), energy_(rest_, tets_) {}

void TetSolver::set_x(std::vector<Vec3> x) {
  CHECK(x.size() == rest_.size(), x.size(), rest_.size());
  x_ = std::move(x);
  for (Index j = 0; j < tets_.size(); ++j) energy_.set_rotation(j, Mat3::Identity());
  std::vector<Vec3> g(x_.size());
  energy_.evaluate(x_, TetEnergy::Rotations::Nearest, g);
  from_rest_ = given_rotations_ = false;
  last_turns_.assign(constraints_.handles.size(), std::nullopt);
}

void TetSolver::reset() {
  x_ = rest_;
  for (Index j = 0; j < tets_.size(); ++j) energy_.set_rotation(j, Mat3::Identity());
  from_rest_ = true;
  given_rotations_ = false;
  last_turns_.assign(constraints_.handles.size(), std::nullopt);
}

void TetSolver::set_rotations(std::span<const Mat3> R) {
  CHECK(R.size() == tets_.size(), R.size(), tets_.size());
  for (Index j = 0; j < tets_.size(); ++j) energy_.set_rotation(j, R[j]);
  given_rotations_ = true;
}

/// A connected part of the solid where nothing is held could go anywhere: it stays at rest.
void TetSolver::hold_resting_parts(std::vector<bool>& held) {
  UnionFind parts(rest_.size());
  for (const Tet& tet : tets_)
    for (int c = 1; c < 4; ++c) parts.join(tet[0], tet[static_cast<std::size_t>(c)]);
  std::vector<bool> is_held(rest_.size(), false);
  for (Index v = 0; v < rest_.size(); ++v)
    if (held[v]) is_held[parts.root(v)] = true;
  for (const TetHandle& handle : constraints_.handles)
    for (const TetTie& tie : handle.ties) is_held[parts.root(tie.vertices[0])] = true;
  resting_parts_ = 0;
  for (Index v = 0; v < rest_.size(); ++v) {
    const Index root = parts.root(v);
    if (is_held[root]) continue;
    resting_parts_ += root == v;
    held[v] = true;
    x_[v] = rest_[v];
  }
}

void TetSolver::prepare(TetConstraints constraints) {
  if (prepared_ && constraints == constraints_) return;
  const bool same_handles = prepared_ && constraints.handles == constraints_.handles;
  constraints_ = std::move(constraints);
  energy_.set_stiffness(constraints_.stiffness.empty() ? std::vector<double>(tets_.size(), 1) : constraints_.stiffness);
  energy_.set_groups(constraints_.groups);
  std::vector<TetTie> ties;
  std::vector<bool> held(rest_.size(), false);
  for (const Index v : constraints_.fixed) {
    held[v] = true;
    x_[v] = rest_[v];
  }
  for (const TetHandle& handle : constraints_.handles) {
    for (const Index v : handle.vertices) held[v] = true;
    ties.insert(ties.end(), handle.ties.begin(), handle.ties.end());
  }
  energy_.set_ties(std::move(ties));
  hold_resting_parts(held);
  free_.clear();
  std::vector<Index> number(rest_.size(), TetEnergy::none);
  for (Index v = 0; v < rest_.size(); ++v)
    if (!held[v]) {
      number[v] = static_cast<Index>(free_.size());
      free_.push_back(v);
    }
  const BlockMatrix L = energy_.laplacian(number, static_cast<Index>(free_.size()), TetEnergy::Ties::Yes);
  cholesky_.forget();
  if (!free_.empty()) {
    cholesky_.analyse(L);
    (void)cholesky_.factorize(L);  // solve() asks whether there is one
  }
  fields_.clear();
  if (!same_handles) last_turns_.assign(constraints_.handles.size(), std::nullopt);
  prepared_ = true;
}

/// Held vertices and the targets of ties, where they are to be.
void TetSolver::place(std::span<const TetTarget> targets) {
  std::vector<Vec3> ties;
  for (std::size_t h = 0; h < targets.size(); ++h) {
    const TetHandle& handle = constraints_.handles[h];
    for (std::size_t i = 0; i < handle.vertices.size(); ++i) x_[handle.vertices[i]] = targets[h].positions[i];
    ties.insert(ties.end(), targets[h].positions.begin() + static_cast<std::ptrdiff_t>(handle.vertices.size()),
                targets[h].positions.end());
  }
  energy_.set_targets(std::move(ties));
}

/// x <- argmin E for the rotations that are there: eq. 2.1. False where the factor gives nothing finite.
bool TetSolver::linear_step(TetEnergy::Rotations rotations) {
  std::vector<Vec3> g(rest_.size());
  energy_.evaluate(x_, rotations, g);
  std::vector<double> p(3 * free_.size());
  for (std::size_t i = 0; i < free_.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) p[3 * i + c] = g[free_[i]][static_cast<Eigen::Index>(c)];
  cholesky_.solve_three(p);
  for (std::size_t i = 0; i < free_.size(); ++i) x_[free_[i]] -= Vec3(p[3 * i], p[3 * i + 1], p[3 * i + 2]);
  return std::all_of(p.begin(), p.end(), [](double v) { return std::isfinite(v); });
}

SolveReport TetSolver::solve(std::span<const TetTarget> targets, const SolveOptions& options,
                             const std::function<bool()>& on_iteration) {
  CHECK(prepared_ && targets.size() == constraints_.handles.size(), targets.size(), constraints_.handles.size());
  const auto begin = std::chrono::steady_clock::now();
  const bool final_answer = options.quality == SolveOptions::Quality::Final;
  SolveReport report;
  std::vector<Vec3> g(rest_.size());
  const auto failed = [&](const char* why) {
    report.status = Status::Failed;
    report.message = why;
    return report;
  };
  if (!free_.empty() && !cholesky_.factorized())
    return failed("The Laplacian of the tets could not be factorized: some tets are flat to working precision.");
  const std::vector<Vec3> before = x_;
  turn_handles(targets, turns_to(targets));
  place(targets);
  if (!free_.empty() && !linear_step(TetEnergy::Rotations::Kept)) {
    x_ = before;
    return failed("The linear solve gave numbers that are not finite.");
  }
  for (std::size_t h = 0; h < targets.size(); ++h) last_turns_[h] = targets[h].turn;
  from_rest_ = given_rotations_ = false;

  const auto flat = [&](const std::vector<Vec3>& full) {
    Vector out(3 * static_cast<Eigen::Index>(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i) out.segment<3>(3 * static_cast<Eigen::Index>(i)) = full[free_[i]];
    return out;
  };
  const auto solve_factor = [&](Vector& v) { cholesky_.solve_three({v.data(), static_cast<std::size_t>(v.size())}); };
  double weight = 0;
  for (const Tet& tet : tets_) {
    const Vec3 &a = rest_[tet[0]], &b = rest_[tet[1]], &c = rest_[tet[2]], &d = rest_[tet[3]];
    weight += std::abs((b - a).cross(c - a).dot(d - a)) / 6;
  }
  const double nothing = 1e-18 * weight;  // rounding of |T - R| about 1e-9
  const double share = final_answer ? options.epsilon : 1e2 * options.epsilon;
  double E = energy_.evaluate(x_, TetEnergy::Rotations::Nearest, g);
  Vector gradient = flat(g);
  Curvature memory(8, 1e-12);
  std::vector<Vec3> trial = x_, trial_g(rest_.size());
  report.status = free_.empty() ? Status::Converged : Status::MaxIterations;
  int small_steps = 0;
  while (!free_.empty() && report.iterations < options.max_iterations) {
    Vector p;
    memory.solve(solve_factor, gradient, p);
    double slope = 2 * gradient.dot(p);
    if (!(slope < 0)) {
      memory.clear();
      memory.solve(solve_factor, gradient, p);
      slope = 2 * gradient.dot(p);
    }
    if (!(slope < 0) || !p.allFinite()) {
      report.status = gradient.isZero(0) ? Status::Converged : Status::Stalled;
      break;
    }
    // -slope / 2 is what the model expects the step to gain.
    small_steps = -0.5 * slope <= share * E + nothing ? small_steps + 1 : 0;
    double t = 1, trial_E = 0;
    bool accepted = false;
    for (int halving = 0; halving < 12 && !accepted; ++halving, t *= 0.5) {
      for (std::size_t i = 0; i < free_.size(); ++i)
        trial[free_[i]] = x_[free_[i]] + t * p.segment<3>(3 * static_cast<Eigen::Index>(i));
      trial_E = energy_.evaluate(trial, TetEnergy::Rotations::Nearest, trial_g);
      accepted = trial_E <= E + 1e-4 * t * slope;
      if (accepted) break;
    }
    if (!accepted && !memory.empty()) {
      memory.clear();
      continue;
    }
    if (!accepted) {  // at the limit of rounding
      energy_.evaluate(x_, TetEnergy::Rotations::Nearest, g);
      report.status = -slope <= 1e-3 * share * E + nothing ? Status::Converged : Status::Stalled;
      break;
    }
    Vector next = flat(trial_g);
    memory.add(t * p, next - gradient);
    std::swap(gradient, next);
    for (const Index v : free_) x_[v] = trial[v];
    E = trial_E;
    ++report.iterations;
    if (on_iteration && !on_iteration()) {
      report.status = Status::Stopped;
      break;
    }
    if (small_steps >= 3) {
      report.status = Status::Converged;
      break;
    }
  }
  report.energy = {{"total", E}, {"constraint", energy_.tie_energy()}};
  report.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

}  // namespace sinew
