#include "engine/gpu/camera.h"

#include <gtest/gtest.h>

namespace sinew::gpu {
namespace {

Bounds box() {
  Bounds bounds;
  bounds.add({10, -2, 5});
  bounds.add({14, 1, 6});
  return bounds;
}

TEST(Camera, FramesABoxFromEveryNamedView) {
  for (const UpAxis up : {UpAxis::Y, UpAxis::Z})
    for (const bool orthographic : {false, true})
      for (const char* name : {"front", "back", "left", "right", "top", "bottom", "iso"}) {
        SCOPED_TRACE(name);
        Camera camera;
        camera.orthographic = orthographic;
        ASSERT_TRUE(look_from(camera, name, up));
        frame_bounds(camera, box(), 1.5, 0.8);
        double reach = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const Bounds b = box();
          const Eigen::Vector3d p((corner & 1 ? b.max : b.min).x(), (corner & 2 ? b.max : b.min).y(),
                                  (corner & 4 ? b.max : b.min).z());
          Eigen::Vector3d at;
          ASSERT_TRUE(project(camera, {300, 200}, p, at));
          EXPECT_GT(at.z(), 0);
          EXPECT_LE(at.z(), 1);
          reach = std::max({reach, std::abs(at.x() / 150 - 1), std::abs(at.y() / 100 - 1)});
          EXPECT_LT((unproject(camera, {300, 200}, at.head<2>(), at.z()) - p).norm(), 1e-9);
        }
        EXPECT_NEAR(reach, 0.8, 1e-9);
      }
  Camera camera;
  EXPECT_FALSE(look_from(camera, "sideways", UpAxis::Y));
}

TEST(Camera, UpIsUpInThePicture) {
  for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
    Camera camera;
    look_from(camera, "front", up);
    Eigen::Vector3d low, high;
    ASSERT_TRUE(project(camera, {100, 100}, {0, 0, 0}, low));
    ASSERT_TRUE(project(camera, {100, 100}, 0.1 * up_vector(up), high));
    EXPECT_LT(high.y(), low.y());
    EXPECT_NEAR(high.x(), low.x(), 1e-9);
  }
}

TEST(Camera, ShiftMovesTheTarget) {
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.orthographic = orthographic;
    camera.shift = {-0.5, 0.25};
    Eigen::Vector3d at;
    ASSERT_TRUE(project(camera, {200, 100}, camera.target, at));
    EXPECT_NEAR(at.x(), 50, 1e-9);
    EXPECT_NEAR(at.y(), 37.5, 1e-9);
  }
}

TEST(Camera, NothingAndOnePointAreFramedToo) {
  Camera camera;
  frame_bounds(camera, Bounds{}, 1);
  EXPECT_TRUE(camera.eye.allFinite());
  EXPECT_GT(camera.distance(), 0.1);
  Bounds point;
  point.add({3, 4, 5});
  frame_bounds(camera, point, 1);
  EXPECT_EQ(camera.target, Eigen::Vector3d(3, 4, 5));
  EXPECT_GT(camera.near, 0);
}

TEST(Camera, PixelSizeIsWhatAPixelCovers) {
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.orthographic = orthographic;
    const Eigen::Vector3d p(0.1, 0.2, -0.3);
    Eigen::Vector3d here, there;
    ASSERT_TRUE(project(camera, {100, 100}, p, here));
    ASSERT_TRUE(project(camera, {100, 100}, p + Eigen::Vector3d(pixel_size(camera, 100, p), 0, 0), there));
    EXPECT_NEAR(there.x() - here.x(), 1, 1e-9);
  }
}

}  // namespace
}  // namespace sinew::gpu
