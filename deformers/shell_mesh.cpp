#include "deformers/shell_mesh.h"

#include <algorithm>
#include <map>

#include "engine/geometry/error.h"
#include "engine/geometry/neighbour_graph.h"
#include "engine/geometry/topology.h"

namespace sinew {

namespace {

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + (count == 1 ? one : many);
}

void require_correspondence(const Shape& rest, const Shape& example, std::size_t number) {
  if (const std::string difference = difference_of_faces(rest, example); !difference.empty())
    throw InputError((number > 0 ? "example " + std::to_string(number) : "what the examples are poses of") +
                     " does not correspond to the rest shape: " + difference);
}

/// The class of each point: points at the same place in every pose share one, numbered by their lowest point.
std::vector<Index> shared_vertices(const std::vector<std::vector<Vec3>>& poses, std::vector<Index>& point_of_vertex) {
  std::vector<Index> of_point = places_of(poses.front()).of_point;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const std::vector<Index> places = places_of(poses[k]).of_point;
    std::map<std::pair<Index, Index>, Index> both;
    for (std::size_t i = 0; i < of_point.size(); ++i)
      if (of_point[i] != Places::none)
        of_point[i] = both.emplace(std::pair(of_point[i], places[i]), static_cast<Index>(both.size())).first->second;
  }
  std::vector<Index> lowest;
  for (Index i = 0; i < of_point.size(); ++i)
    if (of_point[i] != Places::none && of_point[i] >= lowest.size()) lowest.push_back(i);
  point_of_vertex = std::move(lowest);
  return of_point;
}

/// Leaves out vertices of no triangle.
void compact(ShellMesh& mesh) {
  std::vector<bool> used(mesh.point_of_vertex.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) used[v] = true;
  std::vector<Index> number(used.size(), ShellMesh::none);
  std::vector<Index> kept;
  for (Index v = 0; v < used.size(); ++v)
    if (used[v]) {
      number[v] = static_cast<Index>(kept.size());
      kept.push_back(mesh.point_of_vertex[v]);
    }
  mesh.point_of_vertex = std::move(kept);
  for (Triangle& t : mesh.triangles)
    for (Index& v : t) v = number[v];
  for (Index& v : mesh.vertex_of_point)
    if (v != ShellMesh::none) v = number[v];
}

}  // namespace

ShellMesh shell_mesh_of(const Shape& rest, std::span<const std::shared_ptr<const Shape>> examples,
                        const Shape* source) {
  ShellMesh mesh;
  std::vector<std::vector<Vec3>> poses{rest.positions};
  for (std::size_t k = 0; k < examples.size(); ++k) {
    require_correspondence(rest, *examples[k], k + 1);
    poses.push_back(examples[k]->positions);
    for (Vec3& p : poses.back()) p += examples[k]->origin - rest.origin;
  }
  if (source != nullptr) {
    require_correspondence(rest, *source, 0);
    poses.push_back(source->positions);
  }
  mesh.vertex_of_point = shared_vertices(poses, mesh.point_of_vertex);

  const std::vector<Index> corners = triangles_of(rest.faces);
  std::size_t dropped = 0;
  for (std::size_t c = 0; c + 2 < corners.size(); c += 3) {
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) t[k] = mesh.vertex_of_point[corners[c + k]];
    const bool known = std::none_of(t.begin(), t.end(), [](Index v) { return v == ShellMesh::none; });
    if (known && t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
      mesh.triangles.push_back(t);
    else
      ++dropped;
  }
  if (mesh.triangles.empty())
    throw InputError(std::string("expected faces for a shell, found ") +
                     (rest.faces.empty() ? "none: bend points without faces with method graph"
                                         : "only faces whose corners are in one place or not finite"));
  const auto finite = static_cast<std::size_t>(std::count_if(mesh.vertex_of_point.begin(), mesh.vertex_of_point.end(),
                                                             [](Index v) { return v != ShellMesh::none; }));
  const std::size_t shared = finite - mesh.point_of_vertex.size();
  compact(mesh);
  for (const std::vector<Vec3>& pose : poses) {
    mesh.poses.emplace_back();
    for (const Index i : mesh.point_of_vertex) mesh.poses.back().push_back(pose[i]);
  }
  if (source != nullptr) {
    mesh.source = std::move(mesh.poses.back());
    mesh.poses.pop_back();
  }
  if (dropped > 0)
    mesh.notes.push_back(counted(dropped, " triangle was", " triangles were") +
                         " left out of the shell: corners in one place, or not finite.");
  if (shared > 0)
    mesh.notes.push_back(
        counted(shared, " point is", " points are") +
        (shared == 1 ? " in the place of another and moves with it." : " in the place of another and move with it."));
  const auto loose =
      static_cast<std::size_t>(std::count(mesh.vertex_of_point.begin(), mesh.vertex_of_point.end(), ShellMesh::none));
  if (loose > 0)
    mesh.notes.push_back(counted(loose, " point is", " points are") +
                         " on no face: the nearest part of the surface carries " + (loose == 1 ? "it." : "them."));
  return mesh;
}

}  // namespace sinew
