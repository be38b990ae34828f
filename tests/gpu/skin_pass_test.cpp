#include "engine/gpu/skin_pass.h"

#include <Eigen/Geometry>
#include <random>

#include "engine/geometry/skin.h"
#include "tests/gpu/gpu_test.h"

namespace sinew::gpu {
namespace {

struct SkinCase {
  std::vector<Eigen::Vector3d> points, normals;
  SkinWeights weights;
  Pose pose;
};

/// Rows of 0 to 9 influences (some points have none), maps that turn, stretch and move, far from the origin.
SkinCase make_case(std::size_t count, const Eigen::Vector3d& centre) {
  std::mt19937 random(static_cast<std::uint32_t>(count));
  std::uniform_real_distribution<double> unit(-1, 1);
  SkinCase out;
  sphere(count, out.points, out.normals);
  for (Eigen::Vector3d& p : out.points) p += centre;
  for (int j = 0; j < 37; ++j) {
    Affine map;
    const Eigen::Vector3d axis(unit(random), unit(random), unit(random));
    map.leftCols<3>() =
        Eigen::AngleAxisd(unit(random), axis.normalized()).toRotationMatrix() * (1 + 0.2 * unit(random));
    map.col(3) = centre - map.leftCols<3>() * centre + 0.3 * axis;
    out.pose.push_back(map);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = random() % 10;
    for (std::size_t k = 0; k < row; ++k) {
      out.weights.maps.push_back(static_cast<std::uint32_t>(random() % out.pose.size()));
      out.weights.weights.push_back(1.0f / static_cast<float>(row));
    }
    out.weights.offsets.push_back(out.weights.maps.size());
  }
  return out;
}

void expect_like_geometry(const SkinCase& in, bool on_device) {
  Points points = create_points(test_device(), on_device, in.points, in.normals);
  set_weights(test_device(), points, in.weights);
  Frame frame = create_frame(test_device());
  begin_frame(test_device(), frame);
  pose_points(test_device(), frame, points, in.pose);
  submit(test_device(), frame, VK_NULL_HANDLE, VK_NULL_HANDLE);
  finish(test_device(), frame);

  std::vector<Eigen::Vector3d> expected(in.points.size());
  skin_points(in.weights, in.pose, in.points, expected);
  std::vector<Mat3> M(in.points.size());
  blend_matrices(in.weights, in.pose, 0, M);
  const std::vector<Eigen::Vector3d> found = read_positions(test_device(), points);
  const std::vector<Eigen::Vector3d> normals = read_normals(test_device(), points);
  const double diagonal = std::max(1.0, bounds_of(in.points).diagonal());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_LT((found[i] - expected[i]).norm(), 1e-6 * diagonal) << i;
    ASSERT_LT((normals[i] - skin_normal(M[i], in.normals[i])).norm(), 1e-5) << i;
  }
}

using SkinPassTest = GpuTest;

TEST_F(SkinPassTest, TheShaderAndTheProcessorAgreeWithGeometry) {
  for (const std::size_t count : {1u, 2u, 63u, 64u, 65u, 1000u, 5000u})
    for (const bool on_device : {false, true}) {
      SCOPED_TRACE(count);
      SCOPED_TRACE(on_device);
      expect_like_geometry(make_case(count, {0, 0, 0}), on_device);
    }
}

TEST_F(SkinPassTest, FarFromTheOriginNothingIsLost) {
  const SkinCase far = make_case(500, {300, -200, 100});
  expect_like_geometry(far, true);
  expect_like_geometry(far, false);
}

TEST_F(SkinPassTest, NoPointsAndNoWeightsAreFine) {
  Points none = create_points(test_device(), true, {}, {});
  SkinWeights weights;
  set_weights(test_device(), none, weights);
  Frame frame = create_frame(test_device());
  begin_frame(test_device(), frame);
  pose_points(test_device(), frame, none, {identity_map()});
  EXPECT_TRUE(read_positions(test_device(), none).empty());

  const std::vector<Eigen::Vector3d> one{{1, 2, 3}};
  Points unbound = create_points(test_device(), true, one, {});
  pose_points(test_device(), frame, unbound, {identity_map()});
  EXPECT_EQ(read_positions(test_device(), unbound), one);
}

TEST_F(SkinPassTest, GivenPositionsAndAnotherRestShapeReplaceTheOld) {
  std::vector<Eigen::Vector3d> points, normals;
  sphere(300, points, normals);
  for (const bool on_device : {false, true}) {
    Points shape = create_points(test_device(), on_device, points, normals);
    std::vector<Eigen::Vector3d> moved = points;
    for (Eigen::Vector3d& p : moved) p *= 2;
    set_positions(test_device(), shape, moved, normals);
    EXPECT_LT((read_positions(test_device(), shape)[7] - moved[7]).norm(), 1e-6);
    for (Eigen::Vector3d& p : moved) p.x() += 50;
    set_rest(test_device(), shape, moved, normals);
    EXPECT_LT((read_positions(test_device(), shape)[7] - moved[7]).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace sinew::gpu
