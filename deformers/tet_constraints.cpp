#include "deformers/tet_constraints.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "engine/geometry/bounds.h"
#include "engine/geometry/check.h"
#include "engine/geometry/nearest.h"

namespace sinew {

namespace {

constexpr std::size_t faces_of_place = 4;   ///< that a place outside is joined to
constexpr double surface_tolerance = 1e-3;  ///< of the diagonal: nearer places are on the surface

struct Bits {
  std::size_t operator()(const Vec3& p) const {
    std::size_t h = 0;
    for (int a = 0; a < 3; ++a) h = h * 1000003 + std::hash<double>()(p[a] + 0.0);
    return h;
  }
};

/// A vertex belongs to a set of points where its point does.
std::vector<bool> vertices_of(const std::vector<Index>& points, const TetBinding& binding, std::size_t count) {
  std::vector<bool> chosen(count, false), out(binding.point_of_vertex.size());
  for (const Index i : points) {
    CHECK(i < count, i, count);
    chosen[i] = true;
  }
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = chosen[binding.point_of_vertex[v]];
  return out;
}

class Planner {
 public:
  Planner(const Constraints& constraints, const TetMesh& mesh, const TetBinding& binding, const Shape& rest)
      : asked_(constraints),
        mesh_(mesh),
        binding_(binding),
        rest_(rest),
        diagonal_(bounds_of(mesh.vertices).diagonal()) {}

  TetPlan plan() {
    for (const Handle& handle : asked_.handles) add(handle);
    fix();
    turn_together();
    stiffen();
    return std::move(plan_);
  }

 private:
  const TetPlaces& places() {
    if (!places_) places_.emplace(mesh_);
    return *places_;
  }

  void add(const Handle& handle) {
    TetHandle out;
    std::vector<Index> at, tied;
    for (Index i = 0; i < handle.points.size(); ++i)
      if (const Index v = binding_.vertex_of_point[handle.points[i]]; v != TetBinding::none) {
        out.vertices.push_back(v);
        at.push_back(i);
      }
    if (out.vertices.empty())
      for (Index i = 0; i < handle.points.size(); ++i) {
        if (!rest_.positions[handle.points[i]].allFinite()) continue;
        out.ties.push_back(places().tie(rest_.positions[handle.points[i]]));
        tied.push_back(i);
      }
    for (Index i = 0; i < handle.places.size(); ++i) {
      const Index target = static_cast<Index>(handle.points.size()) + i;
      if (const std::optional<Index> v = joined(handle.places[i])) {
        out.vertices.push_back(*v);
        at.push_back(target);
      } else {
        out.ties.push_back(places().tie(handle.places[i]));
        tied.push_back(target);
      }
    }
    at.insert(at.end(), tied.begin(), tied.end());
    plan_.constraints.handles.push_back(std::move(out));
    plan_.at.push_back(std::move(at));
  }

  /// A vertex for a place outside, joined to the boundary.
  std::optional<Index> joined(const Vec3& p) {
    if (!p.allFinite() || !places().outside(p, surface_tolerance * diagonal_)) return std::nullopt;
    const std::vector<std::array<Index, 3>> faces = places().faces_before(p, faces_of_place);
    if (faces.empty()) {
      ++plan_.loose_places;
      return std::nullopt;
    }
    const Index v = static_cast<Index>(mesh_.vertices.size() + plan_.extra_vertices.size());
    plan_.extra_vertices.push_back(p);
    for (const auto& [a, b, c] : faces) plan_.extra_tets.push_back({a, b, c, v});
    return v;
  }

  void fix() {
    for (const Index i : asked_.fixed)
      if (const Index v = binding_.vertex_of_point[i]; v != TetBinding::none) plan_.constraints.fixed.push_back(v);
    if (!plan_.constraints.fixed.empty() || asked_.fixed.empty()) return;
    TetHandle out;
    for (const Index i : asked_.fixed) {
      if (!rest_.positions[i].allFinite()) continue;
      out.ties.push_back(places().tie(rest_.positions[i]));
      plan_.fixed_targets.push_back(rest_.positions[i]);
    }
    plan_.constraints.handles.push_back(std::move(out));
  }

  void turn_together() {
    std::vector<bool> taken(mesh_.tets.size(), false);
    for (const std::vector<Index>& points : asked_.rigid) {
      const std::vector<bool> in = vertices_of(points, binding_, rest_.size());
      std::vector<Index> group;
      for (Index j = 0; j < mesh_.tets.size(); ++j) {
        const Tet& tet = mesh_.tets[j];
        if (taken[j] || !std::all_of(tet.begin(), tet.end(), [&](Index v) { return in[v]; })) continue;
        taken[j] = true;
        group.push_back(j);
      }
      plan_.constraints.groups.push_back(std::move(group));
    }
  }

  /// A tet that lies half in what is stiff is so by the root of the factor.
  void stiffen() {
    if (asked_.stiffness.empty()) return;
    std::vector<double>& factors = plan_.constraints.stiffness;
    factors.assign(mesh_.tets.size() + plan_.extra_tets.size(), 1);
    for (const Stiff& stiff : asked_.stiffness) {
      const std::vector<bool> in = vertices_of(stiff.points, binding_, rest_.size());
      for (std::size_t j = 0; j < mesh_.tets.size(); ++j) {
        const auto corners = std::count_if(mesh_.tets[j].begin(), mesh_.tets[j].end(), [&](Index v) { return in[v]; });
        factors[j] *= std::pow(stiff.factor, static_cast<double>(corners) / 4);
      }
    }
  }

  const Constraints& asked_;
  const TetMesh& mesh_;
  const TetBinding& binding_;
  const Shape& rest_;
  double diagonal_;
  std::optional<TetPlaces> places_;
  TetPlan plan_;
};

}  // namespace

TetBinding bind_vertices(const TetMesh& mesh, const Shape& rest) {
  TetBinding out;
  out.vertex_of_point.assign(rest.size(), TetBinding::none);
  out.point_of_vertex.assign(mesh.vertices.size(), TetBinding::none);
  for (Index v = 0; v < mesh.points.size(); ++v) {
    out.vertex_of_point[mesh.points[v]] = v;
    out.point_of_vertex[v] = mesh.points[v];
  }
  // Points that lie on a vertex (the other corners of a soup, the shape of someone's own tets) are that vertex, too.
  std::unordered_map<Vec3, Index, Bits> at;
  for (Index v = 0; v < mesh.vertices.size(); ++v) at.emplace(mesh.vertices[v], v);
  std::vector<Vec3> finite;
  std::vector<Index> points;
  for (Index i = 0; i < rest.size(); ++i) {
    if (!rest.positions[i].allFinite()) continue;
    finite.push_back(rest.positions[i]);
    points.push_back(i);
    if (out.vertex_of_point[i] != TetBinding::none) continue;
    if (const auto found = at.find(rest.positions[i]); found != at.end()) {
      out.vertex_of_point[i] = found->second;
      if (out.point_of_vertex[found->second] == TetBinding::none) out.point_of_vertex[found->second] = i;
    }
  }
  std::vector<Index> without;
  std::vector<Vec3> queries;
  for (Index v = 0; v < mesh.vertices.size(); ++v)
    if (out.point_of_vertex[v] == TetBinding::none) {
      without.push_back(v);
      queries.push_back(mesh.vertices[v]);
    }
  if (without.empty() || finite.empty()) return out;
  std::vector<Index> near(without.size());
  std::vector<double> distance(without.size());
  NearestTree(finite).nearest(queries, 1, near, distance);
  for (std::size_t k = 0; k < without.size(); ++k) out.point_of_vertex[without[k]] = points[near[k]];
  return out;
}

TetPlan plan_constraints(const Constraints& constraints, const TetMesh& mesh, const TetBinding& binding,
                         const Shape& rest) {
  return Planner(constraints, mesh, binding, rest).plan();
}

}  // namespace sinew
