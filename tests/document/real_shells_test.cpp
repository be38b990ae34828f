// Shells of real meshes, and real poses of a horse and a lion.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include "deformers/methods.h"
#include "deformers/shell.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/shared_data.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

std::vector<Vec3> bent(const Shape& rest, const Deformer& deformer) {
  return skin(rest, deformer.weights(), deformer.pose()).positions;
}

/// The lowest tenth along the longest axis held, the highest moved aside by a fifth of the length.
Constraints pulled_aside(const Shape& shape) {
  const Bounds bounds = bounds_of(shape.positions);
  Eigen::Index axis = 0;
  const double length = (bounds.max - bounds.min).maxCoeff(&axis);
  Constraints out;
  Handle handle;
  for (Index i = 0; i < shape.size(); ++i) {
    const Vec3& p = shape.positions[i];
    if (p[axis] < bounds.min[axis] + 0.1 * length) out.fixed.push_back(i);
    if (p[axis] <= bounds.max[axis] - 0.1 * length) continue;
    handle.points.push_back(i);
    handle.targets.push_back(p + 0.2 * length * Vec3::Unit((axis + 1) % 3));
  }
  out.handles.push_back(std::move(handle));
  return out;
}

TEST(RealShells, EveryMeshAndSoupBendsAndMeetsItsHandles) {
  SHARED_DATA(data, "meshes");
  int count = 0;
  for (const fs::path& folder : {data, data.parent_path() / "soups"})
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      if (!entry.is_regular_file() || entry.file_size() > 1500000) continue;
      if (extension != ".off" && extension != ".obj" && extension != ".ply") continue;
      const auto rest = io::read(entry.path().string());
      if (rest->faces.empty()) continue;
      SCOPED_TRACE(entry.path().filename().string());
      const auto deformer = make_shell_deformer(rest, {}, {});
      const Constraints constraints = pulled_aside(*rest);
      const SolveReport report = deformer->solve(constraints, {});
      EXPECT_NE(report.status, Status::Failed) << report.message;
      EXPECT_LT(report.handle_max, 1e-9);
      const std::vector<Vec3> x = bent(*rest, *deformer);
      for (std::size_t i = 0; i < x.size(); ++i) ASSERT_EQ(x[i].allFinite(), rest->positions[i].allFinite());
      for (const Index i : constraints.fixed) ASSERT_EQ(x[i], rest->positions[i]);
      EXPECT_LT(quality_of(*rest, x).edge_rms, 0.08);
      ++count;
    }
  EXPECT_GE(count, 10);
}

/// Twelve points far from each other along the mesh, each with the 20 vertices around it, as handles toward a pose.
Constraints twelve_patches(const Shape& rest, const Shape& pose) {
  std::vector<std::vector<Index>> neighbours(rest.size());
  for (const auto& [a, b] : edges_of(rest.faces)) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  std::vector<double> far(rest.size(), INFINITY);
  Constraints out;
  Index seed = 0;
  for (int patch = 0; patch < 12; ++patch) {
    far[seed] = 0;
    using Place = std::pair<double, Index>;
    std::priority_queue<Place, std::vector<Place>, std::greater<>> open;
    open.emplace(0, seed);
    while (!open.empty()) {
      const auto [distance, v] = open.top();
      open.pop();
      if (distance > far[v]) continue;
      for (const Index u : neighbours[v]) {
        const double next = distance + (rest.positions[u] - rest.positions[v]).norm();
        if (next >= far[u]) continue;
        far[u] = next;
        open.emplace(next, u);
      }
    }
    std::vector<Index> order(rest.size());
    for (Index i = 0; i < order.size(); ++i) order[i] = i;
    std::partial_sort(order.begin(), order.begin() + 20, order.end(), [&](Index a, Index b) {
      return (rest.positions[a] - rest.positions[seed]).norm() < (rest.positions[b] - rest.positions[seed]).norm();
    });
    Handle handle;
    for (std::size_t k = 0; k < 20; ++k) {
      handle.points.push_back(order[k]);
      handle.targets.push_back(pose.positions[order[k]] + pose.origin - rest.origin);
    }
    out.handles.push_back(std::move(handle));
    seed = static_cast<Index>(std::max_element(far.begin(), far.end()) - far.begin());
  }
  return out;
}

struct HeldOut {
  const char *folder, *rest, *pose;
  double rms;  ///< at most, in diagonals
};

class RealPoses : public testing::TestWithParam<HeldOut> {};

TEST_P(RealPoses, APoseThatIsNoExampleIsFoundFromTwelvePatches) {
  const HeldOut& row = GetParam();
  SHARED_DATA(data, std::string("poses/") + row.folder);
  const auto rest = io::read((data / row.rest).string()), wanted = io::read((data / row.pose).string());
  std::vector<std::shared_ptr<const Shape>> examples;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(data)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    if (file.filename() != row.rest && file.filename() != row.pose) examples.push_back(io::read(file.string()));
  ASSERT_EQ(examples.size(), 4U);
  const auto deformer = make_shell_deformer(rest, examples, {});
  const SolveReport report = deformer->solve(twelve_patches(*rest, *wanted), {});
  EXPECT_LT(report.handle_max, 1e-9);
  const std::vector<Vec3> x = bent(*rest, *deformer);
  double sum = 0;
  for (Index i = 0; i < x.size(); ++i)
    sum += (x[i] + rest->origin - wanted->positions[i] - wanted->origin).squaredNorm();
  const double rms = std::sqrt(sum / static_cast<double>(x.size())) / bounds_of(rest->positions).diagonal();
  std::printf("%s %s: rms %.5f of the diagonal, %d iterations, %.3f s\n", row.folder, row.pose, rms, report.iterations,
              report.solve_seconds);
  EXPECT_LE(rms, row.rms);
}

INSTANTIATE_TEST_SUITE_P(HorseAndLion, RealPoses,
                         testing::Values(HeldOut{"sumner_horse", "horse-poses.obj", "10.obj", 0.011},
                                         HeldOut{"sumner_horse", "horse-poses.obj", "5.obj", 0.015},
                                         HeldOut{"sumner_lion", "lion-poses.obj", "3.obj", 0.015}),
                         [](const auto& row) {
                           std::string name = std::string(row.param.folder) + row.param.pose;
                           std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
                           return name;
                         });

}  // namespace
}  // namespace sinew
