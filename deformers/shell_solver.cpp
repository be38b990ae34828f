#include "deformers/shell_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/geometry/affine.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/check.h"
#include "engine/geometry/union_find.h"

namespace sinew {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

std::span<double> span_of(Matrix& m, Eigen::Index column) {
  return {m.col(column).data(), static_cast<std::size_t>(m.rows())};
}

}  // namespace

/// What gauss_newton minimises: F = 2 E over the free vertices, then the examples' weights that are not pinned.
struct ShellSolver::Model {
  explicit Model(ShellSolver& solver) : s(solver) {}

  ShellSolver& s;
  std::vector<std::size_t> which;  ///< examples whose weights are unknowns
  std::vector<Vec3> trial_x;
  std::vector<double> trial_alpha;
  ShellEnergy::Normal normal;
  bool ready = false;  ///< what follows belongs to the kept factor
  Matrix B, Z;         ///< Z = A^-1 B
  Eigen::LDLT<Matrix> schur;
  Vector u, z;    ///< z = M0^-1 u, M0 = [A B; B' C]
  double uz = 0;  ///< u' z

  Eigen::Index n() const { return 3 * static_cast<Eigen::Index>(s.count_); }
  Eigen::Index k() const { return static_cast<Eigen::Index>(which.size()); }

  double energy_of(const std::vector<Vec3>& x, const std::vector<double>& alpha) {
    s.energy_.set_weights(alpha);
    return 2 * s.energy_.energy(x).total();
  }

  void gradient(std::span<double> g) {
    s.energy_.set_weights(s.alpha_);
    std::vector<double> by_alpha(s.alpha_.size());
    s.energy_.gradient(s.x_, g.first(static_cast<std::size_t>(n())), by_alpha);
    for (std::size_t p = 0; p < which.size(); ++p) g[static_cast<std::size_t>(n()) + p] = by_alpha[which[p]];
  }

  void hessian(BlockMatrix& A) {
    s.energy_.set_weights(s.alpha_);
    s.energy_.hessian(s.x_, A, normal);
    ready = false;
  }

  /// B, C and u of the unknown weights alone; then all that a solve needs beside A's factor.
  void make_ready(const SparseCholesky& A) {
    const auto all = static_cast<Eigen::Index>(s.alpha_.size());
    const Eigen::Map<const Matrix> B_all(normal.B.data(), n(), all), C_all(normal.C.data(), all, all);
    const Eigen::Map<const Vector> u_all(normal.u.data(), n() + all);
    B.resize(n(), k());
    Matrix C(k(), k());
    u.resize(n() + k());
    u.head(n()) = u_all.head(n());
    for (Eigen::Index p = 0; p < k(); ++p) {
      const auto i = static_cast<Eigen::Index>(which[static_cast<std::size_t>(p)]);
      B.col(p) = B_all.col(i);
      u[n() + p] = u_all[n() + i];
      for (Eigen::Index q = 0; q < k(); ++q)
        C(p, q) = C_all(i, static_cast<Eigen::Index>(which[static_cast<std::size_t>(q)]));
    }
    solve_columns(A);
    // Where handles leave weights undetermined the complement is singular: a damping keeps the step short there.
    C.diagonal() *= 1 + 1e-6;
    schur.compute(C - B.transpose() * Z);
    add_schur(z);
    uz = u.dot(z);
    ready = true;
  }

  /// Z = A^-1 B and z = A^-1 u, three at a time.
  void solve_columns(const SparseCholesky& A) {
    Z = B;
    z = u;
    const auto column = [&](Eigen::Index c) { return Eigen::Map<Vector>(c < k() ? Z.col(c).data() : z.data(), n()); };
    Matrix side_by_side(3, n());
    for (Eigen::Index first = 0; first <= k(); first += 3) {
      side_by_side.setZero();
      const Eigen::Index count = std::min<Eigen::Index>(3, k() + 1 - first);
      for (Eigen::Index c = 0; c < count; ++c) side_by_side.row(c) = column(first + c).transpose();
      A.solve_three({side_by_side.data(), static_cast<std::size_t>(side_by_side.size())});
      for (Eigen::Index c = 0; c < count; ++c) column(first + c) = side_by_side.row(c).transpose();
    }
  }

  /// v <- M0^-1 v.
  void without_volume(const SparseCholesky& A, Vector& v) const {
    A.solve({v.data(), static_cast<std::size_t>(n())});
    add_schur(v);
  }

  /// The rest of that, where A^-1 was applied to the vertices' part.
  void add_schur(Vector& v) const {
    if (k() == 0) return;
    const Vector a = schur.solve(v.tail(k()) - B.transpose() * v.head(n()));
    v.tail(k()) = a;
    v.head(n()) -= Z * a;
  }

  void precondition(const SparseCholesky& A, std::span<double> g) {
    if (!ready) make_ready(A);
    Eigen::Map<Vector> out(g.data(), static_cast<Eigen::Index>(g.size()));
    Vector y = out;
    without_volume(A, y);
    out = y - z * (u.dot(y) / (1 + uz));
  }

  void try_step(std::span<const double> step, double scale) {
    trial_x = s.x_;
    for (std::size_t v = 0; v < trial_x.size(); ++v)
      if (const Index i = s.number_[v]; i != ShellEdge::none)
        for (std::size_t c = 0; c < 3; ++c) trial_x[v][static_cast<Eigen::Index>(c)] += scale * step[3 * i + c];
    trial_alpha = s.alpha_;
    for (std::size_t p = 0; p < which.size(); ++p)
      trial_alpha[which[p]] += scale * step[static_cast<std::size_t>(n()) + p];
  }
};

ShellSolver::ShellSolver(std::vector<std::vector<Vec3>> poses, std::vector<Triangle> triangles,
                         ShellStiffness stiffness, std::vector<Vec3> source)
    : poses_(std::move(poses)),
      base_(source.empty() ? poses_.front() : std::move(source)),
      triangles_(std::move(triangles)),
      energy_(poses_, triangles_, stiffness, base_),
      model_(std::make_unique<Model>(*this)),
      x_(rest()),
      alpha_(poses_.size() - 1, 0) {
  for (std::size_t k = 0; k < alpha_.size(); ++k) model_->which.push_back(k);
  if (const double size = bounds_of(base_).diagonal(); size > 0) base_scale_ = bounds_of(rest()).diagonal() / size;
  UnionFind sets(x_.size());
  for (const Triangle& t : triangles_)
    for (const Index v : t) sets.join(t[0], v);
  std::vector<Index> number(x_.size(), ShellEdge::none);
  for (Index v = 0; v < x_.size(); ++v) {
    Index& part = number[sets.root(v)];
    if (part == ShellEdge::none) part = static_cast<Index>(parts_++);
    part_.push_back(part);
  }
  number_unknowns();
}

ShellSolver::~ShellSolver() = default;

void ShellSolver::prepare(const ShellHeld& held) {
  if (held == held_) return;
  const bool same_pattern =
      held.vertices == held_.vertices && held.ties == held_.ties && held.stiffness == held_.stiffness;
  held_ = held;
  if (!same_pattern) number_unknowns();
  model_->which.clear();
  const bool anything = !held_.vertices.empty() || !held_.ties.empty();
  for (std::size_t k = 0; k < alpha_.size() && anything; ++k)
    if (k >= held_.weights.size() || !held_.weights[k]) model_->which.push_back(k);
  kept_.usable = false;
}

void ShellSolver::number_unknowns() {
  std::vector<bool> held(x_.size(), false), driven(parts_, false);
  for (const Index v : held_.vertices) held[v] = driven[part_[v]] = true;
  for (const ShellTie& tie : held_.ties) driven[part_[tie.corners[0]]] = true;
  loose_.assign(parts_, false);
  resting_ = 0;
  for (std::size_t p = 0; p < parts_; ++p) {
    if (driven[p]) continue;
    loose_[p] = energy_.examples() > 0;
    resting_ += !loose_[p];
  }
  number_.assign(x_.size(), ShellEdge::none);
  count_ = 0;
  for (Index v = 0; v < x_.size(); ++v)
    if (!held[v] && (driven[part_[v]] || loose_[part_[v]])) number_[v] = count_++;
  energy_.set_unknowns(number_, count_, held_.stiffness);
  energy_.set_ties(held_.ties);
  kept_ = {energy_.pattern(), {}, false};
  kept_.cholesky.analyse(kept_.H);
}

void ShellSolver::reset() {
  x_ = rest();
  std::fill(alpha_.begin(), alpha_.end(), 0);
  kept_.usable = false;
}

void ShellSolver::set_x(std::vector<Vec3> x) {
  CHECK(x.size() == x_.size(), x.size(), x_.size());
  x_ = std::move(x);
  kept_.usable = false;
  energy_.set_weights(alpha_);
  alpha_ = energy_.best_weights(x_, held_.weights);
}

/// Parts that nothing holds, over the blend of the poses.
void ShellSolver::lay_free_parts() {
  for (Index part = 0; part < parts_; ++part) {
    if (!loose_[part]) continue;
    std::vector<Vec3> from, to;
    for (std::size_t v = 0; v < x_.size(); ++v) {
      if (part_[v] != part) continue;
      from.push_back(x_[v]);
      to.push_back(poses_[0][v]);
      for (std::size_t k = 0; k < alpha_.size(); ++k)
        to.back() += alpha_[k] * base_scale_ * (poses_[k + 1][v] - base_[v]);
    }
    const Affine fit = rigid_fit(from, to);
    for (std::size_t v = 0; v < x_.size(); ++v)
      if (part_[v] == part) x_[v] = fit.leftCols<3>() * x_[v] + fit.col(3);
  }
}

GaussNewtonModel ShellSolver::model() {
  Model& m = *model_;
  GaussNewtonModel out;
  out.energy = [&m] { return m.energy_of(m.s.x_, m.s.alpha_); };
  out.gradient = [&m](std::span<double> g) { m.gradient(g); };
  out.hessian = [&m](BlockMatrix& H) { m.hessian(H); };
  out.try_step = [&m](std::span<const double> step, double scale) { m.try_step(step, scale); };
  out.trial_energy = [&m] { return m.energy_of(m.trial_x, m.trial_alpha); };
  out.accept = [&m] {
    std::swap(m.s.x_, m.trial_x);
    std::swap(m.s.alpha_, m.trial_alpha);
  };
  out.held = {1, 1, 1};
  out.unknowns = 3 * static_cast<std::size_t>(count_) + m.which.size();
  out.precondition = [&m](const SparseCholesky& A, std::span<double> g) { m.precondition(A, g); };
  return out;
}

/// Where nothing is held, from the example that more than half is taken of, not from rest: there E has steps and minima
/// between the two, and beside each of the poses is the lower one.
void ShellSolver::begin_near_a_pose() {
  if (!held_.vertices.empty() || !held_.ties.empty() || x_ != rest() || base_ != rest()) return;
  const auto most = std::max_element(alpha_.begin(), alpha_.end());
  if (most != alpha_.end() && *most > 0.5) x_ = poses_[static_cast<std::size_t>(most - alpha_.begin()) + 1];
}

/// Moves what is held to its targets and everything else as it goes along to first order: the step that makes J'J of
/// both together zero where the free ones are.
void ShellSolver::go_to(std::span<const Vec3> targets) {
  set_tie_targets(targets);
  std::vector<Vec3> d(x_.size(), Vec3::Zero());
  double farthest = 0;
  for (std::size_t i = 0; i < held_.vertices.size(); ++i) {
    d[held_.vertices[i]] = targets[i] - x_[held_.vertices[i]];
    farthest = std::max(farthest, d[held_.vertices[i]].norm());
  }
  const GaussNewtonModel gn = model();
  if (farthest > 1e-12 && gn.unknowns > 0) {
    energy_.set_weights(alpha_);
    const std::vector<double> pushed = energy_.response(x_, d);
    std::vector<double> step(gn.unknowns);
    std::copy_n(pushed.begin(), 3 * count_, step.begin());
    for (std::size_t p = 0; p < model_->which.size(); ++p) step[3 * count_ + p] = pushed[3 * count_ + model_->which[p]];
    if (make_factor(gn, kept_, step)) {
      gn.precondition(kept_.cholesky, step);
      for (double& number : step) number = -number;
      take_best(gn, step, targets);
    }
  }
  snap_to(targets);
}

void ShellSolver::set_tie_targets(std::span<const Vec3> targets) {
  energy_.set_targets({targets.begin() + static_cast<std::ptrdiff_t>(held_.vertices.size()), targets.end()});
}

/// The held vertices alone.
void ShellSolver::snap_to(std::span<const Vec3> targets) {
  for (std::size_t i = 0; i < held_.vertices.size(); ++i) x_[held_.vertices[i]] = targets[i];
}

/// As much of the step as makes F least, with what is held at its targets: thin shells have motions that cost next to
/// nothing to first order, and the whole step may go far along these.
void ShellSolver::take_best(const GaussNewtonModel& gn, std::span<const double> step, std::span<const Vec3> targets) {
  double best = 0, least = INFINITY;
  const auto go = [&](double scale) {
    gn.try_step(step, scale);
    for (std::size_t i = 0; i < held_.vertices.size(); ++i) model_->trial_x[held_.vertices[i]] = targets[i];
  };
  for (double scale : {1.0, 0.5, 0.25, 0.1, 0.0}) {
    go(scale);
    const double F = gn.trial_energy();
    if (!(F < least)) continue;
    least = F;
    best = scale;
  }
  go(best);
  gn.accept();
}

SolveReport ShellSolver::solve(const Path& path, int stretches, const SolveOptions& options,
                               const std::function<bool()>& on_iteration) {
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < std::min(alpha_.size(), held_.weights.size()); ++k)
    if (held_.weights[k]) alpha_[k] = *held_.weights[k];
  begin_near_a_pose();
  const bool final_answer = options.quality == SolveOptions::Quality::Final;
  GaussNewtonOptions own;
  own.epsilon = options.epsilon;
  own.far = 0.02;
  own.by_expectation = true;
  own.relative_decrease = final_answer ? options.epsilon : 1e-3;
  own.on_iteration = [&] { return !on_iteration || on_iteration(); };
  // Most iterations reuse a factor: three of them cost what one does that makes a factor.
  const int most = (final_answer ? 3 : 1) * options.max_iterations;
  GaussNewtonResult result;
  int iterations = 0;
  if (stretches == 0) {
    set_tie_targets(path(1));
    snap_to(path(1));
  }
  for (int i = std::min(1, stretches); i <= stretches; ++i) {
    if (i > 0) go_to(path(static_cast<double>(i) / stretches));
    const int left = most - iterations;
    // While something is dragged the next move comes before the minimum: it is approached over several of them.
    own.max_iterations = i < stretches ? std::min(2, left) : final_answer ? left : std::min(8, left);
    if (stretches > 1) kept_.usable = false;
    result = gauss_newton(model(), kept_, own);
    iterations += result.iterations;
    if (result.status == Status::Stopped || result.status == Status::Failed) break;
  }
  lay_free_parts();

  SolveReport report;
  report.status = result.status;
  report.message = result.message;
  if (const std::size_t flat = energy_.collapsed(x_); result.status == Status::Stalled && flat > 0)
    report.message = "no step lowers the energy further: " + std::to_string(flat) +
                     (flat == 1 ? " triangle has lost most of its area" : " triangles have lost most of their area");
  report.iterations = iterations;
  energy_.set_weights(alpha_);
  const ShellEnergy::Terms terms = energy_.energy(x_);
  report.energy = {
      {"total", terms.total()}, {"stretch", terms.stretch}, {"bend", terms.bend}, {"volume", terms.volume}};
  report.example_weights = alpha_;
  report.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

SolveReport ShellSolver::solve_twice(const Path& path, int stretches, const SolveOptions& options,
                                     const std::function<bool()>& on_iteration) {
  const std::vector<Vec3> start = x_;
  const std::vector<double> start_alpha = alpha_;
  SolveReport report = solve(path, stretches, options, on_iteration);
  if (report.status == Status::Stopped) return report;
  std::vector<Vec3> x = std::exchange(x_, start);
  std::vector<double> alpha = std::exchange(alpha_, start_alpha);
  kept_.usable = false;
  SolveReport second = solve(path, 0, options, on_iteration);
  const int iterations = report.iterations + second.iterations;
  const double seconds = report.solve_seconds + second.solve_seconds;
  const bool better = second.energy.front().second < report.energy.front().second;
  if (better && second.status != Status::Stopped) {
    report = std::move(second);
  } else {
    x_ = std::move(x);
    alpha_ = std::move(alpha);
    if (second.status == Status::Stopped) report.status = second.status;
  }
  report.iterations = iterations;
  report.solve_seconds = seconds;
  return report;
}

}  // namespace sinew
