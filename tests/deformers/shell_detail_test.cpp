#include "deformers/shell_detail.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <limits>

#include "deformers/pose_decimate.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/deformers/triangle_shapes.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

using test::both;
using test::bumpy_torus;
using test::Mesh;
using test::sheet;

std::vector<Vec3> at(const std::vector<Vec3>& points, const std::vector<Index>& which) {
  std::vector<Vec3> out;
  for (const Index i : which) out.push_back(points[i]);
  return out;
}

std::vector<Index> every(std::size_t n, Index step) {
  std::vector<Index> out;
  for (Index i = 0; i < n; i += step) out.push_back(i);
  return out;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

std::vector<Vec3> moved(const std::vector<Vec3>& points, const Eigen::Affine3d& map) {
  std::vector<Vec3> out;
  for (const Vec3& p : points) out.push_back(map * p);
  return out;
}

Eigen::Affine3d some_turn() {
  return Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(2.5, Vec3(1, 2, -1).normalized());
}

/// Degenerate triangles of each kind in a sheet: two points at one place, three on a line, and one of no size.
Mesh spoilt_sheet() {
  Mesh mesh = sheet(16);
  mesh.positions[100] = mesh.positions[101];
  mesh.positions[60] = (mesh.positions[59] + mesh.positions[61]) / 2;
  mesh.positions[75] = mesh.positions[76] = mesh.positions[92];
  return mesh;
}

}  // namespace

TEST(Cotangent, LaplacianIsWhatItIs) {
  for (const Mesh& mesh : {bumpy_torus(12, 8), sheet(8), spoilt_sheet()}) {
    const CotangentLaplacian L = cotangent_laplacian(mesh.positions, mesh.triangles);
    const auto n = static_cast<Eigen::Index>(L.size());
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
    for (Index i = 0; i < L.size(); ++i)
      for (Index e = L.offsets[i]; e < L.offsets[i + 1]; ++e) {
        dense(i, L.to[e]) -= L.w[e];
        dense(i, i) += L.w[e];
      }
    const double size = dense.cwiseAbs().maxCoeff();
    EXPECT_LT((dense - dense.transpose()).cwiseAbs().maxCoeff(), 1e-14 * size);
    EXPECT_LT((dense * Eigen::VectorXd::Ones(n)).cwiseAbs().maxCoeff(), 1e-12 * size);
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
    EXPECT_GT(values[0], -1e-12 * size);
    EXPECT_GT(values[1], 1e-3);  // constants alone
    EXPECT_GT(*std::min_element(L.M.begin(), L.M.end()), 0);
  }
}

TEST(Cotangent, LinearFunctionsAreHarmonicWithinAPlane) {
  const Mesh mesh = sheet(12);
  const CotangentLaplacian L = cotangent_laplacian(mesh.positions, mesh.triangles);
  const std::vector<Vec3> Lx = multiply(L, mesh.positions);
  double boundary = 0;
  for (Index i = 0; i < 144; ++i) {
    const bool inside = i / 12 > 0 && i / 12 < 11 && i % 12 > 0 && i % 12 < 11;
    if (inside)
      EXPECT_LT(Lx[i].norm(), 1e-13) << i;
    else
      boundary = std::max(boundary, Lx[i].norm());
  }
  EXPECT_GT(boundary, 0.01);
}

// x'Lx is the integral of |grad x|^2: of x itself over a square of side 1 it is 1; and M sums to the area.
TEST(Cotangent, EnergyAndArea) {
  const Mesh mesh = sheet(12);
  const CotangentLaplacian L = cotangent_laplacian(mesh.positions, mesh.triangles);
  const std::vector<Vec3> Lx = multiply(L, mesh.positions);
  double energy = 0, area = 0;
  for (std::size_t i = 0; i < Lx.size(); ++i) {
    energy += Lx[i].x() * mesh.positions[i].x();
    area += L.M[i];
  }
  EXPECT_NEAR(energy, 1, 1e-12);
  EXPECT_NEAR(area, 1, 1e-12);
}

TEST(Cotangent, DivergenceOfTheGradientIsTheLaplacian) {
  for (const Mesh& mesh : {bumpy_torus(20, 12), spoilt_sheet()}) {
    const CotangentLaplacian L = cotangent_laplacian(mesh.positions, mesh.triangles);
    const std::vector<Vec3> Lx = multiply(L, mesh.positions);
    std::vector<Mat3> S(L.triangles.size(), Mat3::Identity());
    EXPECT_LT(farthest(divergence(L, S, mesh.positions), Lx), 1e-12);
    const Mat3 A{{1, 2, 0}, {-1, 3, 1}, {0.5, 0, 2}};
    for (Mat3& s : S) s = A;
    std::vector<Vec3> ALx;
    for (const Vec3& v : Lx) ALx.push_back(A * v);
    EXPECT_LT(farthest(divergence(L, S, mesh.positions), ALx), 1e-12);
  }
}

TEST(ShellDetail, AnchorsAtRestGiveTheRest) {
  for (const Mesh& mesh : {bumpy_torus(60, 30), sheet(40, 0.2), spoilt_sheet(), both(bumpy_torus(30, 20), sheet(20))}) {
    const std::vector<Index> anchors = every(mesh.positions.size(), 17);
    const ShellDetail detail(mesh.positions, mesh.triangles, anchors, {});
    ASSERT_TRUE(detail.ready());
    EXPECT_LT(farthest(detail.reconstruct(at(mesh.positions, anchors)), mesh.positions), 1e-9);
  }
}

TEST(ShellDetail, TurnsMovesAndScalesWithTheAnchors) {
  for (const Mesh& mesh : {bumpy_torus(60, 30), sheet(40, 0.2), spoilt_sheet()}) {
    const std::vector<Index> anchors = every(mesh.positions.size(), 17);
    const std::vector<Index> held{3, 5};
    const ShellDetail detail(mesh.positions, mesh.triangles, anchors, held);
    const std::vector<Vec3> bent =
        at(moved(mesh.positions, Eigen::Affine3d(Eigen::AngleAxisd(0.3, Vec3::UnitX()))), anchors);
    std::vector<Vec3> twisted;
    for (const Vec3& p : at(mesh.positions, anchors))
      twisted.push_back(Eigen::AngleAxisd(2 * p.x(), Vec3::UnitX()) * p);
    const Eigen::Affine3d turn = some_turn(), larger = turn * Eigen::Scaling(1000.0);
    for (const auto& targets : {bent, twisted}) {
      const std::vector<Vec3> x = detail.reconstruct(targets);
      EXPECT_LT(farthest(detail.reconstruct(moved(targets, turn)), moved(x, turn)), 1e-9);
      EXPECT_LT(farthest(detail.reconstruct(moved(targets, larger)), moved(x, larger)), 1e-6);
    }
    // The same in another unit.
    const Eigen::Affine3d unit(Eigen::Scaling(1000.0));
    const ShellDetail large(moved(mesh.positions, unit), mesh.triangles, anchors, held);
    EXPECT_LT(farthest(large.reconstruct(moved(twisted, unit)), moved(detail.reconstruct(twisted), unit)), 1e-6);
  }
}

TEST(ShellDetail, BaseMeetsTheAnchorsAndIsSmooth) {
  const Mesh mesh = bumpy_torus(80, 40);
  const std::vector<Index> anchors = every(mesh.positions.size(), 37);
  const ShellDetail detail(mesh.positions, mesh.triangles, anchors, {});
  const std::vector<Vec3> targets = at(bumpy_torus(80, 40, 0.4).positions, anchors);
  EXPECT_LT(farthest(at(detail.base(targets), anchors), targets), 1e-12);
  EXPECT_LT(detail.plate().residual(), 1e-10);
  EXPECT_LT(detail.transfer().residual(), 1e-10);
  // No other surface through the anchors has less thin-plate energy |M^-1/2 L x|^2: not its neighbours.
  const CotangentLaplacian L = cotangent_laplacian(mesh.positions, mesh.triangles);
  const auto energy = [&](const std::vector<Vec3>& x) {
    const std::vector<Vec3> Lx = multiply(L, x);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += Lx[i].squaredNorm() / L.M[i];
    return sum;
  };
  std::vector<Vec3> x = detail.base(targets);
  const double least = energy(x);
  for (Index i = 1; i < x.size(); i += 501) {
    ASSERT_NE(i % 37, 0u);
    for (const double step : {1e-3, -1e-3}) {
      x[i].z() += step;
      EXPECT_GT(energy(x), least);
      x[i].z() -= step;
    }
  }
}

TEST(ShellDetail, HeldAnchorsAreMetToTheBit) {
  const Mesh mesh = bumpy_torus(60, 30);
  const std::vector<Index> anchors = every(mesh.positions.size(), 13);
  std::vector<Index> held{2, 30, 99};
  const ShellDetail detail(mesh.positions, mesh.triangles, anchors, held);
  std::vector<Vec3> targets = at(bumpy_torus(60, 30, 0.6).positions, anchors);
  const std::vector<Vec3> x = detail.reconstruct(targets);
  for (const Index k : held) EXPECT_EQ(x[anchors[k]], targets[k]);
  // The others nearly: within 1 % of the diagonal.
  EXPECT_LT(farthest(at(x, anchors), targets), 0.03);
}

TEST(ShellDetail, SameBitsWithAnyThreads) {
  const Mesh mesh = bumpy_torus(100, 60);
  const std::vector<Index> anchors = every(mesh.positions.size(), 31);
  const std::vector<Vec3> targets = at(bumpy_torus(100, 60, 0.3).positions, anchors);
  const int threads = thread_count();
  std::vector<std::vector<Vec3>> results;
  for (const int count : {1, 3, 8}) {
    set_thread_count(count);
    results.push_back(ShellDetail(mesh.positions, mesh.triangles, anchors, {}).reconstruct(targets));
  }
  set_thread_count(threads);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

// A part without anchors, one with one, one with three on a line: they go rigidly with what is near.
TEST(ShellDetail, PartsWithoutEnoughAnchorsMoveRigidly) {
  const Mesh body = bumpy_torus(40, 20);
  const auto n = static_cast<Index>(body.positions.size());
  const Mesh mesh = both(both(both(body, sheet(5, 0, 0.4)), sheet(5, 0, 0.6)), sheet(5, 0, 0.8));
  std::vector<Index> anchors = every(n, 11);
  anchors.push_back(n + 25 + 12);
  for (const Index i : {0, 1, 2}) anchors.push_back(n + 50 + static_cast<Index>(i));
  const ShellDetail detail(mesh.positions, mesh.triangles, anchors, {});
  const std::vector<Vec3> rest = at(mesh.positions, anchors);
  EXPECT_LT(farthest(detail.reconstruct(rest), mesh.positions), 1e-9);
  EXPECT_LT(farthest(detail.reconstruct(moved(rest, some_turn())), moved(mesh.positions, some_turn())), 1e-9);
  std::vector<Vec3> bent;
  for (const Vec3& p : rest) bent.push_back(Eigen::AngleAxisd(p.x(), Vec3::UnitX()) * p);
  const std::vector<Vec3> x = detail.reconstruct(bent);
  for (const auto& [first, last] : {std::pair(n, n + 25), std::pair(n + 25, n + 50), std::pair(n + 50, n + 75)})
    for (Index i = first + 1; i < last; ++i)
      EXPECT_NEAR((x[i] - x[first]).norm(), (mesh.positions[i] - mesh.positions[first]).norm(), 1e-12);
  EXPECT_LT((x[n + 37] - bent[bent.size() - 4]).norm(), 1e-12);
}

TEST(ShellDetail, HostileMeshes) {
  // Nothing, no anchors, points alone, points that are not finite.
  EXPECT_TRUE(ShellDetail({}, {}, {}, {}).reconstruct({}).empty());
  Mesh mesh = spoilt_sheet();
  EXPECT_EQ(ShellDetail(mesh.positions, mesh.triangles, {}, {}).reconstruct({}), mesh.positions);
  mesh.positions.insert(mesh.positions.end(), {{4, 4, 4}, {5, 5, 5}, {std::nan(""), 0, 0}});
  const auto alone = static_cast<Index>(mesh.positions.size() - 3);
  mesh.triangles.push_back({0, 1, alone + 2});
  mesh.triangles.push_back({3, 3, 4});
  mesh.triangles.push_back(mesh.triangles[7]);  // an edge of three triangles
  mesh.triangles.push_back({18, 19, 130});
  std::vector<Index> anchors = every(256, 19);
  anchors.push_back(alone + 1);
  const ShellDetail detail(mesh.positions, mesh.triangles, anchors, {});
  std::vector<Vec3> targets = moved(at(mesh.positions, anchors), some_turn());
  std::vector<Vec3> x = detail.reconstruct(targets);
  ASSERT_EQ(x.size(), mesh.positions.size());
  EXPECT_EQ(x[alone], Vec3(4, 4, 4));
  EXPECT_EQ(x[alone + 1], targets.back());
  for (Index i = 0; i < alone; ++i) EXPECT_LT((x[i] - some_turn() * mesh.positions[i]).norm(), 1e-9) << i;
  targets[3].x() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(detail.reconstruct(targets).empty());

  // All at one point; on one line; a part that is far smaller than the rest; anchors that meet.
  for (const Vec3& scale : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1e-9, 1e-9, 1e-9)}) {
    Mesh flat = bumpy_torus(20, 10);
    for (Vec3& p : flat.positions) p = p.cwiseProduct(scale);
    const Mesh two = both(flat, bumpy_torus(20, 10));
    const std::vector<Index> some = every(two.positions.size(), 7);
    const ShellDetail of_two(two.positions, two.triangles, some, {});
    EXPECT_LT(farthest(of_two.reconstruct(at(two.positions, some)), two.positions), 1e-9) << scale.transpose();
    const std::vector<Vec3> point(some.size(), Vec3(1, 2, 3));
    for (const Vec3& p : of_two.reconstruct(point)) EXPECT_TRUE(p.allFinite());
  }
}

TEST(ShellDetail, StopsWhenTold) {
  const Mesh mesh = bumpy_torus(40, 20);
  const std::vector<Index> anchors = every(800, 11);
  double last = 0;
  EXPECT_TRUE(ShellDetail(mesh.positions, mesh.triangles, anchors, {}, [&](double done) {
                EXPECT_GE(done, last);
                last = done;
                return true;
              }).ready());
  EXPECT_EQ(last, 1);
  for (const double end : {0.0, 0.5, 0.99})
    EXPECT_FALSE(
        ShellDetail(mesh.positions, mesh.triangles, anchors, {}, [&](double done) { return done <= end; }).ready());
}

// The coarse vertices of a pose bring back the pose.
TEST(ShellDetail, PosesComeBackFromTheirCoarseVertices) {
  for (const auto& [name, files] :
       {std::pair<std::string, std::vector<int>>{"horse", {1, 3, 5, 8, 10}}, {"lion", {1, 3, 5, 7, 9}}}) {
    SHARED_DATA(folder, "poses/sumner_" + name);
    std::vector<std::vector<Vec3>> poses;
    std::vector<std::array<Index, 3>> triangles;
    for (const int file : files) {
      const auto shape = io::read((folder / (std::to_string(file) + ".obj")).string());
      const std::vector<Index> corners = triangles_of(shape->faces);
      triangles.clear();
      for (std::size_t k = 0; k < corners.size(); k += 3)
        triangles.push_back({corners[k], corners[k + 1], corners[k + 2]});
      poses.push_back(shape->positions);
    }
    const PoseDecimated coarse = decimated_together(poses, triangles, 1000);
    const ShellDetail detail(poses[0], triangles, coarse.vertices, {});
    Eigen::AlignedBox3d box;
    for (const Vec3& p : poses[0]) box.extend(p);
    for (const auto& pose : poses) {
      const std::vector<Vec3> x = detail.reconstruct(at(pose, coarse.vertices));
      ASSERT_EQ(x.size(), pose.size());
      double sum = 0;
      for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - pose[i]).squaredNorm();
      const double rms = std::sqrt(sum / static_cast<double>(x.size())) / box.diagonal().norm();
      EXPECT_LT(rms, &pose == &poses[0] ? 1e-10 : 0.0022) << name;
    }
  }
}

}  // namespace sinew
