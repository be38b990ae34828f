#include "engine/geometry/surface_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/geometry/bounds.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/surface_pieces.h"
#include "tests/geometry/lobed_body.h"

namespace sinew {
namespace {

/// A similarity of any turn, scaled by 1e-3 to 1e3.
Similarity any_similarity(std::uint64_t seed) {
  const auto value = [&](std::uint64_t i) { return 2 * random_unit(seed, i) - 1; };
  Similarity out;
  out.scale = std::pow(10, 3 * value(0));
  out.R = Eigen::Quaterniond(value(1), value(2), value(3), value(4)).normalized().toRotationMatrix();
  out.t = out.scale * 50 * Vec3(value(5), value(6), value(7));
  return out;
}

std::vector<Vec3> mapped(std::vector<Vec3> points, const Similarity& map) {
  for (Vec3& p : points) p = map(p);
  return points;
}

/// How far `fit` takes the moved points from where they were, the most, in diagonals.
double error_of(const SurfaceFit& fit, std::span<const Vec3> points, const Similarity& moved_by, const Shape& body) {
  double out = 0;
  for (const Vec3& p : points) out = std::max(out, (fit.map(moved_by(p)) - p).norm());
  return out / bounds_of(body.positions).diagonal();
}

TEST(SurfaceFit, FindsAnySimilarityOfPointsOnTheSurface) {
  const Shape body = test::lobed_body();
  constexpr std::uint64_t rounds = 12;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= rounds; ++seed) {
    const std::vector<Vec3> points = test::places_on(body, 40, seed);
    const Similarity moved = any_similarity(seed);
    const auto fit = fit_to_surface(mapped(points, moved), body, std::nullopt);
    ASSERT_TRUE(fit.has_value());
    if (error_of(*fit, points, moved, body) > 2e-4) continue;
    ++found;
    EXPECT_NEAR(fit->map.scale * moved.scale, 1, 1e-4) << seed;
    EXPECT_EQ(fit->near, 1) << seed;
    EXPECT_LT(fit->rms, 1e-4) << seed;
  }
  // The starts are many, not all: of 60 seeds one ends elsewhere, and it is among these.
  EXPECT_GE(found, 11);
}

TEST(SurfaceFit, PointsBesideTheSurfaceAndSomeFarFromItDoNotPull) {
  const Shape body = test::lobed_body();
  const double diagonal = bounds_of(body.positions).diagonal();
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    std::vector<Vec3> points = test::places_on(body, 45, seed);
    const auto noise = [&](std::uint64_t i) { return 2 * random_unit(seed + 100, i) - 1; };
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double size = i < 3 ? 0.15 : 0.004;
      points[i] += size * diagonal * Vec3(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2));
    }
    const Similarity moved = any_similarity(seed);
    const auto fit = fit_to_surface(mapped(points, moved), body, std::nullopt);
    ASSERT_TRUE(fit.has_value());
    EXPECT_LT(error_of(*fit, points, moved, body), 0.01) << seed;
    EXPECT_GT(fit->near, 0.9) << seed;
  }
}

TEST(SurfaceFit, AGivenScaleIsKept) {
  const Shape body = test::lobed_body();
  const std::vector<Vec3> points = test::places_on(body, 40, 3);
  const Similarity moved = any_similarity(5);
  const auto fit = fit_to_surface(mapped(points, moved), body, 1 / moved.scale);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->map.scale * moved.scale, 1, 1e-14);
  EXPECT_LT(error_of(*fit, points, moved, body), 2e-4);
  const auto wrong = fit_to_surface(mapped(points, moved), body, 1.5 / moved.scale);
  ASSERT_TRUE(wrong.has_value());
  EXPECT_NEAR(wrong->map.scale * moved.scale, 1.5, 1e-14);
  EXPECT_LT(wrong->near, 0.85);
}

TEST(SurfaceFit, DoesNotDependOnTheOrderOfPointsNorOnThreads) {
  const Shape body = test::lobed_body();
  std::vector<Vec3> points = mapped(test::places_on(body, 36, 4), any_similarity(9));
  const auto fit = fit_to_surface(points, body, std::nullopt);
  ASSERT_TRUE(fit.has_value());
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    const auto again = fit_to_surface(points, body, std::nullopt);
    ASSERT_TRUE(again.has_value());
    EXPECT_TRUE(again->map.R == fit->map.R && again->map.t == fit->map.t && again->map.scale == fit->map.scale);
  }
  set_thread_count(2);

  // Points, vertices and faces the other way round.
  Shape other;
  const Index n = static_cast<Index>(body.size());
  other.positions.assign(body.positions.rbegin(), body.positions.rend());
  for (std::size_t f = body.faces.size(); f-- > 0;) {
    std::vector<Index> corners(body.faces[f].begin(), body.faces[f].end());
    for (Index& corner : corners) corner = n - 1 - corner;
    other.faces.add(corners);
  }
  std::reverse(points.begin(), points.end());
  const auto reversed = fit_to_surface(points, other, std::nullopt);
  ASSERT_TRUE(reversed.has_value());
  for (const Vec3& p : points) EXPECT_LT((reversed->map(p) - fit->map(p)).norm(), 1e-4);
}

TEST(SurfaceFit, WhatLiesNowhereOnTheSurfaceIsTold) {
  const Shape body = test::lobed_body();
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    std::vector<Vec3> cloud;
    for (std::uint64_t i = 0; i < 40; ++i) {
      // Sums of four are nearly normal: thick in the middle, as no surface is.
      Vec3 p = Vec3::Zero();
      for (std::uint64_t k = 0; k < 4; ++k)
        for (int c = 0; c < 3; ++c) p[c] += random_unit(seed, 12 * i + 3 * k + static_cast<std::uint64_t>(c)) - 0.5;
      cloud.push_back(p);
    }
    const auto fit = fit_to_surface(cloud, body, std::nullopt);
    ASSERT_TRUE(fit.has_value());
    EXPECT_LT(fit->near, 0.85) << seed;
  }
  const std::vector<Vec3> line{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {5, 5, 0}};
  EXPECT_FALSE(fit_to_surface(line, body, std::nullopt).has_value());
  Shape dot;
  dot.positions = {Vec3(1, 2, 3)};
  EXPECT_FALSE(fit_to_surface(test::places_on(body, 20, 1), dot, std::nullopt).has_value());
}

TEST(SurfacePieces, TheNearestPlaceIsTheNearestOfAllTriangles) {
  const Shape body = test::lobed_body();
  const SurfacePieces pieces(body, 0.05);
  // A fine sampling of the surface knows no nearer place, and hardly a farther one.
  const std::vector<Vec3> sampled = test::places_on(body, 60'000, 8);
  for (const Vec3& p : test::places_on(body, 40, 2)) {
    const Vec3 away = 1.2 * p;
    const SurfacePieces::Place place = pieces.nearest(away);
    double least = HUGE_VAL;
    for (const Vec3& q : sampled) least = std::min(least, (q - away).norm());
    EXPECT_LE((place.at - away).norm(), least + 1e-12);
    EXPECT_NEAR((place.at - away).norm(), least, 0.02);
    EXPECT_LT((pieces.nearest(p).at - p).norm(), 1e-9);
    EXPECT_NEAR(place.normal.norm(), 1, 1e-12);
  }
}

TEST(SurfacePieces, LongTrianglesAreHalvedAndPlacesAreSpreadOverAll) {
  Shape square;
  square.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  square.faces.add(std::array<Index, 4>{0, 1, 2, 3});
  const SurfacePieces pieces(square, 0.1);
  const std::vector<Vec3> places = pieces.spread(64);
  ASSERT_EQ(places.size(), 64u);
  // Any point of the square has one of 64 places within two cells of an even 8 x 8.
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Vec3 p(random_unit(1, 2 * i), random_unit(1, 2 * i + 1), 0);
    double least = 1;
    for (const Vec3& q : places) least = std::min(least, (q - p).norm());
    EXPECT_LT(least, 0.25);
    EXPECT_LT((pieces.nearest(p + Vec3(0, 0, 0.3)).at - p).norm(), 1e-12);
  }
  EXPECT_EQ(SurfacePieces(square, 10).spread(64).size(), 2u) << "no more places than pieces";
}

}  // namespace
}  // namespace sinew
