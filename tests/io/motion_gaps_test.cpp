/// Gaps of trajectories: which are bridged, and by what.

#include "tests/io/motion_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

/// Of one marker, at each frame what `place` gives for its time; frames of `hidden` were not seen.
template <class F>
Trajectories moving(int frames, F&& place, const std::vector<std::array<int, 2>>& hidden, int first_frame = 1) {
  Trajectories motion;
  motion.names = {"m"};
  motion.first_frame = first_frame;
  for (int f = 0; f < frames; ++f) motion.frames.push_back({place(static_cast<double>(f))});
  for (const auto& [first, last] : hidden)
    for (int f = first; f <= last; ++f) motion.frames[static_cast<std::size_t>(f)][0] = not_seen;
  return motion;
}

Vec3 thrown(double t) {
  return {3 * t - 40, 5 + 2 * t - 0.25 * t * t, -t * t};
}

Vec3 circling(double t) {
  return {100 * std::cos(t / 20), 100 * std::sin(t / 20), t};
}

}  // namespace

TEST(MotionGaps, AThrowIsRestoredExactly) {
  Trajectories motion = moving(40, thrown, {{3, 12}, {20, 20}, {30, 36}});
  const GapReport report = bridge_gaps(motion, 10);
  EXPECT_EQ(report.bridged, 18u);
  EXPECT_EQ(report.released, 0u);
  for (int f = 0; f < 40; ++f) EXPECT_LT((motion.frames[static_cast<std::size_t>(f)][0] - thrown(f)).norm(), 1e-9) << f;
}

/// The remainder of a cubic Hermite polynomial is h^4/384 of the fourth derivative, and 4h/27 of a velocity's error at
/// each end, here at most 1/3 of the third derivative each: both by the circle's radius and speed.
TEST(MotionGaps, ACircleIsRestoredWithinTheFormulasError) {
  Trajectories motion = moving(60, circling, {{25, 33}});
  bridge_gaps(motion, 9);
  const double h = 10, radius = 100, w = 1.0 / 20;
  const double bound = radius * (std::pow(h * w, 4) / 384 + 2 * 4 * h / 27 * std::pow(w, 3) / 3);
  double worst = 0;
  for (int f = 25; f <= 33; ++f)
    worst = std::max(worst, (motion.frames[static_cast<std::size_t>(f)][0] - circling(f)).norm());
  EXPECT_LT(worst, bound);
  EXPECT_GT(worst, 0.001 * bound);
}

TEST(MotionGaps, LongGapsAndThoseAtTheEndsAreReleased) {
  Trajectories motion = moving(30, thrown, {{0, 1}, {5, 7}, {12, 15}, {29, 29}}, 101);
  const Trajectories before = motion;
  EXPECT_EQ(gaps_of(motion).sentences(),
            std::vector<std::string>{"m: 10 frames released (101-102, 106-108, 113-116, 130)."});
  const GapReport report = bridge_gaps(motion, 3);
  EXPECT_EQ(report.sentences(), std::vector<std::string>{"m: 3 frames bridged (106-108), 7 frames released (101-102, "
                                                         "113-116, 130)."});
  EXPECT_EQ(report.markers[0].bridged, 3u);
  EXPECT_EQ(report.released, 7u);
  ASSERT_EQ(report.markers[0].gaps.size(), 4u);
  EXPECT_EQ(report.markers[0].gaps[1].first, 106);
  EXPECT_TRUE(report.markers[0].gaps[1].bridged);
  for (std::size_t f = 0; f < 30; ++f) {
    const bool filled = f >= 5 && f <= 7;
    EXPECT_EQ(seen(motion.frames[f][0]), filled || seen(before.frames[f][0])) << f;
    if (seen(before.frames[f][0])) {
      EXPECT_EQ(motion.frames[f][0], before.frames[f][0]) << f;
    }
  }
  // Nothing is left to bridge, and nothing changes.
  EXPECT_EQ(bridge_gaps(motion, 3).bridged, 0u);
  for (const int longest : {0, -1}) {
    Trajectories same = before;
    EXPECT_EQ(bridge_gaps(same, longest).bridged, 0u);
  }
}

/// One frame is seen between two gaps: its velocity is not known, and a place that was filled in gives none.
TEST(MotionGaps, VelocitiesComeFromFramesThatWereSeen) {
  const auto straight = [](double t) { return Vec3(t < 10 ? t : 20 - t, 0, 0); };
  Trajectories motion = moving(21, straight, {{8, 9}, {11, 12}});
  bridge_gaps(motion, 5);
  // From 7 with velocity 1 to the peak of 10 with that of the chord, 1: a line; and down the same way.
  for (const int f : {8, 9, 11, 12})
    EXPECT_NEAR(motion.frames[static_cast<std::size_t>(f)][0].x(), straight(f).x(), 1e-12) << f;
  // With one neighbour seen, its difference is the velocity: p(1/2) = (p_a + p_b) / 2 + h (v_a - v_b) / 8.
  motion = moving(5, [](double t) { return Vec3(0, t * t, 0); }, {{2, 2}});
  motion.frames[4][0] = not_seen;
  bridge_gaps(motion, 1);
  EXPECT_DOUBLE_EQ(motion.frames[2][0].y(), (1.0 + 9.0) / 2 + 2.0 * (1.0 - (9.0 - 1.0) / 2) / 8);
}

TEST(MotionGaps, ManyGapsAreNotAllNamed) {
  std::vector<std::array<int, 2>> hidden;
  for (int i = 1; i < 30; i += 2) hidden.push_back({i, i});
  EXPECT_EQ(gaps_of(moving(31, thrown, hidden, 0)).sentences(),
            std::vector<std::string>{"m: 15 frames released (1, 3, 5, 7, 9, 11, 13, 15 and 7 more)."});
  EXPECT_TRUE(gaps_of(moving(31, thrown, {})).sentences().empty());
}

/// Gaps are cut into a real recording where its markers were seen throughout; what fills them stays near the truth.
TEST(MotionGaps, ARealGaitIsBridgedToWithinMillimetres) {
  SHARED_DATA(path, "mocap/trc/Anto.trc");
  const Trajectories truth = read_motion(path.string());
  Trajectories cut = truth;
  std::size_t hidden = 0;
  for (std::size_t p = 0; p < cut.names.size(); ++p)
    for (std::size_t f = 20 + p % 7; f + 30 < cut.frames.size(); f += 30)
      for (std::size_t i = 0; i < 5; ++i) {
        hidden += seen(cut.frames[f + i][p]) ? 1 : 0;
        cut.frames[f + i][p] = not_seen;
      }
  bridge_gaps(cut, 5);
  double squares = 0;
  std::size_t filled = 0;
  for (std::size_t p = 0; p < cut.names.size(); ++p)
    for (std::size_t f = 20; f < cut.frames.size(); ++f)
      if (seen(truth.frames[f][p]) && seen(cut.frames[f][p]) && cut.frames[f][p] != truth.frames[f][p]) {
        squares += (cut.frames[f][p] - truth.frames[f][p]).squaredNorm();
        ++filled;
      }
  const double root_mean_square = std::sqrt(squares / static_cast<double>(filled));
  RecordProperty("millimetres", std::to_string(root_mean_square));
  EXPECT_GT(filled, hidden / 2);
  EXPECT_LT(root_mean_square, 3) << filled;
}

}  // namespace sinew::io
