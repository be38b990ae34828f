#include "deformers/shell_detail.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/geometry/check.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/rotation.h"
#include "engine/geometry/union_find.h"

namespace sinew {

namespace {

constexpr Index none = ~Index{0};
constexpr std::size_t block = 1024;     // vertices or triangles of a parallel loop
constexpr std::size_t guide_count = 8;  // anchors whose motion a part without its own follows
constexpr double least_height = 1e-3;   // of a triangle of B that has a map of its own, in longest edges

/// Two edges and a normal as long as the root of its parallelogram's area [Sumner and Popovic 2004, equation 1], so
/// that a change of size scales all three.
Mat3 frame_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double area = n.norm();
  Mat3 F;
  F << b - a, c - a, (area > 0 ? Vec3(n / std::sqrt(area)) : Vec3::Zero());
  return F;
}

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).norm() > least_height * longest && longest > 1e-24;
}

bool span_plane(std::span<const Vec3> points) {
  if (points.size() < 3) return false;
  const Vec3 a = points[0];
  Vec3 axis = Vec3::Zero();
  for (const Vec3& p : points)
    if ((p - a).squaredNorm() > axis.squaredNorm()) axis = p - a;
  return std::any_of(points.begin(), points.end(),
                     [&](const Vec3& p) { return axis.cross(p - a).norm() > least_height * axis.squaredNorm(); });
}

Vec3 mean_of(std::span<const Vec3> points, std::span<const Index> which) {
  Vec3 sum = Vec3::Zero();
  for (const Index i : which) sum += points[i];
  return which.empty() ? sum : Vec3(sum / static_cast<double>(which.size()));
}

std::vector<Vec3> at(std::span<const Vec3> points, std::span<const Index> which) {
  std::vector<Vec3> out;
  for (const Index i : which) out.push_back(points[i]);
  return out;
}

}  // namespace

ShellDetail::ShellDetail(std::vector<Vec3> rest, const std::vector<std::array<Index, 3>>& triangles,
                         std::vector<Index> anchors, std::span<const Index> held,
                         const std::function<bool(double)>& progress, const ShellDetailSettings& settings)
    : settings_(settings), rest_(std::move(rest)), p_(rest_), anchors_(std::move(anchors)) {
  std::vector<std::array<Index, 3>> finite;
  for (const auto& t : triangles) {
    CHECK(t[0] < p_.size() && t[1] < p_.size() && t[2] < p_.size(), t[0], t[1], t[2], p_.size());
    if (std::all_of(t.begin(), t.end(), [&](Index v) { return p_[v].allFinite(); })) finite.push_back(t);
  }
  normalise(finite);
  L_ = cotangent_laplacian(p_, finite);
  anchored_.assign(p_.size(), 0);
  held_.assign(p_.size(), 0);
  rigid_.assign(p_.size(), 0);
  for (const Index v : anchors_) {
    CHECK(v < p_.size() && !anchored_[v], v, p_.size());
    anchored_[v] = 1;
  }
  for (const Index k : held) {
    CHECK(k < anchors_.size(), k, anchors_.size());
    held_[anchors_[k]] = 1;
  }
  std::vector<Part> parts;
  std::vector<Index> part_of;
  find_parts(parts, part_of);
  for (Index i = 0; i < p_.size(); ++i) rigid_[i] = part_of[i] == none;
  for (const Part& part : parts) {
    std::vector<Index> vertices;
    for (const Index k : part.own) vertices.push_back(anchors_[k]);
    if (!span_plane(at(p_, vertices))) make_rigid(part);
  }

  const auto go_on = [&](double done) { return !progress || progress(done); };
  for (Index i = 0; i < p_.size(); ++i)
    if (!rigid_[i] && !anchored_[i]) plate_.free.push_back(i);
  if (!go_on(0.05)) return;
  plate_.H = thin_plate();
  if (!go_on(0.1)) return;
  plate_.make();
  if (!go_on(0.75)) return;
  a_ = at(p_, anchors_);
  b_ = plate_through(a_);
  find_frames(parts, part_of);
  for (Index i = 0; i < p_.size(); ++i)
    if (!rigid_[i] && !held_[i]) poisson_.free.push_back(i);
  poisson_.H = poisson();
  if (!go_on(0.8)) return;
  poisson_.make();
  ready_ = go_on(1);
}

void ShellDetail::normalise(const std::vector<std::array<Index, 3>>& triangles) {
  Eigen::AlignedBox3d box;
  for (const auto& t : triangles)
    for (const Index v : t) box.extend(p_[v]);
  if (box.isEmpty()) return;
  const Vec3 centre = box.center();
  if (box.diagonal().norm() > 0) unit_ = box.diagonal().norm();
  for (Vec3& p : p_) p = (p - centre) / unit_;
}

/// Of vertices without triangles, part_of is none.
void ShellDetail::find_parts(std::vector<Part>& parts, std::vector<Index>& part_of) const {
  UnionFind joined(p_.size());
  for (const auto& t : L_.triangles) {
    joined.join(t[0], t[1]);
    joined.join(t[1], t[2]);
  }
  part_of.assign(p_.size(), none);
  for (Index i = 0; i < p_.size(); ++i) {
    if (L_.corner_offsets[i] == L_.corner_offsets[i + 1]) continue;
    const Index root = joined.root(i);
    if (root == i) parts.emplace_back();
    part_of[i] = root == i ? static_cast<Index>(parts.size() - 1) : part_of[root];
    parts[part_of[i]].vertices.push_back(i);
  }
  for (Index k = 0; k < anchors_.size(); ++k)
    if (part_of[anchors_[k]] != none) parts[part_of[anchors_[k]]].own.push_back(k);
}

void ShellDetail::make_rigid(Part part) {
  const Vec3 centre = mean_of(p_, part.vertices);
  part.guides.resize(anchors_.size());
  std::iota(part.guides.begin(), part.guides.end(), Index{0});
  std::erase_if(part.guides, [&](Index k) { return alone(anchors_[k]); });
  const std::size_t count = std::min(guide_count, part.guides.size());
  std::partial_sort(part.guides.begin(), part.guides.begin() + static_cast<std::ptrdiff_t>(count), part.guides.end(),
                    [&](Index a, Index b) {
                      const double da = (p_[anchors_[a]] - centre).squaredNorm();
                      const double db = (p_[anchors_[b]] - centre).squaredNorm();
                      return da != db ? da < db : a < b;
                    });
  part.guides.resize(count);
  for (const Index v : part.vertices) rigid_[v] = 1;
  rigid_parts_.push_back(std::move(part));
}

/// K = L M^-1 L of the free vertices.
BlockMatrix ShellDetail::thin_plate() const {
  const std::vector<Index>& free = plate_.free;
  std::vector<Index> column(p_.size(), none);
  for (Index j = 0; j < free.size(); ++j) column[free[j]] = j;
  std::vector<double> diagonal(p_.size(), 0);
  for (std::size_t i = 0; i < p_.size(); ++i)
    for (Index e = L_.offsets[i]; e < L_.offsets[i + 1]; ++e) diagonal[i] += L_.w[e];

  BlockMatrix K;
  std::vector<double> sum(free.size(), 0);
  std::vector<char> met(free.size(), 0);
  for (Index j = 0; j < free.size(); ++j) {
    std::vector<Index> rows;
    const auto add = [&](Index i, double value) {
      const Index row = column[i];
      if (row == none || row < j) return;
      if (!met[row]) rows.push_back(row);
      met[row] = 1;
      sum[row] += value;
    };
    const auto through = [&](Index k, double L_kj) {  // column j of L, its row k
      const double f = L_kj / L_.M[k];
      add(k, diagonal[k] * f);
      for (Index e = L_.offsets[k]; e < L_.offsets[k + 1]; ++e) add(L_.to[e], -L_.w[e] * f);
    };
    through(free[j], diagonal[free[j]]);
    for (Index e = L_.offsets[free[j]]; e < L_.offsets[free[j] + 1]; ++e) through(L_.to[e], -L_.w[e]);
    std::sort(rows.begin(), rows.end());
    for (const Index row : rows) {
      K.rows.push_back(row);
      K.values.push_back(sum[row]);
      sum[row] = 0;
      met[row] = 0;
    }
    K.offsets.push_back(static_cast<Index>(K.rows.size()));
  }
  return K;
}

/// L + w M / a of the free vertices.
BlockMatrix ShellDetail::poisson() const {
  const std::vector<Index>& free = poisson_.free;
  std::vector<Index> column(p_.size(), none);
  for (Index j = 0; j < free.size(); ++j) column[free[j]] = j;
  const double area = std::accumulate(L_.M.begin(), L_.M.end(), 0.0);
  const double hold = settings_.hold * static_cast<double>(std::max<std::size_t>(1, anchors_.size())) / area;
  BlockMatrix H;
  for (Index j = 0; j < free.size(); ++j) {
    const std::size_t first = H.rows.size();
    H.rows.push_back(j);
    H.values.push_back(hold * L_.M[free[j]]);
    for (Index e = L_.offsets[free[j]]; e < L_.offsets[free[j] + 1]; ++e) {
      H.values[first] += L_.w[e];
      const Index row = column[L_.to[e]];
      if (row == none || row < j) continue;
      H.rows.push_back(row);
      H.values.push_back(-L_.w[e]);
    }
    H.offsets.push_back(static_cast<Index>(H.rows.size()));
  }
  return H;
}

/// The surface of least thin-plate energy through `anchors`: K_ff x = -K_fa a. Rigid parts are left at zero.
std::vector<Vec3> ShellDetail::plate_through(std::span<const Vec3> anchors) const {
  std::vector<Vec3> x(p_.size(), Vec3::Zero());
  for (std::size_t k = 0; k < anchors_.size(); ++k)
    if (!rigid_[anchors_[k]]) x[anchors_[k]] = anchors[k];
  std::vector<Vec3> y = multiply(L_, x);
  for (std::size_t i = 0; i < y.size(); ++i)
    if (L_.M[i] > 0) y[i] /= L_.M[i];
  y = multiply(L_, y);
  std::vector<Vec3> b(plate_.free.size());
  for (std::size_t j = 0; j < b.size(); ++j) b[j] = -y[plate_.free[j]];
  b = plate_.solve(b);
  for (std::size_t j = 0; j < b.size(); ++j) x[plate_.free[j]] = b[j];
  return x;
}

/// B' as B and what moves it, so that anchors at rest give B to the last digits.
std::vector<Vec3> ShellDetail::moved_base(std::span<const Vec3> anchors) const {
  std::vector<Vec3> u(anchors.begin(), anchors.end());
  for (std::size_t k = 0; k < u.size(); ++k) u[k] -= a_[k];
  std::vector<Vec3> x = plate_through(u);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += b_[i];
  return x;
}

void ShellDetail::find_frames(const std::vector<Part>& parts, const std::vector<Index>& part_of) {
  const std::size_t count = L_.triangles.size();
  inverse_.assign(count, Mat3::Identity());
  source_.assign(count, none);
  std::vector<char> shaped(parts.size(), 0);
  std::vector<Index> wave;
  for (Index t = 0; t < count; ++t) {
    const auto [a, b, c] = L_.triangles[t];
    if (rigid_[a] || !has_area(b_[a], b_[b], b_[c])) continue;
    inverse_[t] = frame_of(b_[a], b_[b], b_[c]).inverse();
    source_[t] = t;
    shaped[part_of[a]] = 1;
    wave.push_back(t);
  }
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (!shaped[k] && !rigid_[parts[k].vertices[0]]) make_rigid(parts[k]);
  for (std::size_t next = 0; next < wave.size(); ++next)
    for (const Index v : L_.triangles[wave[next]])
      for (Index k = L_.corner_offsets[v]; k < L_.corner_offsets[v + 1]; ++k)
        if (const Index t = L_.corners[k] / 3; source_[t] == none) {
          source_[t] = source_[wave[next]];
          wave.push_back(t);
        }
}

/// S_t; the identity on rigid parts.
std::vector<Mat3> ShellDetail::gradients(std::span<const Vec3> base) const {
  std::vector<Mat3> S(L_.triangles.size(), Mat3::Identity());
  parallel_for(S.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (source_[t] == none) continue;
      const auto [a, b, c] = L_.triangles[source_[t]];
      S[t] = frame_of(base[a], base[b], base[c]) * inverse_[source_[t]];
    }
  });
  return S;
}

/// q_i = b'_i + S_i (p_i - b_i).
std::vector<Vec3> ShellDetail::carried(std::span<const Mat3> S, std::span<const Vec3> base) const {
  std::vector<Vec3> q(base.begin(), base.end());
  parallel_for(q.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Mat3 sum = Mat3::Zero();
      double area = 0;
      for (Index k = L_.corner_offsets[i]; k < L_.corner_offsets[i + 1]; ++k) {
        const Index t = L_.corners[k] / 3;
        sum += L_.area[t] * S[t];
        area += L_.area[t];
      }
      if (area > 0) q[i] += sum * (p_[i] - b_[i]) / area;
    }
  });
  return q;
}

/// Rigid parts by the rotation and translation of their guides [Kabsch 1976].
void ShellDetail::move_rigid(std::span<const Vec3> anchors, std::vector<Vec3>& x) const {
  const std::vector<Vec3>& rest = a_;
  for (const Part& part : rigid_parts_) {
    if (part.guides.empty()) continue;
    const Vec3 from = mean_of(rest, part.guides), to = mean_of(anchors, part.guides);
    Mat3 C = Mat3::Zero();
    for (const Index k : part.guides) C += (anchors[k] - to) * (rest[k] - from).transpose();
    const Mat3 R = span_plane(at(rest, part.guides)) ? nearest_rotation(C) : Mat3::Identity();
    const std::vector<Index>& pins = part.own.empty() ? part.guides : part.own;
    const Vec3 pin = mean_of(rest, pins), target = mean_of(anchors, pins);
    for (const Index v : part.vertices) x[v] = target + R * (p_[v] - pin);
  }
}

std::vector<Vec3> ShellDetail::base(std::span<const Vec3> positions) const {
  return placed(positions, [&](std::span<const Vec3> anchors) { return moved_base(anchors); });
}

std::vector<Vec3> ShellDetail::reconstruct(std::span<const Vec3> positions) const {
  return placed(positions, [&](std::span<const Vec3> anchors) {
    const std::vector<Vec3> base = moved_base(anchors);
    const std::vector<Mat3> S = gradients(base);
    std::vector<Vec3> x = carried(S, base);
    // The unknown is what is still lacking at q, so that the identity stays to the last digits:
    // (L + w M / a) (x - q) = div(S grad p) - L q.
    const std::vector<Vec3> wanted = divergence(L_, S, p_), has = multiply(L_, x);
    std::vector<Vec3> step(poisson_.free.size());
    for (std::size_t j = 0; j < step.size(); ++j) step[j] = wanted[poisson_.free[j]] - has[poisson_.free[j]];
    step = poisson_.solve(step);
    for (std::size_t j = 0; j < step.size(); ++j) x[poisson_.free[j]] += step[j];
    return x;
  });
}

/// What `surface` makes of anchors in p's place and units (by their mean, so that far ones lose no digits), back among
/// the positions; empty where that is not finite.
std::vector<Vec3> ShellDetail::placed(
    std::span<const Vec3> positions,
    const std::function<std::vector<Vec3>(std::span<const Vec3> anchors)>& surface) const {
  CHECK(ready_ && positions.size() == anchors_.size(), positions.size(), anchors_.size());
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  double count = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    if (!positions[k].allFinite()) return {};
    if (alone(anchors_[k])) continue;
    from += a_[k];
    to += positions[k];
    ++count;
  }
  if (count > 0) {
    from /= count;
    to /= count;
  }
  std::vector<Vec3> anchors;
  for (const Vec3& p : positions) anchors.push_back(from + (p - to) / unit_);
  std::vector<Vec3> x = count > 0 ? surface(anchors) : p_;
  if (count > 0) move_rigid(anchors, x);
  for (Index i = 0; i < x.size(); ++i) {
    const bool rests = count == 0 || alone(i);
    x[i] = rests ? rest_[i] : Vec3(to + unit_ * (x[i] - from));
    if (!rests && !x[i].allFinite()) return {};
  }
  for (std::size_t k = 0; k < anchors_.size(); ++k)
    if (held_[anchors_[k]] || alone(anchors_[k])) x[anchors_[k]] = positions[k];
  return x;
}

}  // namespace sinew
