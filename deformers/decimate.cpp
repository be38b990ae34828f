// OpenMesh is included here and nowhere else; its templates are slow to compile.
#include <OpenMesh/Core/IO/MeshIO.hh>  // must stand before the mesh type
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/vector_cast.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Decimater/Observer.hh>

#include "deformers/decimate.h"

namespace sinew {

namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexTraits { Index number = 0; };
  FaceTraits { Index number = 0; };
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

class Watcher : public OpenMesh::Decimater::Observer {
 public:
  explicit Watcher(const std::function<bool()>& go_on) : Observer(1000), go_on_(go_on) {}
  void notify(std::size_t) override { stopped_ = stopped_ || (go_on_ && !go_on_()); }
  bool abort() const override { return stopped_; }

 private:
  const std::function<bool()>& go_on_;
  bool stopped_ = false;
};

/// Counts the triangles that the mesh can't hold.
Mesh mesh_of(const std::vector<Vec3>& positions, const std::vector<std::array<Index, 3>>& triangles,
             std::size_t& refused) {
  Mesh mesh;
  mesh.request_vertex_status();  // needed to delete, and its absence would end the program
  mesh.request_edge_status();
  mesh.request_face_status();
  omerr().disable();  // it would print a line for each face that it refuses; they are counted instead
  std::vector<Mesh::VertexHandle> vertices;
  for (const Vec3& p : positions) {
    vertices.push_back(mesh.add_vertex({p.x(), p.y(), p.z()}));
    mesh.data(vertices.back()).number = static_cast<Index>(vertices.size() - 1);
  }
  for (Index t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    const auto face = mesh.add_face(vertices[a], vertices[b], vertices[c]);
    if (face.is_valid())
      mesh.data(face).number = t;
    else
      ++refused;
  }
  omerr().enable();
  mesh.delete_isolated_vertices();
  mesh.garbage_collection();
  return mesh;
}

}  // namespace

Decimated decimated(const std::vector<Vec3>& positions, const std::vector<std::array<Index, 3>>& triangles,
                    std::size_t count, bool keep_normals, const std::function<bool()>& go_on) {
  Decimated result;
  Mesh mesh = mesh_of(positions, triangles, result.refused);
  if (keep_normals) {
    mesh.request_face_normals();
    mesh.update_face_normals();
  }
  Watcher watcher(go_on);
  // A tight aspect ratio may stop the decimation early: loosen it until the count is reached.
  for (double aspect = 4; mesh.n_vertices() > count && aspect < 1e4 && !watcher.abort(); aspect *= 4) {
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    OpenMesh::Decimater::ModAspectRatioT<Mesh>::Handle ratio;
    OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
    decimater.add(quadric);
    decimater.add(ratio);
    decimater.module(quadric).unset_max_err();
    decimater.module(ratio).set_aspect_ratio(static_cast<float>(aspect));
    if (keep_normals) {
      decimater.add(flipping);
      decimater.module(flipping).set_max_normal_deviation(60);
    }
    decimater.set_observer(&watcher);
    decimater.initialize();
    decimater.decimate_to(count);
    mesh.garbage_collection();
  }
  for (const auto vertex : mesh.vertices()) result.vertices.push_back(mesh.data(vertex).number);
  for (const auto face : mesh.faces()) {
    std::array<Index, 3> corners{};
    std::size_t k = 0;
    for (auto corner = mesh.cfv_iter(face); corner.is_valid() && k < 3; ++corner)
      corners[k++] = mesh.data(*corner).number;
    result.triangles.push_back(corners);
    result.origins.push_back(mesh.data(face).number);
  }
  return result;
}

}  // namespace sinew
