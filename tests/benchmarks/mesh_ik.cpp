#include "tests/benchmarks/mesh_ik.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/geometry/check.h"
#include "engine/geometry/rotation.h"
#include "engine/geometry/topology.h"

namespace sinew::benchmarks {

namespace {

constexpr Index none = ~Index{0};

Mat3 cross_of(const Vec3& v) {
  Mat3 out;
  out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return out;
}

Mat3 exponential(const Vec3& turn) {
  return Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
}

/// J with exp(u + du) = exp(J du) exp(u) to first order.
Mat3 left_jacobian(const Vec3& u) {
  const double angle2 = u.squaredNorm(), angle = std::sqrt(angle2);
  const Mat3 U = cross_of(u);
  if (angle < 1e-4) return Mat3::Identity() + (0.5 - angle2 / 24) * U + (1.0 / 6 - angle2 / 120) * U * U;
  return Mat3::Identity() + (1 - std::cos(angle)) / angle2 * U + (angle - std::sin(angle)) / (angle2 * angle) * U * U;
}

/// Two edges and the scaled normal.
Mat3 edges_of(std::span<const Vec3> x, const MeshIk::Triangle& t) {
  const Vec3 a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]], n = a.cross(b);
  const double length = n.norm();
  Mat3 out;
  out << a, b, (length > 0 ? Vec3(n / std::sqrt(length)) : Vec3(0, 0, 0));
  return out;
}

double product(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

Components parts_of(std::size_t vertices, std::span<const MeshIk::Triangle> triangles) {
  Shape shape;
  shape.positions.assign(vertices, Vec3(0, 0, 0));
  for (const MeshIk::Triangle& t : triangles) shape.faces.add(t);
  return connected_components(shape);
}

}  // namespace

MeshIk::MeshIk(std::vector<Vec3> rest, std::vector<Triangle> triangles, std::vector<std::vector<Vec3>> examples,
               std::vector<Index> held)
    : rest_(std::move(rest)), triangles_(std::move(triangles)), examples_(std::move(examples)), held_(std::move(held)) {
  CHECK(!examples_.empty());
  features_.resize(examples_.size());
  for (const Triangle& t : triangles_) {
    const Mat3 edges = edges_of(rest_, t);
    CHECK(std::abs(edges.determinant()) > 0, t[0], t[1], t[2]);
    Eigen::Matrix<double, 3, 2> B;
    B.col(0) = edges.col(0).normalized();
    B.col(1) = edges.col(2).cross(edges.col(0)).normalized();
    const Eigen::Matrix2d D = (B.transpose() * edges.leftCols<2>()).inverse();
    Eigen::Matrix<double, 3, 2> corners;
    corners << -D.colwise().sum(), D;
    frames_.push_back(B);
    corners_.push_back(corners);
    const Mat3 to_rest = edges.inverse();
    for (std::size_t i = 0; i < examples_.size(); ++i) {
      const Mat3 T = edges_of(examples_[i], t) * to_rest, R = nearest_rotation(T);
      const Eigen::AngleAxisd turn(R);
      features_[i].push_back({turn.angle() * turn.axis(), R.transpose() * T});
    }
  }
  const Components parts = parts_of(rest_.size(), triangles_);
  part_of_ = parts.of_point;
  loose_.assign(parts.count, 1);
  for (const Index v : held_) loose_[part_of_[v]] = 0;
  std::vector<Index> given = held_, first;
  std::vector<std::uint8_t> seen(parts.count, 0);
  for (Index v = 0; v < rest_.size(); ++v) {
    if (std::exchange(seen[part_of_[v]], 1) != 0) continue;
    first.push_back(v);
    if (loose_[part_of_[v]] != 0) given.push_back(v);
  }
  held_system_ = system_of(given);
  free_system_ = system_of(first);
}

std::unique_ptr<const MeshIk::System> MeshIk::system_of(std::span<const Index> given) const {
  auto out = std::make_unique<System>();
  out->given.assign(given.begin(), given.end());
  out->place.assign(rest_.size(), 0);
  for (const Index v : given) out->place[v] = none;
  Index free = 0;
  for (Index& place : out->place)
    if (place != none) place = free++;
  std::vector<std::pair<Index, Index>> pairs;
  const auto each_pair = [&](const auto& body) {
    for (std::size_t j = 0; j < triangles_.size(); ++j)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const Index row = out->place[triangles_[j][static_cast<std::size_t>(a)]];
          const Index column = out->place[triangles_[j][static_cast<std::size_t>(b)]];
          if (row != none && column != none && row >= column)
            body(row, column, corners_[j].row(a).dot(corners_[j].row(b)));
        }
  };
  each_pair([&](Index row, Index column, double) { pairs.emplace_back(row, column); });
  BlockMatrix H = block_pattern(1, free, pairs);
  each_pair([&](Index row, Index column, double value) {
    const auto begin = H.rows.begin() + H.offsets[column], end = H.rows.begin() + H.offsets[column + 1];
    *H.at(static_cast<std::size_t>(std::lower_bound(begin, end, row) - H.rows.begin())) += value;
  });
  out->factor.analyse(H);
  const bool definite = out->factor.factorize(H);
  CHECK(definite, rest_.size(), given.size());
  return out;
}

MeshIk::Blended MeshIk::blended(std::size_t triangle, std::span<const double> weights) const {
  Blended out{Vec3::Zero(), Mat3::Identity(), Mat3::Zero()};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    out.turn += weights[i] * features_[i][triangle].turn;
    out.stretch += weights[i] * features_[i][triangle].stretch;
  }
  out.R = exponential(out.turn);
  return out;
}

std::vector<Vec3> MeshIk::features(std::span<const double> weights) const {
  CHECK(weights.size() == examples_.size(), weights.size(), examples_.size());
  std::vector<Vec3> out(2 * triangles_.size());
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    const Blended now = blended(j, weights);
    const Eigen::Matrix<double, 3, 2> f = now.R * now.stretch * frames_[j];
    out[2 * j] = f.col(0);
    out[2 * j + 1] = f.col(1);
  }
  return out;
}

std::vector<Vec3> MeshIk::derivative(std::span<const double> weights, std::size_t k) const {
  std::vector<Vec3> out(2 * triangles_.size());
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    const Blended now = blended(j, weights);
    const Feature& own = features_[k][j];
    const Mat3 dT = cross_of(left_jacobian(now.turn) * own.turn) * now.R * now.stretch + now.R * own.stretch;
    const Eigen::Matrix<double, 3, 2> f = dT * frames_[j];
    out[2 * j] = f.col(0);
    out[2 * j + 1] = f.col(1);
  }
  return out;
}

std::vector<double> MeshIk::transposed(const System& system, std::span<const Vec3> y) const {
  std::vector<double> out(3 * (rest_.size() - system.given.size()), 0.0);
  for (std::size_t j = 0; j < triangles_.size(); ++j)
    for (int c = 0; c < 3; ++c) {
      const Index place = system.place[triangles_[j][static_cast<std::size_t>(c)]];
      if (place == none) continue;
      const Vec3 part = corners_[j](c, 0) * y[2 * j] + corners_[j](c, 1) * y[2 * j + 1];
      for (int d = 0; d < 3; ++d) out[3 * std::size_t{place} + static_cast<std::size_t>(d)] += part[d];
    }
  return out;
}

std::vector<double> MeshIk::solved(const System& system, std::vector<double> right) const {
  system.factor.solve_three(right);
  return right;
}

std::vector<Vec3> MeshIk::gradients(std::span<const Vec3> x) const {
  std::vector<Vec3> out(2 * triangles_.size(), Vec3(0, 0, 0));
  for (std::size_t j = 0; j < triangles_.size(); ++j)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 2; ++k)
        out[2 * j + k] += corners_[j](static_cast<int>(c), static_cast<int>(k)) * x[triangles_[j][c]];
  return out;
}

std::vector<Vec3> MeshIk::only_given(const System& system, std::span<const Vec3> x) const {
  std::vector<Vec3> out(rest_.size(), Vec3(0, 0, 0));
  for (const Index v : system.given) out[v] = x[v];
  return out;
}

void MeshIk::set_free(const System& system, std::span<const double> values, std::vector<Vec3>& x) const {
  for (std::size_t v = 0; v < x.size(); ++v)
    if (system.place[v] != none) x[v] = Eigen::Map<const Vec3>(values.data() + 3 * std::size_t{system.place[v]});
}

void MeshIk::place_parts(std::span<const std::uint8_t> which, std::span<const double> weights,
                         std::vector<Vec3>& x) const {
  std::vector<Vec3> shift(which.size(), Vec3(0, 0, 0));
  std::vector<double> count(which.size(), 0);
  for (std::size_t v = 0; v < x.size(); ++v) {
    Vec3 wanted = Vec3::Zero();
    for (std::size_t i = 0; i < weights.size(); ++i) wanted += weights[i] * examples_[i][v];
    shift[part_of_[v]] += wanted - x[v];
    count[part_of_[v]] += 1;
  }
  for (std::size_t v = 0; v < x.size(); ++v)
    if (which[part_of_[v]] != 0) x[v] += shift[part_of_[v]] / count[part_of_[v]];
}

std::vector<Vec3> MeshIk::blend(std::span<const double> weights) const {
  const System& system = *free_system_;
  std::vector<Vec3> x = only_given(system, rest_), y = features(weights);
  const std::vector<Vec3> c = gradients(x);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] -= c[i];
  set_free(system, solved(system, transposed(system, y)), x);
  place_parts(std::vector<std::uint8_t>(loose_.size(), 1), weights, x);
  return x;
}

MeshIk::State MeshIk::state_of(std::span<const Vec3> given, std::span<const double> weights) const {
  const System& system = *held_system_;
  State out;
  out.r = features(weights);
  std::vector<Vec3> y = out.r;
  const std::vector<Vec3> c = gradients(given);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] -= c[i];
  out.x.assign(given.begin(), given.end());
  set_free(system, solved(system, transposed(system, y)), out.x);
  const std::vector<Vec3> now = gradients(out.x);
  for (std::size_t i = 0; i < now.size(); ++i) out.r[i] -= now[i];
  out.energy = product(out.r, out.r);
  return out;
}

/// (J'PJ) dw = -J'r, with P = I - G (G'G)^-1 G' and P r = r.
Eigen::VectorXd MeshIk::step_of(std::span<const double> weights, std::span<const Vec3> r) const {
  const System& system = *held_system_;
  const auto l = static_cast<Eigen::Index>(weights.size());
  std::vector<std::vector<Vec3>> J;
  std::vector<std::vector<double>> right, inner;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    J.push_back(derivative(weights, k));
    right.push_back(transposed(system, J[k]));
    inner.push_back(solved(system, right[k]));
  }
  Eigen::MatrixXd A(l, l);
  Eigen::VectorXd b(l);
  for (Eigen::Index k = 0; k < l; ++k) {
    const auto& J_k = J[static_cast<std::size_t>(k)];
    b[k] = -product(J_k, r);
    for (Eigen::Index i = 0; i < l; ++i) {
      const auto &left = right[static_cast<std::size_t>(k)], &other = inner[static_cast<std::size_t>(i)];
      A(k, i) = product(J_k, J[static_cast<std::size_t>(i)]) -
                std::inner_product(left.begin(), left.end(), other.begin(), 0.0);
    }
  }
  // Examples that are alike leave a weight open: hardly moved, then.
  A.diagonal().array() += 1e-12 * A.trace();
  return A.ldlt().solve(b);
}

MeshIk::Answer MeshIk::solve(std::span<const Vec3> targets, int most_iterations) const {
  CHECK(targets.size() == held_.size(), targets.size(), held_.size());
  std::vector<Vec3> x = rest_;
  for (std::size_t i = 0; i < held_.size(); ++i) x[held_[i]] = targets[i];
  const std::vector<Vec3> given = only_given(*held_system_, x);

  Answer out;
  out.weights.assign(examples_.size(), 1.0 / static_cast<double>(examples_.size()));
  State state = state_of(given, out.weights);
  while (out.iterations < most_iterations && !out.converged) {
    ++out.iterations;
    const Eigen::VectorXd step = step_of(out.weights, state.r);
    out.converged = true;  // unless a part of the step leads down
    for (double h = 1; h > 1e-6; h /= 2) {
      std::vector<double> w = out.weights;
      for (std::size_t k = 0; k < w.size(); ++k) w[k] += h * step[static_cast<Eigen::Index>(k)];
      State next = state_of(given, w);
      if (!(next.energy < state.energy)) continue;
      out.weights = w;
      state = std::move(next);
      out.converged = h * step.cwiseAbs().maxCoeff() < 1e-8;
      break;
    }
  }
  out.energy = state.energy;
  out.positions = std::move(state.x);
  place_parts(loose_, out.weights, out.positions);
  return out;
}

}  // namespace sinew::benchmarks
