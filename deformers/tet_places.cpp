#include "deformers/tet_places.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace sinew {

namespace {

std::vector<Vec3> face_centres(const TetMesh& mesh, const TetMesh::Boundary& boundary) {
  std::vector<Vec3> out;
  for (const auto& [a, b, c] : boundary.faces)
    out.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  return out;
}

/// Distance of p from a triangle.
double distance_to(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const auto side = [&](const Vec3& from, const Vec3& to) { return n.cross(to - from).dot(p - from) >= 0; };
  if (n.squaredNorm() > 0 && side(a, b) && side(b, c) && side(c, a)) return std::abs(n.dot(p - a)) / n.norm();
  const auto along = [&](const Vec3& from, const Vec3& to) {
    const Vec3 d = to - from;
    const double u = d.squaredNorm() > 0 ? std::clamp((p - from).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0;
    return (p - from - u * d).norm();
  };
  return std::min({along(a, b), along(b, c), along(c, a)});
}

}  // namespace

TetPlaces::TetPlaces(const TetMesh& mesh)
    : mesh_(mesh), boundary_(mesh.boundary()), faces_(face_centres(mesh, boundary_)) {}

std::optional<TetTie> TetPlaces::within(Index tet, const Vec3& p) const {
  const Tet& v = mesh_.tets[tet];
  Mat3 D;
  for (int i = 0; i < 3; ++i) D.col(i) = mesh_.vertices[v[static_cast<std::size_t>(i)]] - mesh_.vertices[v[3]];
  const Vec3 b = D.inverse() * (p - mesh_.vertices[v[3]]);
  if (!b.allFinite()) return std::nullopt;
  return TetTie{v, {b[0], b[1], b[2], 1 - b.sum()}};
}

std::optional<TetTie> TetPlaces::inside(const Vec3& p) const {
  // Long tets have their centres far from their ends: all are looked at, the box first.
  for (Index t = 0; t < mesh_.tets.size(); ++t) {
    Vec3 low = mesh_.vertices[mesh_.tets[t][0]], high = low;
    for (const Index v : mesh_.tets[t]) {
      low = low.cwiseMin(mesh_.vertices[v]);
      high = high.cwiseMax(mesh_.vertices[v]);
    }
    if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) continue;
    const std::optional<TetTie> tie = within(t, p);
    if (tie && std::all_of(tie->weights.begin(), tie->weights.end(), [](double w) { return w >= -1e-12; })) return tie;
  }
  return std::nullopt;
}

TetTie TetPlaces::tie(const Vec3& p) const {
  if (const std::optional<TetTie> found = inside(p)) return *found;
  std::array<Index, 1> near;
  std::array<double, 1> distance;
  faces_.nearest(std::span(&p, 1), 1, near, distance);
  const Index tet = boundary_.tets[near[0]];
  if (const std::optional<TetTie> found = within(tet, p)) return *found;
  return {mesh_.tets[tet], {0.25, 0.25, 0.25, 0.25}};
}

bool TetPlaces::outside(const Vec3& p, double tolerance) const {
  if (inside(p)) return false;
  const auto near = [&](const std::array<Index, 3>& face) {
    return distance_to(p, mesh_.vertices[face[0]], mesh_.vertices[face[1]], mesh_.vertices[face[2]]) <= tolerance;
  };
  return std::none_of(boundary_.faces.begin(), boundary_.faces.end(), near);
}

std::vector<std::array<Index, 3>> TetPlaces::faces_before(const Vec3& p, std::size_t count) const {
  const int asked = static_cast<int>(std::min<std::size_t>(boundary_.faces.size(), 16 * count));
  std::vector<Index> near(static_cast<std::size_t>(asked));
  std::vector<double> distance(near.size());
  faces_.nearest(std::span(&p, 1), asked, near, distance);
  std::vector<std::array<Index, 3>> out;
  for (const Index f : near) {
    if (out.size() == count) break;
    const auto& [a, b, c] = boundary_.faces[f];
    const Vec3 n = (mesh_.vertices[b] - mesh_.vertices[a]).cross(mesh_.vertices[c] - mesh_.vertices[a]);
    // Seen flatly, the tet would be a sliver.
    if (n.dot(p - mesh_.vertices[a]) > 0.1 * n.norm() * (p - mesh_.vertices[a]).norm())
      out.push_back(boundary_.faces[f]);
  }
  return out;
}

}  // namespace sinew
