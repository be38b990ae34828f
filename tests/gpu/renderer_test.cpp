#include "engine/gpu/renderer.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared.h"
#include "tests/gpu/gpu_test.h"

namespace sinew::gpu {
namespace {

/// A point, a sphere of points and a square of two triangles, drawn by the shaders and by the processor.
class RendererTest : public GpuTest {
 protected:
  RendererTest() {
    on_device_.draw_on_device = true;
    shader_ = create_renderer(test_device(), on_device_, offscreen_format);
    raster_ = create_renderer(test_device(), Paths{}, offscreen_format);
    std::vector<Eigen::Vector3d> points, normals;
    sphere(20'000, points, normals);
    ball_ = create_points(test_device(), false, points, normals);
    const std::vector<Eigen::Vector3d> corners{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    square_ = create_points(test_device(), false, corners, std::vector<Eigen::Vector3d>(4, {0, 0, 1}));
    faces_ = create_triangles(test_device(), std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
  }

  Picture shaders(const Scene& scene, VkExtent2D extent = {200, 160}) const { return draw(*shader_, scene, extent); }
  Picture raster(const Scene& scene, VkExtent2D extent = {200, 160}) const { return draw(*raster_, scene, extent); }

  static Picture draw(Renderer& renderer, const Scene& scene, VkExtent2D extent) {
    const Offscreen target = create_offscreen(test_device(), extent);
    return render_picture(test_device(), renderer, target, scene);
  }

  Paths on_device_;
  RendererHandle shader_, raster_;
  Points ball_, square_;
  Triangles faces_;
};

/// Part of the pixels that differ by more than `tolerance` in a channel.
double difference(const Picture& a, const Picture& b, int tolerance) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(a.rgba[i + c] - b.rgba[i + c]));
    differing += most > tolerance;
  }
  return static_cast<double>(differing) / (static_cast<double>(a.rgba.size()) / 4);
}

TEST_F(RendererTest, AnEmptySceneIsTheBackdrop) {
  for (const Picture& picture : {shaders(plain_scene()), raster(plain_scene())}) {
    EXPECT_NEAR(picture.at(10, 0)[0], 0x26, 1);
    EXPECT_NEAR(picture.at(10, 0)[2], 0x2f, 1);
    EXPECT_NEAR(picture.at(190, 159)[0], 0x19, 1);
    EXPECT_EQ(picture.at(190, 159)[3], 255);
  }
}

TEST_F(RendererTest, ASquareCoversWhatTheCameraSays) {
  Scene scene = plain_scene();
  scene.meshes.push_back({&square_, &faces_});
  Eigen::Vector3d corner, inside;
  ASSERT_TRUE(project(scene.camera, {200, 160}, {1, 1, 0}, corner));
  ASSERT_TRUE(project(scene.camera, {200, 160}, {0, 0, 0}, inside));
  EXPECT_NEAR(inside.x(), 100, 1e-9);
  const int x = static_cast<int>(corner.x()), y = static_cast<int>(corner.y());
  for (const Picture& picture : {shaders(scene), raster(scene)}) {
    EXPECT_GT(picture.at(x - 2, y + 2)[0], 100);
    EXPECT_LT(picture.at(x + 2, y + 2)[0], 60);
    EXPECT_LT(picture.at(x - 2, y - 2)[0], 60);
    EXPECT_GT(picture.at(100, 80)[0], 100);
  }
}

TEST_F(RendererTest, ShadersAndProcessorDrawTheSameCloud) {
  Scene scene = plain_scene();
  scene.smooth_edges = false;
  scene.clouds.push_back({&ball_, 3});
  for (const bool orthographic : {false, true}) {
    scene.camera.orthographic = orthographic;
    Bounds bounds;
    bounds.add({-1, -1, -1});
    bounds.add({1, 1, 1});
    fit_depth(scene.camera, bounds);
    const Picture a = shaders(scene), b = raster(scene);
    EXPECT_LT(difference(a, b, 24), 0.02);
    Scene empty = scene;
    empty.clouds.clear();
    EXPECT_GT(difference(a, shaders(empty), 24), 0.2);
  }
}

TEST_F(RendererTest, ShadersAndProcessorDrawTheSameMesh) {
  Scene scene = plain_scene();
  scene.smooth_edges = false;
  look_from(scene.camera, "iso", UpAxis::Y);
  scene.meshes.push_back({&square_, &faces_});
  EXPECT_LT(difference(shaders(scene), raster(scene), 6), 0.01);
  scene.meshes[0].flat = true;
  EXPECT_LT(difference(shaders(scene), raster(scene), 6), 0.01);
}

TEST_F(RendererTest, ShadersAndProcessorDrawTheSameGround) {
  Scene scene = plain_scene();
  scene.smooth_edges = false;
  scene.meshes.push_back({&square_, &faces_});
  for (const bool orthographic : {false, true})
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
      scene.up = up;
      scene.camera.orthographic = orthographic;
      scene.look.grid = Color::hex(0xffffff, 0.8);
      scene.ground = ground_below(ball_.rest_bounds, up);
      look_from(scene.camera, "iso", up);
      fit_depth(scene.camera, ball_.rest_bounds);
      const Picture a = shaders(scene), b = raster(scene);
      EXPECT_LT(difference(a, b, 16), 0.02);
      scene.ground.show = false;
      EXPECT_GT(difference(a, shaders(scene), 16), 0.05);
    }
  // Seen from within its plane there is nothing to draw.
  scene.ground.middle = scene.camera.eye = Eigen::Vector3d(0, 0, 0);
  scene.camera.target = {0, 0, -1};
  scene.camera.up = {0, 1, 0};
  scene.up = UpAxis::Y;
  scene.ground.show = true;
  scene.meshes.clear();
  raster(scene);
  shaders(scene);
}

TEST_F(RendererTest, AFaceThatReachesBehindTheEyeIsCutThere) {
  const std::vector<Eigen::Vector3d> corners{{-5, -1, 10}, {5, -1, 10}, {5, -1, -50}, {-5, -1, -50}};
  Points floor = create_points(test_device(), false, corners, std::vector<Eigen::Vector3d>(4, {0, 1, 0}));
  colors_of(floor)[0].r = 20;
  Scene scene = plain_scene();
  scene.smooth_edges = false;
  scene.camera.eye = {0, 0, 2};
  scene.camera.near = 0.01;
  scene.meshes.push_back({&floor, &faces_});
  const Picture a = shaders(scene), b = raster(scene);
  EXPECT_GT(a.at(100, 150)[1], 60);
  EXPECT_LT(difference(a, b, 8), 0.01);
}

TEST_F(RendererTest, MarksTintAndSelectionIsOutlined) {
  Scene scene = plain_scene();
  scene.meshes.push_back({&square_, &faces_});
  for (PointColor& color : colors_of(square_)) color.marks = shared::mark_fixed | shared::mark_selected;
  scene.outline_selected = true;
  Eigen::Vector3d corner;
  ASSERT_TRUE(project(scene.camera, {200, 160}, {1, 0, 0}, corner));
  for (const Picture& picture : {shaders(scene), raster(scene)}) {
    EXPECT_GT(picture.at(100, 80)[2], picture.at(100, 80)[0] + 30) << "blue";
    int outlined = 0;
    for (int x = static_cast<int>(corner.x()) - 2; x < static_cast<int>(corner.x()) + 3; ++x)
      outlined += picture.at(x, 80)[0] > 180 && picture.at(x, 80)[2] < 180;
    EXPECT_GE(outlined, 1);
  }
  for (PointColor& color : colors_of(square_)) color.marks = shared::mark_hidden;
  for (const Picture& picture : {shaders(scene), raster(scene)}) EXPECT_LT(picture.at(100, 80)[0], 60);
}

TEST_F(RendererTest, GhostsAreSeenThrough) {
  Scene scene = plain_scene();
  scene.meshes.push_back({&square_, &faces_, false, true, 0.5});
  for (const Picture& picture : {shaders(scene), raster(scene)}) {
    EXPECT_GT(picture.at(100, 80)[0], 0x22);
    EXPECT_LT(picture.at(100, 80)[0], 120);
  }
  scene.meshes.clear();
  scene.clouds.push_back({&ball_, 3, ball_.count, true, 0.3});
  for (const Picture& picture : {shaders(scene), raster(scene)}) EXPECT_GT(picture.at(100, 80)[0], 0x2a);
}

TEST_F(RendererTest, DotsAndLinesStandOverTheShapeOrBehindIt) {
  Scene scene = plain_scene();
  scene.meshes.push_back({&square_, &faces_});
  Dot dot = handle_dot({0, 0, 0.2}, Color::hex(0xff0000));
  dot.hidden = 0;
  scene.dots.push_back(dot);
  scene.lines.push_back({{-0.5, 0.5, 0.1}, {0.5, 0.5, 0.1}, Color::hex(0x00ff00), 3, 0});
  Eigen::Vector3d line;
  ASSERT_TRUE(project(scene.camera, {200, 160}, {0.25, 0.5, 0.1}, line));
  const int x = static_cast<int>(line.x()), y = static_cast<int>(line.y());
  for (const Picture& picture : {shaders(scene), raster(scene)}) {
    EXPECT_EQ(picture.at(100, 80)[0], 255);
    EXPECT_EQ(picture.at(100, 80)[1], 0);
    EXPECT_GT(picture.at(x, y)[1], 250);
  }
  scene.dots[0].position.z() = -0.2;
  scene.lines[0].from.z() = scene.lines[0].to.z() = -0.2;
  for (const Picture& picture : {shaders(scene), raster(scene)}) {
    EXPECT_GT(picture.at(100, 80)[1], 100) << "hidden";
    EXPECT_NEAR(picture.at(x, y)[0], picture.at(x, y)[1], 12) << "hidden";
  }
}

TEST_F(RendererTest, PointsThatAreNotFiniteAreNotDrawn) {
  const double nan = std::nan(""), infinity = INFINITY;
  const std::vector<Eigen::Vector3d> bad{{nan, 0, 0}, {0, nan, nan}, {infinity, 0, 0}, {0, 0, -infinity}, {0, 0, 0}};
  const Points points = create_points(test_device(), false, bad, {});
  const Triangles faces = create_triangles(test_device(), std::vector<std::uint32_t>{0, 1, 4, 2, 3, 4});
  Scene scene = plain_scene();
  scene.clouds.push_back({&points, 5});
  scene.meshes.push_back({&points, &faces});
  for (const Picture& picture : {shaders(scene), raster(scene)}) {
    EXPECT_GT(picture.at(100, 80)[0], 100);
    EXPECT_LT(picture.at(60, 60)[0], 60);
    EXPECT_LT(picture.at(100, 60)[0], 60);
  }
}

TEST_F(RendererTest, TheSizeCanChangeAtAnyTime) {
  Scene scene = plain_scene();
  scene.clouds.push_back({&ball_, 2});
  scene.ground = ground_below(ball_.rest_bounds, UpAxis::Y);
  scene.dots.push_back(handle_dot({0, 0, 1}, scene.look.handle));
  for (const VkExtent2D extent : {VkExtent2D{64, 48}, {333, 17}, {1, 1}, {17, 333}, {64, 48}})
    for (const bool smooth : {false, true}) {
      scene.smooth_edges = smooth;
      EXPECT_EQ(shaders(scene, extent).rgba.size(), std::size_t{4} * extent.width * extent.height);
      EXPECT_EQ(raster(scene, extent).rgba.size(), std::size_t{4} * extent.width * extent.height);
    }
}

TEST_F(RendererTest, AWidePictureOfTheLargestSideWorks) {
  Scene scene = plain_scene();
  scene.meshes.push_back({&square_, &faces_});
  const std::uint32_t most = std::min(16'384u, test_device().limits.maxImageDimension2D);
  for (const Picture& picture : {shaders(scene, {most, 16}), raster(scene, {most, 16})})
    EXPECT_GT(picture.at(static_cast<int>(most) / 2, 8)[0], 100);
}

}  // namespace
}  // namespace sinew::gpu
