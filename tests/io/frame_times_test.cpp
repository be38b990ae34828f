#include "engine/io/frame_times.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace sinew::io {

namespace {

FrameTimes of(const std::vector<int>& frames, double rate) {
  std::vector<float> times;
  for (const int frame : frames) times.push_back(static_cast<float>(frame / rate));
  return frames_of_times(times);
}

}  // namespace

TEST(FrameTimes, ConsecutiveFramesAtUsualRatesComeBack) {
  for (const double rate : {1.0, 12.0, 23.976023976023978, 24.0, 25.0, 29.97002997002997, 30.0, 60.0, 240.0})
    for (const int first : {0, 1, -7, 1001, 86400})
      for (const int count : {2, 3, 48, 500}) {
        std::vector<int> frames;
        for (int i = 0; i < count; ++i) frames.push_back(first + i);
        const FrameTimes found = of(frames, rate);
        // Two late frames are too near for their rate to be told to more than a few digits.
        if (first == 86400 && count < 48) continue;
        EXPECT_FALSE(found.numbered) << rate << ' ' << first << ' ' << count;
        EXPECT_EQ(found.frames, frames) << rate << ' ' << first << ' ' << count;
        EXPECT_NEAR(found.rate, rate, 1e-9 * rate) << first << ' ' << count;
      }
}

TEST(FrameTimes, FramesWithGapsComeBackWhereTwoAreNeighboursOrTheRateIsUsual) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    const int first = std::uniform_int_distribution(-50, 50)(random);
    std::set<int> set{first, first + 1};
    for (int i = 0; i < 10; ++i) set.insert(first + std::uniform_int_distribution(0, 90)(random));
    const std::vector<int> frames(set.begin(), set.end());
    EXPECT_EQ(of(frames, 30).frames, frames);
  }
  EXPECT_EQ(of({1, 3, 5}, 24).frames, (std::vector<int>{1, 3, 5}));
  EXPECT_EQ(of({7}, 24).frames, std::vector<int>{7});
}

TEST(FrameTimes, TimesWithoutAStepAreCounted) {
  for (const std::vector<float>& times :
       {std::vector<float>{0, 0.013F, 0.4F}, {0, 0, 0}, {2, 1, 0}, {0, 1e30F, 2e30F}, {NAN, 1, 2}, {0, INFINITY}}) {
    const FrameTimes found = frames_of_times(times);
    EXPECT_TRUE(found.numbered);
    EXPECT_EQ(found.frames.size(), times.size());
    EXPECT_EQ(found.frames.front(), 1);
    EXPECT_TRUE(std::isfinite(found.rate) && found.rate > 0);
  }
}

}  // namespace sinew::io
