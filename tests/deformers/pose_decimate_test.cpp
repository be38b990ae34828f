#include "deformers/pose_decimate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <set>

#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/deformers/triangle_shapes.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

using test::both;
using test::bumpy_torus;
using test::edge_counts;
using test::Mesh;
using test::sheet;
using Triangles = std::vector<std::array<Index, 3>>;

Vec3 place_in(const PoseDecimated& coarse, Index v, const std::vector<Vec3>& pose) {
  const PoseDecimated::Place& place = coarse.places[v];
  const auto& t = coarse.triangles[place.triangle];
  return place.coordinates[0] * pose[t[0]] + place.coordinates[1] * pose[t[1]] + place.coordinates[2] * pose[t[2]];
}

/// What is true of every result: each sentence that is not.
std::vector<std::string> faults(const PoseDecimated& coarse, const Mesh& mesh) {
  std::vector<std::string> out;
  const std::set<Index> vertices(coarse.vertices.begin(), coarse.vertices.end());
  if (!std::is_sorted(coarse.vertices.begin(), coarse.vertices.end())) out.push_back("vertices not ascending");
  std::set<Index> used, cornered;
  for (const auto& t : coarse.triangles) used.insert(t.begin(), t.end());
  if (used != vertices) out.push_back("vertices are not the triangles' corners");
  for (const auto& t : mesh.triangles)
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) cornered.insert(t.begin(), t.end());
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    const PoseDecimated::Place& place = coarse.places[v];
    if (cornered.contains(v) != (place.triangle != PoseDecimated::none)) out.push_back("a place too many or too few");
    if (place.triangle == PoseDecimated::none) continue;
    if (place.triangle >= coarse.triangles.size()) return {"a place on no triangle"};
    if (place.coordinates.minCoeff() < 0 || std::abs(place.coordinates.sum() - 1) > 1e-12)
      out.push_back("coordinates outside");
    if (vertices.contains(v) &&
        (place_in(coarse, v, mesh.positions) != mesh.positions[v] || place.coordinates.maxCoeff() != 1))
      out.push_back("a coarse vertex not in its place");
  }
  return out;
}

int euler_number(const PoseDecimated& coarse) {
  return static_cast<int>(coarse.vertices.size()) - static_cast<int>(edge_counts(coarse.triangles).size()) +
         static_cast<int>(coarse.triangles.size());
}

int edges_of_one(const Triangles& triangles) {
  int count = 0;
  for (const auto& [edge, n] : edge_counts(triangles)) count += n == 1;
  return count;
}

/// The least cosine between a coarse triangle's normal in `pose` and that of a fine triangle around its corners.
double turned_triangles(const PoseDecimated& coarse, const Mesh& mesh, const std::vector<Vec3>& pose) {
  const auto normal = [&](const std::array<Index, 3>& t) {
    return Vec3((pose[t[1]] - pose[t[0]]).cross(pose[t[2]] - pose[t[0]]).normalized());
  };
  std::vector<Vec3> fine(pose.size(), Vec3::Zero());
  for (const auto& t : mesh.triangles)
    for (const Index v : t) fine[v] += normal(t);
  double least = 1;
  for (const auto& t : coarse.triangles)
    least = std::min(least, normal(t).dot((fine[t[0]] + fine[t[1]] + fine[t[2]]).normalized()));
  return least;
}

}  // namespace

TEST(PoseDecimate, ClosedStaysClosedInEveryPose) {
  const Mesh rest = bumpy_torus(90, 40);
  const std::vector<std::vector<Vec3>> poses{rest.positions, bumpy_torus(90, 40, 0.3).positions,
                                             bumpy_torus(90, 40, -0.5).positions};
  const PoseDecimated coarse = decimated_together(poses, rest.triangles, 300);
  EXPECT_EQ(faults(coarse, rest), std::vector<std::string>{});
  EXPECT_EQ(coarse.vertices.size(), 300u);
  EXPECT_EQ(euler_number(coarse), 0);
  for (const auto& [edge, count] : edge_counts(coarse.triangles)) EXPECT_EQ(count, 2);
  for (const auto& pose : poses) EXPECT_GT(turned_triangles(coarse, rest, pose), 0.3);
  for (Index v = 0; v < rest.positions.size(); ++v)
    EXPECT_LT((place_in(coarse, v, rest.positions) - rest.positions[v]).norm(), 0.08) << v;
}

// Waves everywhere in both poses, of which those on the left are turned over: in each pose alone both sides are alike.
TEST(PoseDecimate, VerticesGatherWherePosesDiffer) {
  const Mesh flat = sheet(40);
  std::vector<std::vector<Vec3>> poses(2, flat.positions);
  for (std::size_t v = 0; v < flat.positions.size(); ++v) {
    const double x = flat.positions[v].x(), wave = 0.02 * std::sin(4 * 2 * M_PI * x);
    poses[0][v].z() = wave;
    poses[1][v].z() = x < 0.5 ? -wave : wave;
  }
  const PoseDecimated coarse = decimated_together(poses, flat.triangles, 200);
  const auto left = std::ranges::count_if(coarse.vertices, [&](Index v) { return flat.positions[v].x() < 0.49; });
  const auto right = std::ranges::count_if(coarse.vertices, [&](Index v) { return flat.positions[v].x() > 0.51; });
  EXPECT_GT(static_cast<double>(left), 1.15 * static_cast<double>(right));
}

// Two poses that bend at different places keep vertices at both.
TEST(PoseDecimate, VerticesGatherWhereAnyPoseBends) {
  const Mesh flat = sheet(40);
  std::vector<std::vector<Vec3>> poses(3, flat.positions);
  for (Vec3& p : poses[1]) p.z() = std::max(0.0, 0.1 - std::abs(p.x() - 0.25));
  for (Vec3& p : poses[2]) p.z() = std::max(0.0, 0.1 - std::abs(p.x() - 0.75));
  const auto near = [&](const PoseDecimated& coarse, double x) {
    return std::count_if(coarse.vertices.begin(), coarse.vertices.end(),
                         [&](Index v) { return std::abs(flat.positions[v].x() - x) < 0.12; });
  };
  const PoseDecimated one = decimated_together(std::span(poses).first(2), flat.triangles, 200);
  const PoseDecimated all = decimated_together(poses, flat.triangles, 200);
  EXPECT_GT(near(one, 0.25), 2 * near(one, 0.75));
  EXPECT_GT(near(all, 0.75), 1.5 * static_cast<double>(near(one, 0.75)));
  EXPECT_GT(near(all, 0.25), 2 * near(all, 0.5));
}

TEST(PoseDecimate, BoundaryStaysWhereItIs) {
  const Mesh flat = sheet(30);
  const std::vector<std::vector<Vec3>> poses{flat.positions, sheet(30, 0.2).positions};
  const PoseDecimated coarse = decimated_together(poses, flat.triangles, 100);
  EXPECT_EQ(faults(coarse, flat), std::vector<std::string>{});
  EXPECT_EQ(coarse.vertices.size(), 100u);
  EXPECT_EQ(euler_number(coarse), 1);
  double area = 0;
  for (const auto& t : coarse.triangles) {
    const Vec3 &a = flat.positions[t[0]], &b = flat.positions[t[1]], &c = flat.positions[t[2]];
    area += (b - a).cross(c - a).z() / 2;
  }
  EXPECT_NEAR(area, 1, 1e-9);
  for (const auto& [edge, count] : edge_counts(coarse.triangles))
    if (count == 1)
      for (const Index v : {edge.first, edge.second}) {
        const Vec3& p = flat.positions[v];
        EXPECT_TRUE(p.x() == 0 || p.x() == 1 || p.y() == 0 || p.y() == 1) << p.transpose();
      }
}

// Two poses within one plane, shaken apart from each other: no triangle turns over in either.
TEST(PoseDecimate, NothingFoldsOverInAnyPose) {
  const Mesh flat = sheet(40);
  std::vector<std::vector<Vec3>> poses(2, flat.positions);
  for (Index v = 0; v < flat.positions.size(); ++v)
    for (int k = 0; k < 2; ++k) {
      Vec3& p = poses[static_cast<std::size_t>(k)][v];
      for (int c = 0; c < 2; ++c)
        p[c] += 0.08 * std::sin(7 * flat.positions[v][1 - c] + 3 * k) + 0.004 * (random_unit(10 + 2 * k + c, v) - 0.5);
    }
  const auto least = [&](const std::vector<std::array<Index, 3>>& triangles, const std::vector<Vec3>& pose) {
    double area = 1;
    for (const auto& t : triangles) area = std::min(area, (pose[t[1]] - pose[t[0]]).cross(pose[t[2]] - pose[t[0]]).z());
    return area;
  };
  const PoseDecimated coarse = decimated_together(poses, flat.triangles, 60);
  EXPECT_LT(coarse.vertices.size(), 100u);
  for (const auto& pose : poses) {
    ASSERT_GT(least(flat.triangles, pose), 0);
    EXPECT_GT(least(coarse.triangles, pose), 0);
  }
}

TEST(PoseDecimate, VerticesThatAreToBeKeptAreKept) {
  const Mesh rest = bumpy_torus(40, 20);
  std::vector<Index> keep;
  for (Index v = 0; v < 800; v += 7) keep.push_back(v);
  const PoseDecimated coarse = decimated_together({{rest.positions}}, rest.triangles, 50, keep);
  EXPECT_EQ(faults(coarse, rest), std::vector<std::string>{});
  EXPECT_TRUE(std::includes(coarse.vertices.begin(), coarse.vertices.end(), keep.begin(), keep.end()));
  EXPECT_LT(coarse.vertices.size(), keep.size() + 20);
}

// A sheet folded onto itself, a thousandth of an edge apart: each point stays on its own side.
TEST(PoseDecimate, WhatTouchesIsNotJoined) {
  const Mesh flat = sheet(40);
  Mesh folded = flat;
  for (Vec3& p : folded.positions)
    if (p.x() > 0.5) p = {1 - p.x(), p.y(), 3e-5};
  const PoseDecimated coarse = decimated_together({{folded.positions}}, folded.triangles, 80);
  EXPECT_EQ(faults(coarse, folded), std::vector<std::string>{});
  EXPECT_EQ(euler_number(coarse), 1);
  for (Index v = 0; v < flat.positions.size(); ++v)
    EXPECT_LT((place_in(coarse, v, flat.positions) - flat.positions[v]).norm(), 0.2) << flat.positions[v].transpose();
}

TEST(PoseDecimate, ResultsDoNotDependOnUnitOrOffset) {
  const Mesh rest = bumpy_torus(40, 20);
  std::vector<Vec3> moved;
  for (const Vec3& p : rest.positions) moved.push_back(1024 * p);
  const PoseDecimated a = decimated_together({{rest.positions}}, rest.triangles, 100);
  const PoseDecimated b = decimated_together({{moved}}, rest.triangles, 100);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

// To nothing: every component stays, as a tetrahedron, or as a triangle where it is open.
TEST(PoseDecimate, ComponentsDoNotVanish) {
  Mesh tetrahedron;
  tetrahedron.positions = {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const Mesh all = both(both(bumpy_torus(30, 20), sheet(10, 0, 3)), tetrahedron);
  const PoseDecimated coarse = decimated_together({{all.positions}}, all.triangles, 0);
  EXPECT_EQ(faults(coarse, all), std::vector<std::string>{});
  EXPECT_EQ(euler_number(coarse), 0 + 1 + 2);
  EXPECT_GE(edges_of_one(coarse.triangles), 3);
  EXPECT_LT(coarse.vertices.size(), 40u);
}

TEST(PoseDecimate, HostileMeshes) {
  // An edge of three triangles, a triangle twice, one with a corner twice, one that is not finite, a point alone.
  Mesh odd = both(sheet(12), sheet(12, 0, 1));
  odd.positions.insert(odd.positions.end(), {{0.5, 0.5, 2}, {9, 9, 9}, {std::nan(""), 0, 0}});
  const auto extra = static_cast<Index>(odd.positions.size() - 3);
  odd.triangles.push_back({60, 61, extra});
  odd.triangles.push_back(odd.triangles[100]);
  odd.triangles.push_back({5, 5, 6});
  odd.triangles.push_back({7, 8, extra + 2});
  const PoseDecimated coarse = decimated_together({{odd.positions}}, odd.triangles, 30);
  EXPECT_LT(coarse.vertices.size(), 60u);
  EXPECT_EQ(coarse.places[extra + 1].triangle, PoseDecimated::none);
  EXPECT_EQ(coarse.places[extra + 2].triangle, PoseDecimated::none);
  const auto edges = edge_counts(coarse.triangles);
  const auto at = edges.find({60, 61});
  ASSERT_NE(at, edges.end());
  EXPECT_EQ(at->second, 3);

  // All at one point, on one line, far too large: a result that holds together.
  for (const Vec3& scale : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1e200, 1e200, 1e200)}) {
    Mesh flat = bumpy_torus(20, 10);
    for (Vec3& p : flat.positions) p = p.cwiseProduct(scale);
    const PoseDecimated few = decimated_together({{flat.positions}}, flat.triangles, 30);
    EXPECT_EQ(faults(few, flat), std::vector<std::string>{}) << scale.transpose();
    EXPECT_EQ(euler_number(few), 0) << scale.transpose();
  }
  // A tetrahedron without size has no normals that would forbid to lay it flat.
  const std::vector<Vec3> point(4, Vec3(1, 2, 3));
  EXPECT_EQ(decimated_together({{point}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}, 0).triangles.size(), 4u);
  const PoseDecimated none = decimated_together({{std::vector<Vec3>{}}}, {}, 10);
  EXPECT_TRUE(none.vertices.empty() && none.triangles.empty());
}

// Two sheets that share an inner vertex, and nothing else.
TEST(PoseDecimate, WhatIsNotADiscStays) {
  Mesh two = both(sheet(12), sheet(12));
  for (auto& t : two.triangles)
    for (Index& v : t)
      if (v == 144 + 77) v = 77;
  const PoseDecimated coarse = decimated_together({{two.positions}}, two.triangles, 12);
  EXPECT_EQ(faults(coarse, two), std::vector<std::string>{});
  EXPECT_TRUE(std::binary_search(coarse.vertices.begin(), coarse.vertices.end(), 77u));
  for (const bool first : {true, false})
    EXPECT_TRUE(std::any_of(coarse.triangles.begin(), coarse.triangles.end(), [&](const auto& t) {
      return std::any_of(t.begin(), t.end(), [](Index v) { return v == 77; }) &&
             std::all_of(t.begin(), t.end(), [&](Index v) { return v == 77 || (v < 144) == first; });
    }));
}

TEST(PoseDecimate, StopsWhenTold) {
  const Mesh rest = bumpy_torus(90, 40);
  int asked = 0;
  const PoseDecimated coarse =
      decimated_together({{rest.positions}}, rest.triangles, 50, {}, [&] { return ++asked < 2; });
  EXPECT_TRUE(coarse.stopped);
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(faults(coarse, rest), std::vector<std::string>{});
  EXPECT_GT(coarse.vertices.size(), 1000u);
}

TEST(PoseDecimate, HorsePoses) {
  SHARED_DATA(folder, "poses/sumner_horse");
  std::vector<std::vector<Vec3>> poses;
  Mesh mesh;
  for (const char* name : {"1.obj", "3.obj", "5.obj", "8.obj", "10.obj"}) {
    const auto shape = io::read((folder / name).string());
    const std::vector<Index> corners = triangles_of(shape->faces);
    mesh.triangles.clear();
    for (std::size_t k = 0; k < corners.size(); k += 3)
      mesh.triangles.push_back({corners[k], corners[k + 1], corners[k + 2]});
    poses.push_back(shape->positions);
  }
  mesh.positions = poses[0];
  const PoseDecimated coarse = decimated_together(poses, mesh.triangles, 1000);
  EXPECT_EQ(faults(coarse, mesh), std::vector<std::string>{});
  EXPECT_EQ(coarse.vertices.size(), 1000u);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  for (const auto& pose : poses) {
    double sum = 0;
    for (Index v = 0; v < pose.size(); ++v) sum += (place_in(coarse, v, pose) - pose[v]).squaredNorm();
    EXPECT_LT(std::sqrt(sum / static_cast<double>(pose.size())), 0.0025 * box.diagonal().norm());
  }
}

}  // namespace sinew
