#include "engine/geometry/neighbour_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace sinew {

namespace {

Edges unique(Edges edges) {
  for (auto& [a, b] : edges)
    if (b < a) std::swap(a, b);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

TEST(NeighbourGraph, PointsAtOnePlaceAreOneVertex) {
  const double nan = std::nan("");
  const std::vector<Vec3> points = {Vec3(1, 0, 0), Vec3(nan, 0, 0),  Vec3(0, 0, 0), Vec3(1, -0.0, 0),
                                    Vec3(0, 1, 0), Vec3(-0.0, 0, 0), Vec3(1, 0, 0)};
  const Places places = places_of(points);
  EXPECT_EQ(places.of_point, (std::vector<Index>{0, Places::none, 1, 0, 2, 1, 0}));
  ASSERT_EQ(places.at.size(), 3u);
  EXPECT_EQ(places.at[2], Vec3(0, 1, 0));
  EXPECT_TRUE(places_of({}).at.empty());
}

TEST(NeighbourGraph, ASoupHasTheGraphOfItsWeldedMesh) {
  // A strip of quads, welded and as loose quads.
  Shape mesh, soup;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 2; ++y) mesh.positions.emplace_back(x, y, 0.1 * x * y);
  for (Index x = 0; x < 5; ++x) {
    const Index corners[] = {2 * x, 2 * x + 1, 2 * x + 3, 2 * x + 2};
    mesh.faces.add(corners);
    std::vector<Index> own;
    for (const Index c : corners) {
      own.push_back(static_cast<Index>(soup.size()));
      soup.positions.push_back(mesh.positions[c]);
    }
    soup.faces.add(own);
  }
  const Places a = places_of(mesh.positions), b = places_of(soup.positions);
  ASSERT_EQ(a.at.size(), b.at.size());
  std::set<std::vector<double>> of_mesh, of_soup;
  const auto ends = [](const Places& places, const std::pair<Index, Index>& e) {
    std::vector<std::vector<double>> both;
    for (const Index v : {e.first, e.second}) both.push_back({places.at[v].data(), places.at[v].data() + 3});
    std::sort(both.begin(), both.end());
    both[0].insert(both[0].end(), both[1].begin(), both[1].end());
    return both[0];
  };
  for (const auto& e : surface_of(mesh, a, 100).edges) of_mesh.insert(ends(a, e));
  for (const auto& e : surface_of(soup, b, 100).edges) of_soup.insert(ends(b, e));
  EXPECT_EQ(of_mesh, of_soup);
  EXPECT_EQ(of_mesh.size(), 6u + 2 * 5u + 2 * 5u);  // rungs, rails, diagonals
  EXPECT_EQ(parts_of(b.at.size(), surface_of(soup, b, 100).edges).count, 1u);
}

TEST(NeighbourGraph, FacesOfManyCornersAndDegenerateOnes) {
  Shape shape;
  for (int i = 0; i < 12; ++i) shape.positions.emplace_back(std::cos(i * M_PI / 6), std::sin(i * M_PI / 6), 0);
  shape.positions.emplace_back(std::nan(""), 0, 0);
  shape.positions.emplace_back(5, 5, 5);
  std::vector<Index> ring(12);
  for (Index i = 0; i < 12; ++i) ring[i] = i;
  shape.faces.add(ring);
  shape.faces.add(std::vector<Index>{});
  shape.faces.add(std::vector<Index>{3});
  shape.faces.add(std::vector<Index>{4, 4, 12});
  const Places places = places_of(shape.positions);
  const Edges edges = unique(surface_of(shape, places, 100).edges);
  EXPECT_EQ(edges.size(), 12u + 9u);  // the ring, and the fan from its first corner
  const GraphParts parts = parts_of(places.at.size(), edges);
  EXPECT_EQ(parts.count, 2u);
  EXPECT_EQ(parts.of_vertex.back(), 1u);
  const NeighbourGraph graph = neighbour_graph(places.at, edges);
  EXPECT_EQ(graph[0].size(), 11u);
  EXPECT_EQ(std::vector<Index>(graph[5].begin(), graph[5].end()), (std::vector<Index>{0, 4, 6}));
  EXPECT_TRUE(graph[12].empty());
}

TEST(NeighbourGraph, LargeFacesHavePointsInside) {
  // Two triangles and a quad around one edge, a sliver beside them: three faces at an edge, none of one size.
  Shape shape;
  shape.positions = {Vec3(0, 0, 0),  Vec3(10, 0, 0), Vec3(3, 6, 0),     Vec3(5, -2, 3),
                     Vec3(10, 0, 4), Vec3(0, 0, 4),  Vec3(40, 0.001, 0)};
  shape.faces.add(std::vector<Index>{0, 1, 2});
  shape.faces.add(std::vector<Index>{1, 0, 3});
  shape.faces.add(std::vector<Index>{0, 1, 4, 5});
  shape.faces.add(std::vector<Index>{0, 1, 6});
  EXPECT_TRUE(has_longer_sides(shape, 39));
  EXPECT_FALSE(has_longer_sides(shape, 41));
  const Places places = places_of(shape.positions);
  EXPECT_EQ(surface_of(shape, places, 41).vertices.size(), 7u);
  const Surface surface = surface_of(shape, places, 1.5);
  EXPECT_GT(surface.vertices.size(), 80u);
  EXPECT_LT(surface.vertices.size(), 400u);
  for (const auto& [a, b] : surface.edges) EXPECT_LE((surface.vertices[a] - surface.vertices[b]).norm(), 1.5);
  EXPECT_EQ(parts_of(surface.vertices.size(), surface.edges).count, 1u);
  // The faces meet in the same points of their common edge: nowhere do two stand at one place.
  EXPECT_EQ(places_of(surface.vertices).at.size(), surface.vertices.size());
  // A length that does not ask for more points than a few times those there are.
  EXPECT_GT(edge_length_for(shape, 1e-9, 100), 0.03);
  EXPECT_EQ(edge_length_for(shape, 7, 100), 7);
}

TEST(NeighbourGraph, ACloudIsJoinedToItsNearPoints) {
  Shape cloud;
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y) cloud.positions.emplace_back(x, y, 0);
  for (int y = 0; y < 10; ++y) cloud.positions.emplace_back(30, y, 0);
  const Places places = places_of(cloud.positions);
  const Edges edges = surface_of(cloud, places, 100).edges;
  const GraphParts parts = parts_of(places.at.size(), edges);
  EXPECT_EQ(parts.count, 2u);
  EXPECT_EQ(parts.of_vertex[100], 1u);
  const NeighbourGraph graph = neighbour_graph(places.at, edges);
  for (Index v = 0; v < graph.size(); ++v) {
    EXPECT_GE(graph[v].size(), 2u);
    for (const Index w : graph[v]) {
      EXPECT_NE(v, w);
      EXPECT_TRUE(std::binary_search(graph[w].begin(), graph[w].end(), v));
    }
  }
}

}  // namespace sinew
