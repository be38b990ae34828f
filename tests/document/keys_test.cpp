#include "engine/document/keys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/document/selection.h"

namespace sinew::document {

namespace {

Key key(int frame, Interpolation interpolation = Interpolation::Linear) {
  Key out;
  out.frame = frame;
  out.interpolation = interpolation;
  return out;
}

Motion turned(double degrees, const Vec3& about, const Vec3& axis = Vec3::UnitZ()) {
  Motion out;
  out.rotate = Rotation{axis, degrees, about};
  return out;
}

Motion moved(const Vec3& move) {
  Motion out;
  out.move = move;
  return out;
}

const std::vector<Vec3> corner{Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0)};

}  // namespace

TEST(Keys, AFrameLiesBetweenTwoKeysBeforeTheFirstOrBehindTheLast) {
  const std::vector<Key> keys{key(10), key(20, Interpolation::Smooth), key(30, Interpolation::Hold), key(40)};
  const auto check = [&](double frame, std::size_t first, std::size_t second, double u) {
    const KeySpan span = span_of(keys, frame);
    EXPECT_EQ(span.first, first) << frame;
    EXPECT_EQ(span.second, second) << frame;
    EXPECT_NEAR(span.u, u, 1e-15) << frame;
  };
  check(1, 0, 0, 0);
  check(10, 0, 1, 0);
  check(12.5, 0, 1, 0.25);
  check(20, 1, 2, 0);
  check(22.5, 1, 2, 0.25 * 0.25 * 2.5);
  check(25, 1, 2, 0.5);
  check(39, 2, 2, 0);
  check(40, 3, 3, 0);
  check(99, 3, 3, 0);
}

TEST(Keys, AtAKeyTheTargetsAreThoseOfTheMotion) {
  Motion all = turned(70, Vec3(3, 1, 2), Vec3(1, 2, -1));
  all.matrix = Eigen::Matrix4d::Identity();
  all.matrix->topRows<3>() << 1.1, 0.2, 0, 4, 0, 0.9, 0.1, 5, 0.3, 0, 1, 6;
  all.move = Vec3(0.5, 0, -1);
  const Vec3 origin(100, -50, 7);
  const std::vector<Vec3> expected = targets_of(all, corner, origin);
  const std::vector<Vec3> got = targets_between(all, moved(Vec3(9, 9, 9)), 0, corner, corner, corner, origin);
  for (std::size_t i = 0; i < corner.size(); ++i) EXPECT_LT((got[i] - expected[i]).norm(), 1e-12);
  const std::vector<Vec3> last = targets_between(moved(Vec3(9, 9, 9)), all, 1, corner, corner, corner, origin);
  for (std::size_t i = 0; i < corner.size(); ++i) EXPECT_LT((last[i] - expected[i]).norm(), 1e-12);
}

TEST(Keys, ARotationAboutOnePointGoesAroundItBeyondHalfATurn) {
  const std::vector<Vec3> got =
      targets_between(turned(0, Vec3(0, 0, 0)), turned(300, Vec3(0, 0, 0)), 0.5, corner, corner, corner, Vec3::Zero());
  for (std::size_t i = 0; i < corner.size(); ++i) {
    EXPECT_NEAR(got[i].norm(), corner[i].norm(), 1e-12);  // an arc, not a chord
    const Vec3 expected(
        corner[i].x() * std::cos(150 * std::numbers::pi / 180) - corner[i].y() * std::sin(150 * std::numbers::pi / 180),
        corner[i].x() * std::sin(150 * std::numbers::pi / 180) + corner[i].y() * std::cos(150 * std::numbers::pi / 180),
        0);
    EXPECT_LT((got[i] - expected).norm(), 1e-12);
  }
}

TEST(Keys, RotationsAboutOtherAxesGoTheShortWayAndStayRigid) {
  const Motion first = turned(40, Vec3(1, 0, 0)), second = turned(60, Vec3(0, 5, 0), Vec3(1, 1, 0));
  for (const double u : {0.25, 0.5, 0.75}) {
    const std::vector<Vec3> got = targets_between(first, second, u, corner, corner, corner, Vec3::Zero());
    EXPECT_NEAR((got[1] - got[0]).norm(), 1, 1e-12);
    EXPECT_NEAR((got[2] - got[1]).norm(), 1, 1e-12);
    EXPECT_NEAR((got[1] - got[0]).dot(got[2] - got[1]), 0, 1e-12);
  }
}

TEST(Keys, AMotionGoesAlongWithItsPoints) {
  // The points are elsewhere at the frame asked for: what the key does to them there is the same, moved along.
  const Vec3 away(10, 20, 30);
  std::vector<Vec3> now;
  for (const Vec3& p : corner) now.push_back(p + away);
  const Motion bend = turned(90, Vec3(0, 0, 0));
  const std::vector<Vec3> there = targets_of(bend, corner, Vec3::Zero());
  const std::vector<Vec3> got = targets_between(bend, bend, 0, corner, corner, now, Vec3::Zero());
  for (std::size_t i = 0; i < now.size(); ++i) EXPECT_LT((got[i] - there[i] - away).norm(), 1e-12);

  Motion to;
  to.to = Shared<Vec3>({Vec3(1, 1, 1), Vec3(2, 0, 0), Vec3(2, 1, 0)});
  const std::vector<Vec3> half = targets_between(to, moved(Vec3(0, 0, 0)), 0.5, corner, corner, now, Vec3::Zero());
  EXPECT_LT((half[0] - now[0] - Vec3(0, 0.5, 0.5)).norm(), 1e-12);
  EXPECT_LT((half[1] - now[1]).norm(), 1e-12);
}

}  // namespace sinew::document
