#include "deformers/pose_decimate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "deformers/shell_energy.h"
#include "engine/geometry/check.h"
#include "engine/geometry/triangle.h"

namespace sinew {

namespace {

using Triangle = std::array<Index, 3>;
constexpr double boundary_weight = 10, point_weight = 1e-3, bend_weight = 0.05;

bool has(const Triangle& t, Index v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

/// p'A p + 2 b'p + c.
class Quadric {
 public:
  void add_plane(const Vec3& n, double d, double weight) {
    A_ += weight * n * n.transpose();
    b_ += weight * d * n;
    c_ += weight * d * d;
  }
  void add_point(const Vec3& p, double weight) {
    A_ += weight * Mat3::Identity();
    b_ -= weight * p;
    c_ += weight * p.squaredNorm();
  }
  Quadric& operator+=(const Quadric& other) {
    A_ += other.A_;
    b_ += other.b_;
    c_ += other.c_;
    return *this;
  }
  double operator()(const Vec3& p) const { return p.dot(A_ * p) + 2 * b_.dot(p) + c_; }

 private:
  Mat3 A_ = Mat3::Zero();
  Vec3 b_ = Vec3::Zero();
  double c_ = 0;
};

class Decimation {
 public:
  Decimation(std::span<const std::vector<Vec3>> poses, const std::vector<Triangle>& triangles,
             std::span<const Index> keep);
  void run(std::size_t count, const std::function<bool()>& go_on);
  PoseDecimated result() const;

 private:
  struct Candidate {
    double cost = 0;
    Index from = 0, to = 0, stamp = 0;
    auto key() const { return std::tuple(cost, from, to); }
    bool operator>(const Candidate& other) const { return key() > other.key(); }
  };

  const Vec3& at(std::size_t pose, Index v) const { return points_[pose][v]; }
  void add_quadrics();
  double bending(Index t) const;
  void find_neighbours(Index v, std::vector<Index>& out) const;
  int triangles_at_edge(Index v, Index w) const;
  bool is_fan(Index v) const;
  double cost(Index v, Index w) const;
  void push_next(Index v, const Candidate* after);
  bool keeps_topology(Index v, Index w);
  bool keeps_triangles(Index v, Index w, double aspect) const;
  void collapse(Index v, Index w);
  void put(Index v, const std::vector<Index>& ring);

  std::vector<std::vector<Vec3>> points_;  ///< of each pose, about the rest's centre, its diagonal 1
  std::vector<Triangle> triangles_;
  std::vector<char> alive_;                   ///< of each triangle
  std::vector<std::vector<Index>> star_;      ///< triangles at each vertex
  std::vector<std::vector<Index>> hanging_;   ///< vertices that vanished, at the triangle of their place
  std::vector<PoseDecimated::Place> places_;  ///< of those
  std::vector<Quadric> quadrics_;             ///< of vertex v in pose k at v * poses + k
  std::vector<char> stays_, boundary_;        ///< of each vertex
  std::vector<Index> stamp_;                  ///< rises when what is around a vertex changes
  std::vector<Index> neighbours_, others_;    ///< room for the vertices around one
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
  std::size_t left_ = 0;
  bool stopped_ = false;
};

Decimation::Decimation(std::span<const std::vector<Vec3>> poses, const std::vector<Triangle>& triangles,
                       std::span<const Index> keep)
    : points_(poses.begin(), poses.end()) {
  CHECK(!poses.empty());
  const std::size_t n = poses[0].size();
  const auto finite = [&](Index v) {
    return std::all_of(poses.begin(), poses.end(), [&](const auto& pose) { return pose[v].allFinite(); });
  };
  for (const auto& pose : poses) CHECK(pose.size() == n, pose.size(), n);
  for (const Triangle& t : triangles) {
    CHECK(t[0] < n && t[1] < n && t[2] < n, t[0], t[1], t[2], n);
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0] && std::all_of(t.begin(), t.end(), finite))
      triangles_.push_back(t);
  }
  star_.resize(n);
  Eigen::AlignedBox3d box;
  for (Index t = 0; t < triangles_.size(); ++t)
    for (const Index v : triangles_[t]) {
      star_[v].push_back(t);
      box.extend(poses[0][v]);
    }
  const double diagonal = box.isEmpty() ? 0 : box.diagonal().norm(), unit = diagonal > 0 ? 1 / diagonal : 1;
  for (auto& pose : points_)
    for (Vec3& p : pose) p = (p - (box.isEmpty() ? Vec3::Zero() : Vec3(box.center()))) * unit;
  alive_.assign(triangles_.size(), 1);
  hanging_.resize(triangles_.size());
  places_.resize(n);
  stamp_.assign(n, 0);
  boundary_.assign(n, 0);
  stays_.assign(n, 0);
  for (const Index v : keep) {
    CHECK(v < n, v, n);
    stays_[v] = 1;
  }
  for (Index v = 0; v < n; ++v) {
    if (star_[v].empty()) continue;
    ++left_;
    find_neighbours(v, neighbours_);
    for (const Index w : neighbours_) boundary_[v] |= triangles_at_edge(v, w) == 1;
    stays_[v] |= !is_fan(v);
  }
  add_quadrics();
}

/// The largest change of the angle at one of the triangle's edges, in any pose, by the edge's length.
double Decimation::bending(Index t) const {
  double most = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Index v = triangles_[t][c], w = triangles_[t][(c + 1) % 3];
    const auto beyond =
        std::find_if(star_[v].begin(), star_[v].end(), [&](Index u) { return u != t && has(triangles_[u], w); });
    const double length = (at(0, w) - at(0, v)).norm();
    if (beyond == star_[v].end() || triangles_at_edge(v, w) != 2 || !(length > 0)) continue;
    const Triangle& other = triangles_[*beyond];
    const Index x = triangles_[t][(c + 2) % 3], y = other[0] + other[1] + other[2] - v - w;
    const auto angle = [&](std::size_t k) { return dihedral_angle(at(k, v), at(k, w), at(k, x), at(k, y)); };
    const double rest = points_.size() > 1 ? angle(0) : 0;
    for (std::size_t k = 1; k < points_.size(); ++k) most = std::max(most, std::abs(angle(k) - rest) / length);
  }
  return most;
}

void Decimation::add_quadrics() {
  const std::size_t poses = points_.size();
  quadrics_.resize(star_.size() * poses);
  for (Index number = 0; number < triangles_.size(); ++number) {
    const Triangle& t = triangles_[number];
    const double bends = 1 + bend_weight * bending(number);
    for (std::size_t k = 0; k < poses; ++k) {
      const Vec3 n = (at(k, t[1]) - at(k, t[0])).cross(at(k, t[2]) - at(k, t[0]));
      const double area = n.norm() / 2;
      const double weight = area * bends;
      const Vec3 normal = area > 0 ? Vec3(n / (2 * area)) : Vec3::Zero();
      for (int c = 0; c < 3; ++c) {
        const Index v = t[c], w = t[(c + 1) % 3];
        quadrics_[v * poses + k].add_plane(normal, -normal.dot(at(k, v)), weight);
        quadrics_[v * poses + k].add_point(at(k, v), point_weight * weight);
        if (!boundary_[v] || !boundary_[w] || triangles_at_edge(v, w) != 1) continue;
        const Vec3 edge = at(k, w) - at(k, v), across = normal.cross(edge).normalized();
        for (const Index end : {v, w})
          quadrics_[end * poses + k].add_plane(across, -across.dot(at(k, v)), boundary_weight * edge.squaredNorm());
      }
    }
  }
}

void Decimation::find_neighbours(Index v, std::vector<Index>& out) const {
  out.clear();
  for (const Index t : star_[v])
    for (const Index w : triangles_[t])
      if (w != v && std::find(out.begin(), out.end(), w) == out.end()) out.push_back(w);
}

int Decimation::triangles_at_edge(Index v, Index w) const {
  return static_cast<int>(
      std::count_if(star_[v].begin(), star_[v].end(), [&](Index t) { return has(triangles_[t], w); }));
}

/// Whether the triangles at v are a disc, or half a disc, around it.
bool Decimation::is_fan(Index v) const {
  const std::vector<Index>& star = star_[v];
  std::vector<Index> around;
  find_neighbours(v, around);
  int ends = 0;
  for (const Index w : around) {
    const int at_edge = triangles_at_edge(v, w);
    if (at_edge > 2) return false;
    ends += at_edge == 1;
  }
  std::vector<char> seen(star.size(), 0);
  std::vector<std::size_t> stack{0};
  std::size_t reached = 1;
  seen[0] = 1;
  while (!stack.empty()) {
    const Triangle& t = triangles_[star[stack.back()]];
    stack.pop_back();
    for (std::size_t i = 0; i < star.size(); ++i) {
      const bool meets =
          std::any_of(t.begin(), t.end(), [&](Index w) { return w != v && has(triangles_[star[i]], w); });
      if (seen[i] || !meets) continue;
      seen[i] = 1;
      ++reached;
      stack.push_back(i);
    }
  }
  return reached == star.size() && (ends == 0 || ends == 2);
}

double Decimation::cost(Index v, Index w) const {
  double sum = 0;
  const std::size_t poses = points_.size();
  for (std::size_t k = 0; k < poses; ++k)
    sum += quadrics_[v * poses + k](at(k, w)) + quadrics_[w * poses + k](at(k, w));
  return std::max(sum, 0.0);
}

/// The cheapest way for v to vanish, of those that come after `after` where there is one.
void Decimation::push_next(Index v, const Candidate* after) {
  if (stays_[v]) return;
  find_neighbours(v, others_);
  Candidate best;
  bool found = false;
  for (const Index w : others_) {
    if (boundary_[v] && (!boundary_[w] || triangles_at_edge(v, w) != 1)) continue;
    const Candidate candidate{cost(v, w), v, w, stamp_[v]};
    if ((after && !(candidate > *after)) || (found && !(best > candidate))) continue;
    best = candidate;
    found = true;
  }
  if (found) queue_.push(best);
}

/// The link condition [Dey, Edelsbrunner, Guha and Nekhayev 1999]: what v and w both meet is what their edge meets.
bool Decimation::keeps_topology(Index v, Index w) {
  std::array<Index, 2> opposite{};
  std::size_t count = 0;
  for (const Index t : star_[v]) {
    if (!has(triangles_[t], w)) continue;
    if (count == 2) return false;
    for (const Index x : triangles_[t])
      if (x != v && x != w) opposite[count] = x;
    ++count;
  }
  if (count != (boundary_[v] ? 1 : 2) || (count == 2 && opposite[0] == opposite[1])) return false;
  find_neighbours(v, neighbours_);
  find_neighbours(w, others_);
  std::sort(others_.begin(), others_.end());
  std::size_t common = 0;
  for (const Index x : neighbours_) common += std::binary_search(others_.begin(), others_.end(), x);
  if (common != count) return false;
  // A triangle alone would vanish.
  if (boundary_[v]) return triangles_at_edge(v, opposite[0]) != 1 || triangles_at_edge(w, opposite[0]) != 1;
  // Two triangles of a tetrahedron would come to lie on each other.
  const auto spans = [&](Index t) { return has(triangles_[t], opposite[0]) && has(triangles_[t], opposite[1]); };
  return std::none_of(star_[v].begin(), star_[v].end(), spans) || std::none_of(star_[w].begin(), star_[w].end(), spans);
}

/// Whether no triangle turns over or becomes longer and thinner than `aspect`, in any pose. One that has no normal may
/// become anything.
bool Decimation::keeps_triangles(Index v, Index w, double aspect) const {
  for (const Index t : star_[v]) {
    if (has(triangles_[t], w)) continue;
    const auto c =
        static_cast<std::size_t>(std::find(triangles_[t].begin(), triangles_[t].end(), v) - triangles_[t].begin());
    const Index i = triangles_[t][(c + 1) % 3], j = triangles_[t][(c + 2) % 3];
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const Vec3 &p = at(k, v), &q = at(k, w), &a = at(k, i), &b = at(k, j);
      const Vec3 before = (a - p).cross(b - p), after = (a - q).cross(b - q);
      const double area = before.norm(), turned = after.norm(), base = (b - a).squaredNorm();
      if (!(area > 0)) continue;
      if (!(after.dot(before) > 0.5 * area * turned)) return false;
      const double ratio = std::max({base, (a - q).squaredNorm(), (b - q).squaredNorm()}) / turned;
      const double had = std::max({base, (a - p).squaredNorm(), (b - p).squaredNorm()}) / area;
      if (ratio > aspect && ratio > had) return false;
    }
  }
  return true;
}

void Decimation::collapse(Index v, Index w) {
  std::vector<Index> ring, displaced{v};
  for (const Index t : star_[v]) {
    displaced.insert(displaced.end(), hanging_[t].begin(), hanging_[t].end());
    hanging_[t].clear();
    if (!has(triangles_[t], w)) {
      std::replace(triangles_[t].begin(), triangles_[t].end(), v, w);
      star_[w].push_back(t);
      ring.push_back(t);
      continue;
    }
    alive_[t] = 0;
    for (const Index x : triangles_[t])
      if (x != v) std::erase(star_[x], t);
  }
  star_[v].clear();
  const std::size_t poses = points_.size();
  for (std::size_t k = 0; k < poses; ++k) quadrics_[w * poses + k] += quadrics_[v * poses + k];
  --left_;
  for (const Index x : displaced) put(x, ring.empty() ? star_[w] : ring);

  find_neighbours(w, neighbours_);
  neighbours_.push_back(w);
  for (const Index x : neighbours_) {
    ++stamp_[x];
    push_next(x, nullptr);
  }
}

void Decimation::put(Index v, const std::vector<Index>& ring) {
  double least = std::numeric_limits<double>::infinity();
  for (const Index t : ring) {
    const auto [a, b, c] = triangles_[t];
    const Vec3 q = nearest_in_triangle(at(0, v), at(0, a), at(0, b), at(0, c));
    double distance = 0;
    for (std::size_t k = 0; k < points_.size(); ++k)
      distance += (q[0] * at(k, a) + q[1] * at(k, b) + q[2] * at(k, c) - at(k, v)).squaredNorm();
    if (!(distance < least) && t != ring.front()) continue;
    least = distance;
    places_[v] = {t, q};
  }
  hanging_[places_[v].triangle].push_back(v);
}

void Decimation::run(std::size_t count, const std::function<bool()>& go_on) {
  std::size_t looked = 0;
  // A tight aspect ratio may end the decimation early: it is loosened until the count is reached.
  for (double aspect = 10; left_ > count && aspect < 1e4; aspect *= 4) {
    for (Index v = 0; v < star_.size(); ++v)
      if (!star_[v].empty()) push_next(v, nullptr);
    while (left_ > count && !queue_.empty()) {
      if (++looked % 1000 == 0 && go_on && !go_on()) {
        stopped_ = true;
        return;
      }
      const Candidate next = queue_.top();
      queue_.pop();
      if (star_[next.from].empty() || next.stamp != stamp_[next.from]) continue;
      if (keeps_topology(next.from, next.to) && keeps_triangles(next.from, next.to, aspect))
        collapse(next.from, next.to);
      else
        push_next(next.from, &next);
    }
    queue_ = {};
  }
}

PoseDecimated Decimation::result() const {
  PoseDecimated out;
  out.stopped = stopped_;
  out.places = places_;
  std::vector<Index> number(triangles_.size(), PoseDecimated::none);
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (!alive_[t]) continue;
    number[t] = static_cast<Index>(out.triangles.size());
    out.triangles.push_back(triangles_[t]);
  }
  for (Index v = 0; v < star_.size(); ++v) {
    PoseDecimated::Place& place = out.places[v];
    if (!star_[v].empty()) {
      out.vertices.push_back(v);
      const Index t = *std::min_element(star_[v].begin(), star_[v].end());
      place.triangle = t;
      for (int c = 0; c < 3; ++c) place.coordinates[c] = triangles_[t][static_cast<std::size_t>(c)] == v ? 1 : 0;
    }
    if (place.triangle != PoseDecimated::none) place.triangle = number[place.triangle];
  }
  return out;
}

}  // namespace

PoseDecimated decimated_together(std::span<const std::vector<Vec3>> poses, const std::vector<Triangle>& triangles,
                                 std::size_t count, std::span<const Index> keep, const std::function<bool()>& go_on) {
  Decimation decimation(poses, triangles, keep);
  decimation.run(count, go_on);
  return decimation.result();
}

}  // namespace sinew
