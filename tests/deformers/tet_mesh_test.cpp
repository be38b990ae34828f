/// Tets of closed surfaces: what is filled and what comes back. What is refused is in tet_hostile_test.cpp.

#include "deformers/tet_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "apps/samples/meshes.h"
#include "engine/geometry/error.h"
#include "engine/geometry/random.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/deformers/tet_shapes.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

struct Made {
  TetMesh mesh;
  std::string notes;
};

Made made(const Shape& shape, const TetMeshOptions& options = {}) {
  std::vector<std::string> notes;
  Made result{tetrahedralized(shape, options, notes).value(), ""};
  for (const std::string& note : notes) result.notes += note + "; ";
  return result;
}

double volume_of(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets)
    sum += tet_volume(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], mesh.vertices[t[3]]);
  return sum;
}

/// Of triangles, around their first vertex.
double enclosed(const std::vector<Vec3>& vertices, const std::vector<std::array<Index, 3>>& faces) {
  const Vec3 from = vertices[faces[0][0]];
  double sum = 0;
  for (const auto& [a, b, c] : faces) sum += tet_volume(from, vertices[a], vertices[b], vertices[c]);
  return sum;
}

double enclosed(const Shape& shape) {
  std::vector<std::array<Index, 3>> faces;
  const std::vector<Index> corners = triangles_of(shape.faces);
  for (std::size_t k = 0; k < corners.size(); k += 3) faces.push_back({corners[k], corners[k + 1], corners[k + 2]});
  return enclosed(shape.positions, faces);
}

/// Rotated so that the lowest comes first: the same for faces that are wound the same way.
std::array<Index, 3> turned(std::array<Index, 3> face) {
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

std::set<std::array<Index, 3>> boundary_over_points(const TetMesh& mesh) {
  std::set<std::array<Index, 3>> faces;
  for (const auto& [a, b, c] : mesh.boundary().faces)
    faces.insert(turned({mesh.points.at(a), mesh.points.at(b), mesh.points.at(c)}));
  return faces;
}

std::set<std::array<Index, 3>> triangles(const Shape& shape) {
  std::set<std::array<Index, 3>> faces;
  for (std::size_t f = 0; f < shape.faces.size(); ++f)
    faces.insert(turned({shape.faces[f][0], shape.faces[f][1], shape.faces[f][2]}));
  return faces;
}

/// V - E + F - T.
std::ptrdiff_t euler(const TetMesh& mesh) {
  std::set<std::array<Index, 2>> edges;
  std::set<std::array<Index, 3>> faces;
  for (Tet tet : mesh.tets) {
    std::sort(tet.begin(), tet.end());
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) edges.insert({tet[i], tet[j]});
      faces.insert({tet[i == 0], tet[i < 2 ? 2 : 1], tet[i < 3 ? 3 : 2]});
    }
  }
  return static_cast<std::ptrdiff_t>(mesh.vertices.size() + faces.size()) -
         static_cast<std::ptrdiff_t>(edges.size() + mesh.tets.size());
}

/// What holds of any: volumes, corners, vertices in the places of their points, a boundary that encloses the volume.
void check(const Shape& shape, const TetMesh& mesh) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const Tet& t : mesh.tets) {
    for (const Index v : t) used.at(v) = 1;
    ASSERT_GT(tet_volume(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], mesh.vertices[t[3]]), 0);
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
  ASSERT_LE(mesh.points.size(), mesh.vertices.size());
  EXPECT_TRUE(std::is_sorted(mesh.points.begin(), mesh.points.end()));
  for (std::size_t v = 0; v < mesh.points.size(); ++v) EXPECT_EQ(mesh.vertices[v], shape.positions.at(mesh.points[v]));
  const TetMesh::Boundary boundary = mesh.boundary();
  const double volume = volume_of(mesh);
  EXPECT_NEAR(enclosed(mesh.vertices, boundary.faces) / volume, 1, 1e-9);
  ASSERT_EQ(boundary.faces.size(), boundary.tets.size());
  for (std::size_t f = 0; f < boundary.faces.size(); ++f)
    for (const Index corner : boundary.faces[f]) {
      const Tet& tet = mesh.tets.at(boundary.tets[f]);
      EXPECT_NE(std::find(tet.begin(), tet.end(), corner), tet.end());
    }
}

Shape permuted(const Shape& shape) {
  std::vector<Index> order(shape.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [](Index a, Index b) { return random_unit(7, a) < random_unit(7, b); });
  Shape result = shape;
  std::vector<Index> number(order.size());
  for (Index i = 0; i < order.size(); ++i) {
    result.positions[i] = shape.positions[order[i]];
    number[order[i]] = i;
  }
  for (Index& corner : result.faces.points) corner = number[corner];
  return result;
}

Mat3 some_rotation() {
  return Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.7).normalized()).toRotationMatrix();
}

struct Solid {
  const char* name;
  Shape shape;
  std::ptrdiff_t euler;  ///< of the solid: parts - handles + cavities
  double volume;         ///< of the faces where 0
};

std::vector<Solid> solids() {
  const double inner = enclosed(sphere(Vec3::Zero(), 0.5));
  return {
      {"tetrahedron", tetrahedron(), 1, 1.0 / 6},
      {"box", box(), 1, 1},
      {"box far away", box({5400000, 0, 0}, {5400001, 1, 1}), 1, 1},
      {"sphere", sphere(), 1, 0},
      {"ring", torus(), 0, 0},
      {"two balls", both(sphere(), sphere({3, 0, 0}, 0.5)), 2, 0},
      {"two balls, one inside out", both(sphere(), inside_out(sphere({3, 0, 0}, 0.5))), 2, enclosed(sphere()) + inner},
      {"a cavity", both(sphere(), inside_out(sphere(Vec3::Zero(), 0.5))), 2, enclosed(sphere()) - inner},
      {"a cavity, all inside out", both(inside_out(sphere()), sphere(Vec3::Zero(), 0.5)), 2,
       enclosed(sphere()) - inner},
      {"a ball in a ball", both(sphere(), sphere(Vec3::Zero(), 0.5)), 1, enclosed(sphere())},
      {"a ball in a cavity", both(both(sphere(), inside_out(sphere(Vec3::Zero(), 0.5))), sphere(Vec3::Zero(), 0.25)), 3,
       enclosed(sphere()) - inner + inner / 8},
      {"boxes that touch in a corner", both(box(), box({1, 1, 1}, {2, 2, 2})), 1, 2},
      {"bar", samples::bar(), 1, 0},
      {"cylinder", samples::cylinder(), 1, 0},
  };
}

}  // namespace

TEST(TetMesh, FillsSolids) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const TetMesh mesh = made(solid.shape, {.vertices = 100000}).mesh;
    check(solid.shape, mesh);
    const double volume = solid.volume > 0 ? solid.volume : enclosed(solid.shape);
    EXPECT_NEAR(volume_of(mesh) / volume, 1, 1e-9);
    EXPECT_EQ(euler(mesh), solid.euler);
  }
}

TEST(TetMesh, TheBoundaryIsTheFaces) {
  for (const Shape& shape : {tetrahedron(), sphere(), torus(), samples::bar(), samples::cylinder(),
                             both(sphere(), inside_out(sphere(Vec3::Zero(), 0.5)))})
    EXPECT_EQ(boundary_over_points(made(shape, {.vertices = 100000}).mesh), triangles(shape));
}

TEST(TetMesh, InsideMakesBetterTets) {
  const Shape shape = torus();
  const TetMesh plain = made(shape).mesh, better = made(shape, {.inside = true}).mesh;
  check(shape, better);
  EXPECT_EQ(plain.points, better.points);
  EXPECT_GT(better.vertices.size(), better.points.size());
  EXPECT_EQ(boundary_over_points(better), triangles(shape));
  EXPECT_NEAR(volume_of(better) / volume_of(plain), 1, 1e-12);
}

TEST(TetMesh, AnyUnitGivesTheSameTets) {
  for (const Shape& shape : {sphere(), torus()})
    for (const bool inside : {false, true}) {
      const TetMeshOptions options{.vertices = 100000, .inside = inside};
      const TetMesh mesh = made(shape, options).mesh;
      for (const double scale : {0x1p100, 0x1p-100, 1000.0, 1e-3}) {
        const Shape scaled = moved(shape, [&](const Vec3& p) { return Vec3(p * scale); });
        const TetMesh other = made(scaled, options).mesh;
        check(scaled, other);
        EXPECT_NEAR(volume_of(other) / (volume_of(mesh) * scale * scale * scale), 1, 1e-9) << scale;
        EXPECT_EQ(boundary_over_points(other), boundary_over_points(mesh)) << scale;
        // A factor that rounds decides anew which of the cuts of points on one sphere is taken.
        const double counts = static_cast<double>(other.tets.size()) / static_cast<double>(mesh.tets.size());
        EXPECT_NEAR(counts, 1, 0.05) << scale;
        if (std::log2(scale) == std::round(std::log2(scale))) {
          EXPECT_TRUE(other.tets == mesh.tets) << scale;
        }
      }
    }
}

TEST(TetMesh, RigidMotion) {
  for (const Shape& shape : {box(), sphere(), torus(), samples::bar(), samples::cylinder()}) {
    const Shape other = moved(shape, [](const Vec3& p) { return Vec3(some_rotation() * p + Vec3(3, -2, 8)); });
    const TetMesh mesh = made(shape, {.vertices = 100000}).mesh, there = made(other, {.vertices = 100000}).mesh;
    check(other, there);
    EXPECT_NEAR(volume_of(there) / volume_of(mesh), 1, 1e-9);
    EXPECT_EQ(there.boundary().faces.size(), mesh.boundary().faces.size());
  }
}

TEST(TetMesh, TheOrderOfPointsOnlyRenumbers) {
  const Shape shape = torus(), other = permuted(shape);
  const TetMesh mesh = made(other).mesh;
  check(other, mesh);
  EXPECT_EQ(boundary_over_points(mesh), triangles(other));
  EXPECT_NEAR(volume_of(mesh) / enclosed(shape), 1, 1e-9);
}

TEST(TetMesh, TheSameAgain) {
  const TetMesh a = made(torus(), {.vertices = 300, .inside = true}).mesh,
                b = made(torus(), {.vertices = 300, .inside = true}).mesh;
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.vertices, b.vertices);
}

TEST(TetMesh, Decimates) {
  for (const Shape& shape : {sphere(Vec3::Zero(), 1, 96, 47), torus(96, 48), samples::bar(), samples::cactus(),
                             both(sphere(Vec3::Zero(), 1, 64, 31), inside_out(sphere(Vec3::Zero(), 0.8, 64, 31)))}) {
    const auto [mesh, notes] = made(shape, {.vertices = 600});
    check(shape, mesh);
    EXPECT_GE(mesh.points.size(), 590u);
    EXPECT_LE(mesh.points.size(), 620u);
    EXPECT_NEAR(volume_of(mesh) / enclosed(shape), 1, 0.05);
    EXPECT_NE(notes.find(" vertices decimated to "), std::string::npos) << notes;
  }
}

TEST(TetMesh, DecimatedPartsThatCrossGetMoreVertices) {
  // Shells nearer to each other than a coarse one is to the sphere.
  const Shape shape = both(sphere(Vec3::Zero(), 1, 96, 47), inside_out(sphere(Vec3::Zero(), 0.985, 96, 47)));
  const auto [mesh, notes] = made(shape, {.vertices = 400});
  check(shape, mesh);
  EXPECT_GT(mesh.points.size(), 600u);
  EXPECT_NE(notes.find("the faces crossed"), std::string::npos) << notes;
}

TEST(TetMesh, MendsAndTells) {
  const auto third = [](std::size_t f) { return f % 3 == 0; };
  const auto all = [](std::size_t) { return true; };
  Shape cut = with_faces(box(), [](std::size_t f) { return f != 1; });  // a flat triangle where an edge is cut
  cut.positions.emplace_back(0.5, 0, 1);
  add_face(cut, {4, 8, 5, 7, 6});
  add_face(cut, {4, 5, 8});
  Shape unused = both(sphere(), tetrahedron());
  unused.faces = sphere().faces;
  unused.positions.back() = Vec3::Constant(std::nan(""));
  const std::size_t joined = soup(sphere()).size() - sphere().size();
  const struct {
    Shape shape;
    double volume;
    std::string note;
    int close_holes = 0;
  } rows[] = {
      {with_faces(sphere(), all, third), enclosed(sphere()), " triangles turned to agree with neighbours"},
      {soup(sphere()), enclosed(sphere()), std::to_string(joined) + " points lie on others"},
      {both(sphere(), sphere()), enclosed(sphere()), "triangles given more than once"},
      {both(sphere(), inside_out(sphere())), enclosed(sphere()), "triangles given more than once"},
      {cut, 1, "1 triangle without area joined with neighbours"},
      {unused, enclosed(sphere()), ""},
      {with_faces(box(), [](std::size_t f) { return f != 1; }), 1, "1 hole closed", 4},
      {with_faces(box(), [](std::size_t f) { return f > 1; }), 1, "2 holes closed", 10},
      {inside_out(torus()), enclosed(torus()), ""},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.note);
    const auto [mesh, notes] = made(row.shape, {.close_holes = row.close_holes});
    check(row.shape, mesh);
    EXPECT_NEAR(volume_of(mesh) / row.volume, 1, 1e-9);
    EXPECT_NE(notes.find(row.note), std::string::npos) << notes;
    EXPECT_EQ(notes.empty(), row.note.empty()) << notes;
  }
  Shape flat = tetrahedron();
  add_face(flat, {0, 1});
  add_face(flat, {2, 2, 3});
  EXPECT_EQ(made(flat).notes, "2 faces without area left out; ");
}

TEST(TetMesh, ManyCornersAndHollowOnesAreCut) {
  // A prism over a star, whose ends are faces of 10 corners.
  Shape star;
  std::vector<Index> bottom, top;
  for (Index k = 0; k < 20; ++k) {
    const double angle = M_PI * (k % 10) / 5, r = k % 2 ? 0.4 : 1;
    star.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), k < 10 ? 0 : 1);
    if (k >= 10) continue;
    bottom.insert(bottom.begin(), k);
    top.push_back(10 + k);
    add_face(star, {k, (k + 1) % 10, 10 + (k + 1) % 10, 10 + k});
  }
  star.faces.add(bottom);
  star.faces.add(top);
  const TetMesh mesh = made(star).mesh;
  check(star, mesh);
  EXPECT_NEAR(volume_of(mesh), 10 * 0.5 * 0.4 * std::sin(M_PI / 5), 1e-12);
}

TEST(TetMesh, TakesTheTetsOfAShape) {
  Shape shape = box();
  shape.positions.emplace_back(9, 9, 9);
  shape.positions[5] = {1, 0, 1};
  shape.tets = {{0, 1, 2, 4}, {1, 3, 7, 2}, {1, 2, 4, 7}, {0, 1, 2, 3}};
  std::vector<std::string> notes;
  const TetMesh mesh = tet_mesh_of(shape, notes);
  check(shape, mesh);
  EXPECT_EQ(mesh.tets.size(), 3u);
  EXPECT_EQ(mesh.points, (std::vector<Index>{0, 1, 2, 3, 4, 7}));
  EXPECT_NEAR(volume_of(mesh), 2.0 / 3, 1e-15);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0], "1 tet turned, whose volume was negative");
  EXPECT_EQ(notes[1], "1 tet without volume left out");
  const auto error = [](Shape wrong, const std::vector<Tet>& tets) -> std::string {
    wrong.tets = tets;
    std::vector<std::string> none;
    try {
      tet_mesh_of(wrong, none);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error(shape, {{0, 1, 2, 9}}), "expected tets over 9 points, found point 9 in tet 0");
  EXPECT_EQ(error(shape, {}), "expected tets of a volume, found none");
  EXPECT_EQ(error(shape, {{0, 1, 2, 3}, {1, 1, 1, 1}}), "expected tets of a volume, found that all 2 have none");
  shape.positions[7].x() = std::nan("");
  EXPECT_EQ(error(shape, {{1, 2, 4, 7}}), "expected tets of a volume, found that all 1 have none");
}

TEST(TetMesh, RealMeshes) {
  SHARED_DATA(folder, "meshes");
  // Those without a sentence become tets, whole and decimated.
  const struct {
    const char* file;
    const char* sentence;
  } rows[] = {
      {"armadillo.obj", ""},
      {"bunny.off", ""},
      {"horse_quad.obj", ""},
      {"cheburashka.off", ""},
      {"decimated-max.obj", ""},
      {"3holes.off", ""},
      {"giraffe.obj", ""},
      {"lion.off", "a hole of 36 edges around (40.6565, 0.478377, -13.5383)"},
      {"camelhead.off", "a hole of 56 edges around ("},
      {"elephant.ply", "6 holes, the largest of 38 edges around (3.03767, 1.72598, 13.2046)"},
      {"bun_zipper_res2.ply", "125 edges of more: the first between points 2 and 443 in 3 faces: 6382, 6387, 6997"},
      {"camel_b.obj", "crossings of 20 faces: 1701, 1931, 1932"},
  };
  for (const auto& row : rows)
    for (const int vertices : {1000, 1000000}) {
      SCOPED_TRACE(row.file);
      const auto shape = io::read((folder / row.file).string());
      try {
        const TetMesh mesh = made(*shape, {.vertices = vertices}).mesh;
        EXPECT_STREQ(row.sentence, "");
        check(*shape, mesh);
        const double volume = volume_of(mesh) / std::abs(enclosed(*shape));
        EXPECT_NEAR(volume, 1, vertices > 1000 ? 1e-3 : 0.05) << "quads are cut otherwise here";
      } catch (const InputError& error) {
        EXPECT_NE(std::string(row.sentence), "") << error.what();
        EXPECT_NE(std::string(error.what()).find(row.sentence), std::string::npos) << error.what();
      }
    }
}

TEST(TetMesh, AllVerticesAreKeptWhereFewerCross) {
  SHARED_DATA(path, "meshes/decimated-max.obj");
  const auto shape = io::read(path.string());
  const auto [mesh, notes] = made(*shape, {.vertices = 5000});
  check(*shape, mesh);
  EXPECT_EQ(notes, "all 5272 vertices kept; decimated to 5000 the faces crossed; ");
}

TEST(TetMesh, TheBenchmarksBarIsClosed) {
  SHARED_DATA(path, "deform_benchmark/bar.off");
  const auto shape = io::read(path.string());
  std::vector<std::string> notes;
  EXPECT_THROW(tetrahedralized(*shape, {.vertices = 100000, .close_holes = 59}, notes), InputError);
  const auto [mesh, closed] = made(*shape, {.vertices = 100000, .close_holes = 60});
  check(*shape, mesh);
  EXPECT_EQ(closed, "1 hole closed; ");
}

}  // namespace sinew
