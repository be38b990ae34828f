#include "deformers/graph_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "engine/geometry/rotation.h"

namespace sinew {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One handle alone carries its part along rather than turning it.
const std::vector<double> rigid_held = {1, 1, 1, 1e-3, 1e-3, 1e-3};

}  // namespace

GraphSolver::GraphSolver(std::vector<Vec3> nodes, std::vector<std::pair<Index, Index>> edges, GraphWeights weights,
                         bool plain)
    : nodes_(std::move(nodes)),
      edges_(std::move(edges)),
      weights_(weights),
      plain_(plain),
      start_nodes_(nodes_),
      x_(GraphState::rest(nodes_.size())) {
  prepare(std::vector<bool>(nodes_.size(), false), {});
}

/// Nodes that are not fixed and whose component has a fixed node or a handle: the others have nothing that determines
/// them.
std::vector<bool> GraphSolver::moving_nodes(const std::vector<bool>& fixed) const {
  std::vector<Index> parent(nodes_.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [j, k] : edges_) parent[root(j)] = root(k);
  std::vector<bool> constrained(nodes_.size(), false);
  for (Index j = 0; j < nodes_.size(); ++j)
    if (fixed[j]) constrained[root(j)] = true;
  for (const GraphHandle& handle : handles_)
    for (const Index j : handle.nodes) constrained[root(j)] = true;
  std::vector<bool> moving(nodes_.size());
  for (Index j = 0; j < nodes_.size(); ++j) moving[j] = !fixed[j] && constrained[root(j)];
  return moving;
}

bool GraphSolver::same_pattern(const std::vector<bool>& fixed, const std::vector<GraphHandle>& handles) const {
  return fixed == fixed_ && std::equal(handles.begin(), handles.end(), handles_.begin(), handles_.end(),
                                       [](const GraphHandle& a, const GraphHandle& b) { return a.nodes == b.nodes; });
}

void GraphSolver::prepare(const std::vector<bool>& fixed, std::vector<GraphHandle> handles) {
  CHECK(fixed.size() == nodes_.size(), fixed.size(), nodes_.size());
  const bool same = same_pattern(fixed, handles);
  handles_ = std::move(handles);
  if (same) {
    energy_.move(nodes_, handles_);
    rigid_.usable = affine_.usable = false;
  } else {
    fixed_ = fixed;
    free_ = moving_nodes(fixed);
    resting_ = 0;
    for (Index j = 0; j < nodes_.size(); ++j) resting_ += !free_[j] && !fixed[j];
    energy_.build(nodes_, edges_, free_, handles_, weights_);
    rigid_ = {energy_.hessian_pattern(6), {}, false};
    rigid_.cholesky.analyse(rigid_.H);
    affine_ = {};
    affine_ready_ = false;
  }
  rest_what_is_held();
}

void GraphSolver::move_nodes(std::vector<Vec3> nodes) {
  CHECK(nodes.size() == nodes_.size(), nodes.size(), nodes_.size());
  nodes_ = std::move(nodes);
  moved_ = true;
}

void GraphSolver::set_x(GraphState x) {
  CHECK(x.R.size() == nodes_.size() && x.t.size() == nodes_.size(), x.R.size(), nodes_.size());
  x_ = std::move(x);
  start_nodes_ = nodes_;
  started_ = true;
  moved_ = false;
  rigid_.usable = affine_.usable = false;  // factors of another x steer the way to the minimum, and its last digits
}

/// Nodes that do not move go to rest. Not when x is set: that comes before the constraints it belongs to are known.
void GraphSolver::rest_what_is_held() {
  for (Index j = 0; j < nodes_.size(); ++j)
    if (!free_[j]) {
      x_.R[j].setIdentity();
      x_.t[j].setZero();
    }
}

GaussNewtonResult GraphSolver::minimise_rigid(const GaussNewtonOptions& options) {
  for (const Index j : energy_.free_nodes()) x_.R[j] = nearest_rotation(x_.R[j]);
  GraphState trial;
  GaussNewtonModel model;
  model.energy = [&] { return energy_.energy(x_, true).total(); };
  model.gradient = [&](std::span<double> g) { energy_.gradient_rigid(x_, g); };
  model.hessian = [&](BlockMatrix& H) { energy_.hessian_rigid(x_, H); };
  model.try_step = [&](std::span<const double> step, double scale) { trial = energy_.step_rigid(x_, step, scale); };
  model.trial_energy = [&] { return energy_.energy(trial, true).total(); };
  model.accept = [&] { std::swap(x_, trial); };
  model.held = rigid_held;
  return gauss_newton(model, rigid_, options);
}

/// The 12 unknowns a node. Where w_rot is small, the factor of 6 steers badly.
GaussNewtonResult GraphSolver::minimise_to_the_end(GaussNewtonOptions options) {
  options.relative_decrease = 1e-8;  // the minimum to 1e-6 of the energy, also where the energy is small
  if (plain_) return minimise_affine(options);
  constexpr int enough = 40;
  const int wanted = options.max_iterations;
  options.max_iterations = std::min(wanted, enough);
  GaussNewtonResult result = minimise_polar(energy_, x_, rigid_, options);
  if (result.iterations == wanted || result.status == Status::Converged || result.status == Status::Stopped)
    return result;
  options.max_iterations = wanted - result.iterations;
  const int before = result.iterations;
  result = minimise_affine(options);
  result.iterations += before;
  return result;
}

GaussNewtonResult GraphSolver::minimise_affine(const GaussNewtonOptions& options) {
  if (!affine_ready_) {
    affine_ = {energy_.hessian_pattern(12), {}, false};
    affine_.cholesky.analyse(affine_.H);
    affine_ready_ = true;
  }
  std::vector<Mat3> Q(nodes_.size(), Mat3::Identity());
  for (const Index j : energy_.free_nodes()) Q[j] = nearest_rotation(x_.R[j]);
  GraphState trial;
  GaussNewtonModel model;
  model.energy = [&] { return energy_.energy(x_, false).total(); };
  model.gradient = [&](std::span<double> g) { energy_.gradient_affine(x_, Q, g); };
  model.hessian = [&](BlockMatrix& H) { energy_.hessian_affine(x_, Q, H); };
  model.try_step = [&](std::span<const double> step, double scale) { trial = energy_.step_affine(x_, Q, step, scale); };
  model.trial_energy = [&] { return energy_.energy(trial, false).total(); };
  model.accept = [&] { std::swap(x_, trial); };
  model.held.assign(12, 1);
  std::fill(model.held.begin() + 9, model.held.end(), 1e-3);
  return gauss_newton(model, affine_, options);
}

/// R_j, that was set before the nodes moved, to the same map of the surroundings of j as they are turned now.
void GraphSolver::turn_x() {
  const std::vector<Mat3> turns = turns_between(start_nodes_, nodes_, edges_, energy_.free_nodes());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    Mat3& R = x_.R[energy_.free_nodes()[i]];
    R = turns[i] * R * turns[i].transpose();
  }
}

SolveReport GraphSolver::solve(std::span<const Vec3> targets, const SolveOptions& options,
                               const std::function<bool()>& on_iteration) {
  const auto start = std::chrono::steady_clock::now();
  const bool final_answer = options.quality == SolveOptions::Quality::Final;
  energy_.set_targets(targets);
  rest_what_is_held();
  GaussNewtonOptions plan;
  plan.max_iterations = options.max_iterations;
  plan.epsilon = options.epsilon;
  plan.keep_factor = !plain_;
  plan.on_iteration = on_iteration;
  // Another frame of the animation starts from its key, turned with its parts: near enough for the last phase.
  const bool next_frame = started_ && moved_ && final_answer && !plain_;
  if (next_frame) turn_x();
  started_ = moved_ = false;
  GaussNewtonResult result;
  SolveReport report;
  if (!plain_ && !next_frame) {
    result = minimise_rigid(plan);
    report.iterations = result.iterations;
  }
  const bool go_on = result.status == Status::Converged || result.status == Status::Stalled;
  if (plain_ || (final_answer && go_on && result.iterations < options.max_iterations)) {
    plan.max_iterations -= report.iterations;
    result = minimise_to_the_end(plan);
    report.iterations += result.iterations;
  }
  report.status = result.status;
  report.message = result.message;
  const GraphEnergy::Terms terms = energy_.energy(x_, false);
  report.energy = {{"total", terms.total()},
                   {"rotation", terms.rotation},
                   {"regularization", terms.regularization},
                   {"constraint", terms.constraint}};
  const double unknowns = 12.0 * static_cast<double>(energy_.free_count());
  report.counts = {{"unknowns", unknowns},
                   {"nodes", static_cast<double>(nodes_.size())},
                   {"edges", static_cast<double>(edges_.size())}};
  std::tie(report.handle_rms, report.handle_max) = energy_.handle_error(x_);
  if (resting_ > 0 && report.message.empty())
    report.message = std::to_string(resting_) + " of " + std::to_string(nodes_.size()) +
                     " nodes rest: nothing they are joined to is fixed or a handle";
  report.solve_seconds = seconds_since(start);
  return report;
}

}  // namespace sinew
