#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "apps/samples/edits.h"
#include "apps/samples/foal.h"
#include "apps/samples/poses.h"
#include "engine/document/edit.h"
#include "engine/document/selection.h"
#include "engine/geometry/topology.h"
#include "tests/apps/samples_figures.h"

namespace sinew::samples {

namespace {

std::map<std::string, Shape> poses_by_name() {
  std::map<std::string, Shape> out;
  for (NamedShape& pose : foal_poses()) out.emplace(pose.name, std::move(pose.shape));
  return out;
}

/// The foremost vertex at rest.
std::size_t muzzle_of(const Shape& rest) {
  return static_cast<std::size_t>(std::max_element(rest.positions.begin(), rest.positions.end(),
                                                   [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); }) -
                                  rest.positions.begin());
}

double lowest(const Shape& shape) {
  double y = INFINITY;
  for (const Vec3& p : shape.positions) y = std::min(y, p.y());
  return y;
}

/// The middles of a tube's rings of ten vertices, from the lower end on.
std::vector<Vec3> middles_of(const Shape& tube) {
  std::vector<Vec3> out;
  for (std::size_t first = 1; first + 10 < tube.size(); first += 10) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < 10; ++i) sum += tube.positions[first + i] / 10;
    out.push_back(sum);
  }
  return out;
}

}  // namespace

TEST(Poses, CorrespondToTheFoalAndDoNotTear) {
  const Shape rest = foal();
  const auto poses = poses_by_name();
  EXPECT_EQ(poses.size(), 10u);
  for (const auto& [name, pose] : poses) {
    SCOPED_TRACE(name);
    EXPECT_EQ(difference_of_faces(rest, pose), "");
    EXPECT_TRUE(all_finite(pose));
    const Quality quality = quality_of(rest, pose.positions);
    EXPECT_TRUE(quality.closed);
    EXPECT_LT(quality.edge_rms, 0.25);
    EXPECT_LT(std::abs(quality.volume_change), 0.08);
    EXPECT_NEAR(lowest(pose), 0, 0.03) << "stands on the ground";
  }
}

TEST(Poses, AreWhatTheirNamesSay) {
  const Shape rest = foal();
  const auto poses = poses_by_name();
  const std::size_t muzzle = muzzle_of(rest);
  const auto moved = [&](const char* name) { return Vec3(poses.at(name).positions[muzzle] - rest.positions[muzzle]); };
  EXPECT_LT(moved("head-down").y(), -0.6);
  EXPECT_GT(moved("head-up").y(), 0.4);
  EXPECT_LT(moved("turn-left").z(), -0.4);
  EXPECT_GT(moved("turn-right").z(), 0.4);
  EXPECT_GT(moved("rear").y(), 0.4);
  // The highest hoof of the hind legs, and where the rump is.
  const auto hind_hoof = [&](const char* name) {
    double y = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
      if (rest.positions[i].y() < 0.03 && rest.positions[i].x() < 0) y = std::max(y, poses.at(name).positions[i].y());
    return y;
  };
  const auto rump = [&](const char* name) {
    double y = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
      if (rest.positions[i].x() < -0.3 && rest.positions[i].y() > 0.9) y = std::max(y, poses.at(name).positions[i].y());
    return y;
  };
  EXPECT_GT(hind_hoof("kick"), 0.5);
  EXPECT_GT(hind_hoof("leg-lifted"), 0.15);
  EXPECT_LT(hind_hoof("stride-left"), 0.1);
  EXPECT_LT(rump("sit"), 0.85);
}

TEST(Poses, TheMuzzleOfTheFoalIsTakenHoldOf) {
  const auto rest = std::make_shared<const Shape>(foal());
  for (const auto& [name, text] : more_edits_of("foal")) {
    SCOPED_TRACE(name);
    const document::Project edit = document::parse_edit("foal." + name + ".edit.json", text);
    const document::Layer& layer = edit.layers.at(0);
    EXPECT_EQ(layer.method, "shell");
    EXPECT_FALSE(layer.examples.empty());
    if (name.starts_with("blend")) {
      EXPECT_TRUE(layer.handles.empty());
      continue;
    }
    document::Selector selector(rest);
    const Constraints constraints = selector.constraints(layer, rest->positions);
    ASSERT_EQ(constraints.handles.size(), 1u);
    EXPECT_EQ(constraints.handles[0].points.size(), 1u);
    EXPECT_EQ(constraints.handles[0].points[0], muzzle_of(*rest));
    std::array<int, 4> of_hoof{};
    for (const Index i : constraints.fixed) {
      const Vec3& p = rest->positions[i];
      ++of_hoof[(p.x() > 0 ? 2u : 0u) + (p.z() > 0 ? 1u : 0u)];
    }
    for (const int count : of_hoof) EXPECT_GT(count, 10);
  }
}

TEST(Poses, OneStandsTurnedAbout) {
  const Shape turned = foal_turned(), down = poses_by_name().at("head-down");
  EXPECT_EQ(difference_of_faces(down, turned), "");
  const Eigen::AngleAxisd turn(140 * std::numbers::pi / 180, Vec3::UnitY());
  for (std::size_t i = 0; i < down.size(); ++i)
    ASSERT_LT((turned.positions[i] - turn * down.positions[i]).norm(), 1e-6);
}

TEST(Helix, IsWoundFromATubeWithoutStretchingItsMiddle) {
  const Shape rest = tube(), wound = helix(3);
  EXPECT_EQ(rest.size(), 612u);
  EXPECT_EQ(difference_of_faces(rest, wound), "");
  for (const Shape* shape : {&rest, &wound}) {
    EXPECT_TRUE(quality_of(*shape, shape->positions).closed);
    EXPECT_NEAR(volume6(*shape) / 6, 10 * std::sin(0.2 * std::numbers::pi) * 0.035 * 0.035, 1e-4) << "of ten sides";
  }
  const std::vector<Vec3> straight = middles_of(rest), curve = middles_of(wound);
  double turned = 0, longest = 0, shortest = 1;
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    const double step = (straight[k + 1] - straight[k]).norm();
    longest = std::max(longest, step);
    shortest = std::min(shortest, step);
    EXPECT_NEAR((curve[k + 1] - curve[k]).norm(), step, 0.02 * step);
    const Vec3 a(curve[k].x() + 0.09, 0, curve[k].z()), b(curve[k + 1].x() + 0.09, 0, curve[k + 1].z());
    turned += std::atan2(a.cross(b).y(), a.dot(b));
  }
  EXPECT_NEAR(turned, 3 * 2 * std::numbers::pi, 1e-3);
  EXPECT_NEAR(longest, 3 * shortest, 1e-5);
}

TEST(Poses, AreTheSameOnEveryMachine) {
  const auto poses = poses_by_name();
  EXPECT_EQ(hash_of(poses.at("rear")), 7940947888616800457u);
  EXPECT_EQ(hash_of(poses.at("turn-left")), 16794564886788482853u);
  EXPECT_EQ(hash_of(helix(3)), 12045170003499566944u);
}

}  // namespace sinew::samples
