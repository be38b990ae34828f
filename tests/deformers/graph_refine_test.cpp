// The adaptive graph: nodes are added where the energy is, the shape stays, and fewer nodes reach a fine graph's
// quality.

#include "deformers/graph_refine.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "deformers/graph.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/skin.h"
#include "engine/io/io.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

struct Edit {
  std::shared_ptr<const Shape> shape;
  Constraints constraints;
};

/// A bumpy plane of 101 x 101 points: one side held, one corner of the other lifted.
Edit corner_lifted() {
  auto shape = std::make_shared<Shape>();
  Edit out;
  out.constraints.handles.emplace_back();
  for (Index z = 0; z <= 100; ++z)
    for (Index x = 0; x <= 100; ++x) {
      const Vec3 p(x / 100.0, 0.01 * std::sin(0.75 * x) * std::sin(0.75 * z), z / 100.0);
      if (x < 10) out.constraints.fixed.push_back(z * 101 + x);
      if (x > 90 && z > 90) {
        out.constraints.handles[0].points.push_back(z * 101 + x);
        out.constraints.handles[0].targets.push_back(p + Vec3(-0.1, 0.25, -0.1));
      }
      shape->positions.push_back(p);
    }
  out.shape = shape;
  return out;
}

GraphOptions options_of(int nodes, int adapt, bool surface = false) {
  GraphOptions options;
  options.nodes = nodes;
  options.adapt = adapt;
  options.surface = surface;
  return options;
}

std::unique_ptr<Deformer> solved(const Edit& edit, const GraphOptions& options) {
  std::unique_ptr<Deformer> deformer = make_graph_deformer(edit.shape, options);
  deformer->solve(edit.constraints, {});
  while (std::unique_ptr<Deformer> finer = deformer->refined()) {
    deformer = std::move(finer);
    deformer->solve(edit.constraints, {});
  }
  return deformer;
}

std::vector<Vec3> bent(const Edit& edit, const Deformer& deformer) {
  return skin(*edit.shape, deformer.weights(), deformer.pose()).positions;
}

/// Relative change of the distances between each point and its 4 nearest, rms.
double edge_rms(const Edit& edit, const Deformer& deformer) {
  const std::vector<Vec3>& rest = edit.shape->positions;
  const std::vector<Vec3> now = bent(edit, deformer);
  std::vector<Index> near(rest.size() * 5);
  std::vector<double> distance(near.size());
  NearestTree(rest).nearest(rest, 5, near, distance);
  double sum = 0, count = 0;
  for (std::size_t e = 0; e < near.size(); ++e)
    if (distance[e] > 0) {
      sum += std::pow((now[e / 5] - now[near[e]]).norm() / distance[e] - 1, 2);
      ++count;
    }
  return std::sqrt(sum / count);
}

}  // namespace

TEST(GraphRefine, MarksTheFewestThatHoldThreeTenths) {
  EXPECT_EQ(marked_nodes(std::vector<double>{1, 3, 2, 3, 1}), (std::vector<Index>{1}));
  EXPECT_EQ(marked_nodes(std::vector<double>{2, 2, 2, 2, 2}), (std::vector<Index>{0, 1}));
  EXPECT_TRUE(marked_nodes(std::vector<double>(5, 0)).empty());
}

TEST(GraphRefine, TheShapeStaysWhereItIs) {
  const Edit edit = corner_lifted();
  for (const bool surface : {false, true}) {
    const auto coarse = make_graph_deformer(edit.shape, options_of(150, 300, surface));
    coarse->solve(edit.constraints, {});
    const auto finer = coarse->refined();
    ASSERT_NE(finer, nullptr);
    EXPECT_GT(finer->pose().size(), 150u);
    for (std::size_t j = 0; j < 150; ++j) EXPECT_LT((finer->pose()[j] - coarse->pose()[j]).norm(), 1e-12);
    const std::vector<Vec3> before = bent(edit, *coarse), after = bent(edit, *finer);
    double sum = 0, most = 0, moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      sum += (after[i] - before[i]).squaredNorm();
      most = std::max(most, (after[i] - before[i]).norm());
      moved = std::max(moved, (before[i] - edit.shape->positions[i]).norm());
    }
    EXPECT_LT(std::sqrt(sum / static_cast<double>(before.size())), 2e-3);
    EXPECT_LT(most, 0.02);
    EXPECT_GT(moved, 0.25);  // what it would be if x were lost
  }
}

TEST(GraphRefine, GrowsToTheCapAndNotWithoutOne) {
  const Edit edit = corner_lifted();
  EXPECT_EQ(solved(edit, options_of(100, 0))->pose().size(), 100u);
  EXPECT_EQ(solved(edit, options_of(100, 90))->pose().size(), 100u);
  EXPECT_TRUE(solved(edit, options_of(100, 0))->notes().empty());
  const auto grown = solved(edit, options_of(100, 163));
  EXPECT_EQ(grown->pose().size(), 163u);
  ASSERT_EQ(grown->notes().size(), 1u);
  EXPECT_EQ(grown->notes()[0].substr(0, 35), "63 nodes were added to the 100 chos");
  Edit rest = edit;
  rest.constraints.handles.clear();
  EXPECT_EQ(solved(rest, options_of(100, 163))->pose().size(), 100u);
}

TEST(GraphRefine, ThreadsDoNotChangeABit) {
  const Edit edit = corner_lifted();
  const int threads = thread_count();
  set_thread_count(1);
  const std::vector<Vec3> one = bent(edit, *solved(edit, options_of(100, 200)));
  set_thread_count(3);
  const std::vector<Vec3> three = bent(edit, *solved(edit, options_of(100, 200)));
  set_thread_count(threads);
  EXPECT_TRUE(one == three);
}

TEST(GraphRefine, ReachesAFineGraphsQualityWithHalfTheNodes) {
  const Edit edit = corner_lifted();
  const double fine = edge_rms(edit, *solved(edit, options_of(600, 0)));
  const double adapted = edge_rms(edit, *solved(edit, options_of(75, 300)));
  const double even = edge_rms(edit, *solved(edit, options_of(300, 0)));
  std::printf("edge rms: 600 even %.4f, 300 even %.4f, 75 grown to 300 %.4f\n", fine, even, adapted);
  EXPECT_LT(adapted, 1.05 * fine);
  EXPECT_GT(even, 1.05 * fine);  // as many nodes, elsewhere
}

TEST(GraphRefine, BendsABunnysHeadWithHalfTheNodes) {
  SHARED_DATA(path, "scans/stanford_bunny/bun000.ply");
  Edit edit{io::read(path.string()), {}};
  edit.constraints.handles.emplace_back();
  const Bounds box = bounds_of(edit.shape->positions);
  const Vec3 size = box.max - box.min, about = box.min + size.cwiseProduct(Vec3(0.3, 0.62, 0.5));
  for (Index i = 0; i < edit.shape->size(); ++i) {
    const Vec3& p = edit.shape->positions[i];
    const double height = (p.y() - box.min.y()) / size.y();
    if (height < 0.35) edit.constraints.fixed.push_back(i);
    if (height <= 0.9) continue;
    edit.constraints.handles[0].points.push_back(i);
    edit.constraints.handles[0].targets.push_back(Eigen::AngleAxisd(0.6, Vec3::UnitZ()) * (p - about) + about);
  }
  const double fine = edge_rms(edit, *solved(edit, options_of(600, 0)));
  const double adapted = edge_rms(edit, *solved(edit, options_of(75, 300)));
  std::printf("edge rms: 600 even %.4f, 75 grown to 300 at most %.4f\n", fine, adapted);
  EXPECT_LT(adapted, 1.05 * fine);
}

}  // namespace sinew
