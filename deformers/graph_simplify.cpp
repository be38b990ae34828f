// OpenMesh is included here and nowhere else; its templates are slow to compile.
#include <OpenMesh/Core/IO/MeshIO.hh>  // must stand before the mesh type
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/vector_cast.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "deformers/graph_nodes.h"
#include "engine/geometry/topology.h"

namespace sinew {

namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

/// The shape's triangles as an OpenMesh mesh; counts those that it can't hold.
Mesh mesh_of(const Shape& shape, std::size_t& refused) {
  Mesh mesh;
  mesh.request_vertex_status();  // needed to delete, and its absence would end the program
  mesh.request_edge_status();
  mesh.request_face_status();
  std::vector<Mesh::VertexHandle> vertices;
  for (const Vec3& p : shape.positions) vertices.push_back(mesh.add_vertex({p.x(), p.y(), p.z()}));
  const std::vector<Index> triangles = triangles_of(shape.faces);
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const Index a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
    const bool whole = a != b && b != c && c != a && shape.positions[a].allFinite() && shape.positions[b].allFinite() &&
                       shape.positions[c].allFinite();
    if (!whole || !mesh.add_face(vertices[a], vertices[b], vertices[c]).is_valid()) ++refused;
  }
  return mesh;
}

}  // namespace

std::vector<Vec3> simplify_to_nodes(const Shape& shape, std::size_t count, std::string& note) {
  omerr().disable();  // it would print a line for each face that it refuses; they are counted instead
  std::size_t refused = 0;
  Mesh mesh = mesh_of(shape, refused);
  omerr().enable();
  mesh.delete_isolated_vertices();
  mesh.garbage_collection();
  if (refused > 0)
    note = std::to_string(refused) + " faces that are degenerate or not manifold were left out of the simplification";

  // A tight aspect ratio may stop the decimation early: loosen it until the count is reached.
  for (double aspect = 4; mesh.n_vertices() > count && aspect < 1e4; aspect *= 4) {
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    OpenMesh::Decimater::ModAspectRatioT<Mesh>::Handle ratio;
    decimater.add(quadric);
    decimater.add(ratio);
    decimater.module(quadric).unset_max_err();
    decimater.module(ratio).set_aspect_ratio(static_cast<float>(aspect));
    decimater.initialize();
    decimater.decimate_to(count);
    mesh.garbage_collection();
  }
  std::vector<Vec3> nodes;
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    nodes.emplace_back(p[0], p[1], p[2]);
  }
  return nodes;
}

}  // namespace sinew
