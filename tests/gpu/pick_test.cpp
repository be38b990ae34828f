#include "engine/gpu/pick.h"

#include "shaders/shared.h"
#include "tests/gpu/gpu_test.h"

namespace sinew::gpu {
namespace {

constexpr VkExtent2D size{200, 160};

class PickTest : public GpuTest {
 protected:
  PickTest() {
    Paths paths;
    raster_ = create_picker(test_device(), paths);
    paths.draw_on_device = true;
    shader_ = create_picker(test_device(), paths);
    std::vector<Eigen::Vector3d> points, normals;
    sphere(5000, points, normals);
    ball_ = create_points(test_device(), false, points, normals);
    const std::vector<Eigen::Vector3d> corners{{-1, -1, -0.5}, {1, -1, -0.5}, {1, 1, -0.5}, {-1, 1, -0.5}};
    square_ = create_points(test_device(), false, corners, {});
    faces_ = create_triangles(test_device(), std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
    scene_ = plain_scene();
    scene_.clouds.push_back({&ball_, 3});
    scene_.meshes.push_back({&square_, &faces_});
  }

  std::vector<PickResult> both(VkRect2D rectangle) {
    return {pick(test_device(), *shader_, scene_, size, rectangle),
            pick(test_device(), *raster_, scene_, size, rectangle)};
  }

  PickerHandle shader_, raster_;
  Points ball_, square_;
  Triangles faces_;
  Scene scene_;
};

TEST_F(PickTest, TheFrontMostPointIsFoundWhereItProjects) {
  const std::vector<PickRange> ranges = pick_ranges(scene_);
  ASSERT_EQ(ranges.size(), 2u);
  for (const PickResult& result : both({{0, 0}, size})) {
    const std::vector<Eigen::Vector3d> points = read_positions(test_device(), ball_);
    for (const std::size_t i : {0u, 10u, 333u, 1200u}) {
      Eigen::Vector3d at;
      ASSERT_TRUE(project(scene_.camera, {size.width, size.height}, points[i], at));
      const std::size_t pixel = result.index(static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()));
      PickRange range;
      std::uint32_t element = 0;
      ASSERT_TRUE(pick_element(ranges, result.ids[pixel], range, element));
      EXPECT_FALSE(range.mesh);
      const Eigen::Vector3d found =
          unproject(scene_.camera, {size.width, size.height}, {at.x(), at.y()}, result.depths[pixel]);
      EXPECT_LT((points[element] - points[i]).norm(), 0.1);
      EXPECT_LT((found - points[element]).norm(), 0.1);
    }
  }
}

TEST_F(PickTest, FacesAreFoundBesideTheBallAndNothingOutside) {
  Eigen::Vector3d at;
  ASSERT_TRUE(project(scene_.camera, {size.width, size.height}, {0.95, -0.9, -0.5}, at));
  for (const PickResult& result : both({{0, 0}, size})) {
    PickRange range;
    std::uint32_t element = 7;
    const std::size_t pixel = result.index(static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()));
    ASSERT_TRUE(pick_element(pick_ranges(scene_), result.ids[pixel], range, element));
    EXPECT_TRUE(range.mesh);
    EXPECT_EQ(element, 0u);
    EXPECT_EQ(result.ids[0], 0u);
    EXPECT_EQ(result.depths[0], 0.0f);
    EXPECT_FALSE(pick_element(pick_ranges(scene_), 0, range, element));
    EXPECT_FALSE(pick_element(pick_ranges(scene_), 5003, range, element));
  }
}

TEST_F(PickTest, ShadersAndProcessorFindTheSame) {
  const std::vector<PickResult> results = both({{20, 10}, {150, 140}});
  ASSERT_EQ(results[0].ids.size(), results[1].ids.size());
  std::size_t differing = 0, seen = 0;
  for (std::size_t i = 0; i < results[0].ids.size(); ++i) {
    differing += results[0].ids[i] != results[1].ids[i];
    seen += results[0].ids[i] != 0;
  }
  EXPECT_GT(seen, results[0].ids.size() / 3);
  EXPECT_LT(differing, results[0].ids.size() / 50);
}

TEST_F(PickTest, ARectangleIsCutToThePicture) {
  for (const PickResult& result : both({{-10, 150}, {30, 30}})) {
    EXPECT_EQ(result.rectangle.offset.x, 0);
    EXPECT_EQ(result.rectangle.extent.width, 20u);
    EXPECT_EQ(result.rectangle.extent.height, 10u);
  }
  for (const PickResult& result : both({{500, 500}, {30, 30}})) EXPECT_TRUE(result.ids.empty());
}

TEST_F(PickTest, HiddenPointsAndGhostsAreNotFound) {
  for (PointColor& color : colors_of(ball_)) color.marks = shared::mark_hidden;
  scene_.meshes[0].ghost = 0.5;
  for (const PickResult& result : both({{90, 70}, {20, 20}}))
    for (const std::uint32_t id : result.ids) EXPECT_EQ(id, 0u);
}

}  // namespace
}  // namespace sinew::gpu
