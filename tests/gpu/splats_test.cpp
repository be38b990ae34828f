#include "engine/gpu/splats.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "engine/geometry/random.h"
#include "tests/gpu/gpu_test.h"

namespace sinew::gpu {
namespace {

constexpr VkExtent2D size{200, 160};

Attribute numbers(const std::string& name, Kind kind, int components, std::size_t count) {
  Attribute a;
  a.name = name;
  a.kind = kind;
  a.components = components;
  a.values.resize(count * a.row_size());
  return a;
}

/// n splats at the origin: standard deviations of 0.1, opacity 1/2, mid-grey, harmonics of this degree.
Shape splat_shape(std::size_t n, int degree = 3) {
  Shape shape;
  shape.positions.assign(n, Vec3::Zero());
  shape.attributes.push_back(numbers("rot", Kind::Quaternion, 4, n));
  shape.attributes.push_back(numbers("scale", Kind::LogScale, 3, n));
  shape.attributes.push_back(numbers("opacity", Kind::Scalar, 1, n));
  shape.attributes.push_back(numbers("f_dc", Kind::SphericalHarmonics, 3, n));
  if (degree > 0)
    shape.attributes.push_back(numbers("f_rest", Kind::SphericalHarmonics, 3 * ((degree + 1) * (degree + 1) - 1), n));
  for (std::size_t i = 0; i < n; ++i) {
    shape.find("rot")->set_number(i, 0, 1);
    for (int c = 0; c < 3; ++c) shape.find("scale")->set_number(i, c, std::log(0.1));
  }
  return shape;
}

void paint(Shape& shape, std::size_t i, const Vec3& color, double opacity) {
  for (int c = 0; c < 3; ++c) shape.find("f_dc")->set_number(i, c, (color[c] - 0.5) / 0.28209479177387814);
  shape.find("opacity")->set_number(i, 0, std::log(opacity / (1 - opacity)));
}

/// A cloud of different ellipsoids whose colours depend on the direction.
Shape many(std::size_t n) {
  Shape shape = splat_shape(n);
  std::uint64_t drawn = 0;
  const auto uniform = [&](double low, double high) { return low + (high - low) * random_unit(7, drawn++); };
  for (std::size_t i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) shape.positions[i][c] = uniform(-1, 1);
    for (int c = 0; c < 4; ++c) shape.find("rot")->set_number(i, c, uniform(-1, 1));
    for (int c = 0; c < 3; ++c) shape.find("scale")->set_number(i, c, uniform(-5, -1.8));
    paint(shape, i, Vec3(uniform(0, 1), uniform(0, 1), uniform(0, 1)), uniform(0.05, 0.99));
    for (int c = 0; c < 45; ++c) shape.find("f_rest")->set_number(i, c, uniform(-0.2, 0.2));
  }
  return shape;
}

class SplatsTest : public GpuTest {
 protected:
  SplatsTest() {
    Paths on_device;
    on_device.draw_on_device = true;
    shader_ = create_renderer(test_device(), on_device, offscreen_format);
    raster_ = create_renderer(test_device(), Paths{}, offscreen_format);
    const std::vector<Eigen::Vector3d> corners{{-1, -1, 0}, {1, -1, 0}, {1, 0.2, 0}, {-1, 0.2, 0}};
    wall_ = create_points(test_device(), false, corners, std::vector<Eigen::Vector3d>(4, {0, 0, 1}));
    faces_ = create_triangles(test_device(), std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
  }

  /// By the shaders, then by the processor.
  std::vector<Picture> both(const Scene& scene, VkExtent2D extent = size) const {
    std::vector<Picture> out;
    for (Renderer* renderer : {shader_.get(), raster_.get()})
      out.push_back(render_picture(test_device(), *renderer, create_offscreen(test_device(), extent), scene));
    return out;
  }

  static Scene scene_of(const Splats& splats) {
    Scene scene = plain_scene();
    scene.splats.push_back({&splats});
    return scene;
  }

  RendererHandle shader_, raster_;
  Points wall_;
  Triangles faces_;
};

struct Difference {
  double mean = 0;
  int most = 0;
};

Difference difference(const Picture& a, const Picture& b) {
  Difference out;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const int d = std::abs(a.rgba[i] - b.rgba[i]);
    out.mean += static_cast<double>(d) / static_cast<double>(a.rgba.size());
    out.most = std::max(out.most, d);
  }
  return out;
}

TEST_F(SplatsTest, ShadersAndProcessorDrawTheSame) {
  const Splats splats = create_splats(many(3000));
  Scene scene = scene_of(splats);
  scene.smooth_edges = false;
  scene.meshes.push_back({&wall_, &faces_});
  for (const bool orthographic : {false, true}) {
    scene.camera.orthographic = orthographic;
    fit_depth(scene.camera, bulk_bounds(splats));
    const std::vector<Picture> pictures = both(scene);
    // The target has eight bits, into which the device rounds after every splat.
    const Difference d = difference(pictures[0], pictures[1]);
    EXPECT_LT(d.mean, 0.7);
    EXPECT_LE(d.most, 12);
    Scene without = scene;
    without.splats.clear();
    EXPECT_GT(difference(both(without)[0], pictures[0]).mean, 20);
  }
}

/// A splat's shape on the screen, by differences of the camera's own projection, and its colour by the definition.
TEST_F(SplatsTest, ASplatIsTheProjectedGaussian) {
  Shape shape = splat_shape(1, 0);
  shape.positions[0] = {0.2, -0.1, 0.3};
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.7, 0.3, -0.4, 0.2).normalized();
  const double values[] = {2 * q.w(), 2 * q.x(), 2 * q.y(), 2 * q.z()};  // of any length
  for (int c = 0; c < 4; ++c) shape.find("rot")->set_number(0, c, values[c]);
  const Vec3 deviations(0.3, 0.1, 0.02);
  for (int c = 0; c < 3; ++c) shape.find("scale")->set_number(0, c, std::log(deviations[c]));
  paint(shape, 0, {0.9, 0.6, 0.2}, 0.8);
  const Splats splats = create_splats(shape);
  for (const bool orthographic : {false, true}) {
    Scene scene = scene_of(splats);
    scene.camera.orthographic = orthographic;
    scene.camera.shift = {0.2, -0.1};
    look_from(scene.camera, "iso", UpAxis::Y);
    Bounds bounds;
    bounds.add({-1, -1, -1});
    bounds.add({1, 1, 1});
    fit_depth(scene.camera, bounds);
    Eigen::Vector3d at, up, down;
    ASSERT_TRUE(project(scene.camera, {200, 160}, shape.positions[0], at));
    Eigen::Matrix<double, 2, 3> J;
    for (int c = 0; c < 3; ++c) {
      const Vec3 step = 1e-5 * Vec3::Unit(c);
      ASSERT_TRUE(project(scene.camera, {200, 160}, shape.positions[0] + step, up));
      ASSERT_TRUE(project(scene.camera, {200, 160}, shape.positions[0] - step, down));
      J.col(c) = (up - down).head<2>() / 2e-5;
    }
    const Mat3 M = q.toRotationMatrix() * deviations.asDiagonal();
    const Eigen::Matrix2d inverse =
        (J * M * M.transpose() * J.transpose() + 0.3 * Eigen::Matrix2d::Identity()).inverse();
    Scene empty = scene;
    empty.splats.clear();
    const Picture backdrop = both(empty)[0];
    for (const Picture& picture : both(scene)) {
      int inside = 0;
      for (int y = 0; y < 160; ++y)
        for (int x = 0; x < 200; ++x) {
          const Eigen::Vector2d d = Eigen::Vector2d(x + 0.5, y + 0.5) - at.head<2>();
          const double squared = d.dot(inverse * d), alpha = squared > 9 ? 0 : 0.8 * std::exp(-0.5 * squared);
          if (std::abs(squared - 9) < 0.05) continue;
          inside += alpha > 0.1;
          const double color[] = {0.9, 0.6, 0.2};
          for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(picture.at(x, y)[c], backdrop.at(x, y)[c] * (1 - alpha) + 255 * color[c] * alpha, 1.6)
                << x << " " << y;
        }
      EXPECT_GT(inside, 200);
    }
  }
}

TEST_F(SplatsTest, TheNearerStandsOverTheFartherWhateverTheirOrder) {
  for (const bool first_is_near : {false, true}) {
    Shape shape = splat_shape(2, 0);
    shape.positions[first_is_near ? 0 : 1].z() = 0.5;
    paint(shape, 0, {1, 0, 0}, 0.99);
    paint(shape, 1, {0, 1, 0}, 0.99);
    const Splats splats = create_splats(shape);
    for (const Picture& picture : both(scene_of(splats))) {
      EXPECT_EQ(picture.at(100, 80)[0] > 240, first_is_near);
      EXPECT_EQ(picture.at(100, 80)[1] > 240, !first_is_near);
    }
  }
}

TEST_F(SplatsTest, WhatIsSolidHidesWhatIsBehindItAndLeavesWhatIsBeforeIt) {
  Shape shape = splat_shape(2, 0);
  shape.positions = {{-0.5, 0, -0.5}, {0.5, 0, 0.5}};
  paint(shape, 0, {1, 0, 0}, 0.99);
  paint(shape, 1, {1, 0, 0}, 0.99);
  const Splats splats = create_splats(shape);
  Scene scene = scene_of(splats);
  scene.meshes.push_back({&wall_, &faces_});
  Eigen::Vector3d behind, before;
  ASSERT_TRUE(project(scene.camera, {200, 160}, shape.positions[0], behind));
  ASSERT_TRUE(project(scene.camera, {200, 160}, shape.positions[1], before));
  for (const Picture& picture : both(scene)) {
    const std::uint8_t* hidden = picture.at(static_cast<int>(behind.x()), static_cast<int>(behind.y()));
    EXPECT_NEAR(hidden[0], hidden[1], 3);
    EXPECT_LT(picture.at(static_cast<int>(before.x()), static_cast<int>(before.y()))[1], 10);
  }
}

TEST_F(SplatsTest, WhatIsNotFiniteOrBehindTheEyeIsLeftOut) {
  const double nan = std::nan("");
  Shape shape = splat_shape(8, 1);
  for (std::size_t i = 0; i < 8; ++i) paint(shape, i, {1, 1, 1}, 0.9);
  shape.positions[0].x() = nan;
  shape.positions[1].z() = INFINITY;
  shape.positions[2].z() = 50;  // behind the eye
  shape.find("rot")->set_number(3, 2, nan);
  shape.find("scale")->set_number(4, 0, 200);  // no such covariance
  shape.find("opacity")->set_number(5, 0, nan);
  shape.find("opacity")->set_number(6, 0, -100);
  shape.find("f_dc")->set_number(7, 0, nan);
  const Splats splats = create_splats(shape);
  EXPECT_TRUE(splat_instances(scene_of(splats), size).empty());
  const std::vector<Picture> pictures = both(scene_of(splats));
  const std::vector<Picture> empty = both(plain_scene());
  for (std::size_t k : {0u, 1u}) EXPECT_EQ(pictures[k].rgba, empty[k].rgba);
  const Splats none = create_splats(splat_shape(0));
  both(scene_of(none), {1, 1});
  EXPECT_TRUE(bulk_bounds(none).empty());
}

TEST_F(SplatsTest, ASplatAtTheEyeCoversThePictureAndNothingBreaks) {
  Shape shape = splat_shape(1, 0);
  paint(shape, 0, {1, 0, 0}, 0.5);
  const Splats splats = create_splats(shape);
  Scene scene = scene_of(splats);
  scene.camera.near = 1e-4;
  scene.camera.eye = {0.05, 0, 0.001};
  scene.camera.target = {0.05, 0, -1};
  for (const Picture& picture : both(scene)) EXPECT_GT(picture.at(100, 80)[0], 80);
}

TEST(Splats, HarmonicsAreOrthonormal) {
  constexpr int coefficients = 16, rings = 64;
  // One splat a coefficient, whose red is that harmonic and a constant that keeps it above 0.
  Shape shape = splat_shape(coefficients);
  for (int k = 0; k < coefficients; ++k) {
    paint(shape, static_cast<std::size_t>(k), {3, 0, 0}, 0.5);
    if (k > 0) shape.find("f_rest")->set_number(static_cast<std::size_t>(k), k - 1, 1);
  }
  const Splats splats = create_splats(shape);
  Eigen::Matrix<double, coefficients, coefficients> products;
  products.setZero();
  for (int ring = 0; ring < rings; ++ring)
    for (int step = 0; step < 2 * rings; ++step) {
      // Equal steps of z and angle are equal areas.
      const double z = (ring + 0.5) * 2 / rings - 1, angle = step * std::numbers::pi / rings, r = std::sqrt(1 - z * z);
      const Eigen::Vector3f d = Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
      Eigen::Vector<double, coefficients> Y;
      Y[0] = 0.28209479177387814;
      for (int k = 1; k < coefficients; ++k) Y[k] = splat_color(splats, static_cast<std::size_t>(k), d).x() - 3.0;
      products += Y * Y.transpose() * (4 * std::numbers::pi / (2 * rings * rings));
    }
  EXPECT_LT((products - decltype(products)::Identity()).cwiseAbs().maxCoeff(), 4e-3);
  // Signs and order are a convention of the files: of degree 1, -y, z, -x.
  EXPECT_LT(splat_color(splats, 1, {0, 1, 0}).x(), 3 - 0.48f);
  EXPECT_GT(splat_color(splats, 2, {0, 0, 1}).x(), 3 + 0.48f);
  EXPECT_LT(splat_color(splats, 3, {1, 0, 0}).x(), 3 - 0.48f);
}

TEST(Splats, ChannelsOfTheRestFollowEachOther) {
  for (const int degree : {1, 2, 3}) {
    Shape shape = splat_shape(1, degree);
    const int each = (degree + 1) * (degree + 1) - 1;
    shape.find("f_rest")->set_number(0, each + 1, 0.5);  // green's z
    const Splats splats = create_splats(shape);
    EXPECT_EQ(splats.degree, degree);
    const Eigen::Vector3f color = splat_color(splats, 0, {0, 0, 1});
    EXPECT_NEAR(color.y(), 0.5 + 0.5 * 0.4886025, 1e-6);
    EXPECT_NEAR(color.x(), 0.5, 1e-6);
    EXPECT_NEAR(color.z(), 0.5, 1e-6);
  }
}

TEST(Splats, OfAnOddNumberOfHarmonicsTheFirstIsTaken) {
  Shape shape = splat_shape(1, 0);
  shape.attributes.push_back(numbers("f_rest", Kind::SphericalHarmonics, 10, 1));
  EXPECT_EQ(create_splats(shape).degree, 0);
}

TEST(Splats, AreHeldByShapesWithRotationScaleAndOpacity) {
  const Shape all = splat_shape(1, 0);
  EXPECT_TRUE(holds_splats(all));
  for (const char* name : {"rot", "scale", "opacity"}) {
    Shape shape = all;
    std::erase_if(shape.attributes, [&](const Attribute& a) { return a.name == name; });
    EXPECT_FALSE(holds_splats(shape)) << name;
  }
}

TEST(Splats, ATintMixesWithWhatIsSeenFromEverySide) {
  Shape shape = splat_shape(1);
  paint(shape, 0, {0.2, 0.4, 0.6}, 0.5);
  for (int c = 0; c < 45; ++c) shape.find("f_rest")->set_number(0, c, 0.02 * (c % 7));
  const Splats before = create_splats(shape);
  Splats half = before, whole = before;
  tint(half, 0, {1, 0, 0}, 0.5f);
  tint(whole, 0, {1, 0, 0}, 1);
  for (const Eigen::Vector3f& d : {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(0, -0.6f, 0.8f)}) {
    const Eigen::Vector3f mixed = 0.5f * (splat_color(before, 0, d) + Eigen::Vector3f(1, 0, 0));
    EXPECT_LT((splat_color(half, 0, d) - mixed).norm(), 1e-6);
    EXPECT_LT((splat_color(whole, 0, d) - Eigen::Vector3f(1, 0, 0)).norm(), 1e-6);
  }
}

TEST(Splats, BulkBoundsLeaveOutliersAside) {
  Shape shape = many(1000);
  for (std::size_t i = 0; i < 10; ++i) shape.positions[i] = Vec3(1e4, -1e5, 1e6);
  shape.positions[10].x() = std::nan("");
  const Bounds bounds = bulk_bounds(create_splats(shape));
  EXPECT_LT((bounds.max - Vec3(1, 1, 1)).cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT((bounds.min + Vec3(1, 1, 1)).cwiseAbs().maxCoeff(), 0.1);
}

}  // namespace
}  // namespace sinew::gpu
