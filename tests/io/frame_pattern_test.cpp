#include "engine/io/frame_pattern.h"

#include <numeric>
#include <random>
#include <set>

#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"

namespace sinew::io {

namespace {

std::vector<int> frames(std::string_view text) {
  return parse_frames("--frames", text);
}

std::vector<int> sorted(std::vector<int> values) {
  std::sort(values.begin(), values.end());
  return values;
}

std::string refused(std::string_view text) {
  return sentence_of([&] { frames(text); });
}

void touch(const std::string& path) {
  std::ofstream(path) << "x";
}

}  // namespace

TEST(FramePattern, RangesAreThoseOfFileseq) {
  EXPECT_EQ(frames("7"), (std::vector<int>{7}));
  EXPECT_EQ(frames("1-5"), (std::vector<int>{1, 2, 3, 4, 5}));
  EXPECT_EQ(frames("1-10x3"), (std::vector<int>{1, 4, 7, 10}));
  EXPECT_EQ(frames("1-10y3"), (std::vector<int>{2, 3, 5, 6, 8, 9}));
  EXPECT_EQ(frames("1-10:5"), (std::vector<int>{1, 6, 5, 9, 4, 7, 10, 3, 2, 8}));
  EXPECT_EQ(frames("10-7"), (std::vector<int>{10, 9, 8, 7}));
  EXPECT_EQ(frames("10-1x4"), (std::vector<int>{10, 6, 2}));
  EXPECT_EQ(frames("-5-1x2"), (std::vector<int>{-5, -3, -1, 1}));
  EXPECT_EQ(frames("-3--5"), (std::vector<int>{-3, -4, -5}));
  EXPECT_EQ(frames("1, 20, 30-40x5, 3-1"), (std::vector<int>{1, 20, 30, 35, 40, 3, 2}));
  EXPECT_EQ(frames("1-999999999x999999998"), (std::vector<int>{1, 999999999}));
}

TEST(FramePattern, ARangeIsCutByXAndYIntoTwoPartsAndByColonIntoAnotherOrder) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    const auto number = [&](int from, int to) { return std::uniform_int_distribution(from, to)(random); };
    const int a = number(-60, 60), b = number(-60, 60), n = number(2, 70);
    const std::string range = std::to_string(a) + "-" + std::to_string(b), step = std::to_string(n);
    std::vector<int> all(static_cast<std::size_t>(std::abs(a - b)) + 1);
    std::iota(all.begin(), all.end(), std::min(a, b));
    EXPECT_EQ(sorted(frames(range)), all) << range;
    EXPECT_EQ(sorted(frames(range + ":" + step)), all) << range << ":" << step;
    std::vector<int> parts = frames(range + "x" + step);
    EXPECT_EQ(parts.front(), a);
    for (const int f : parts) EXPECT_EQ((f - a) % n, 0);
    if (a != b) {
      const std::vector<int> others = frames(range + "y" + step);
      parts.insert(parts.end(), others.begin(), others.end());
    }
    EXPECT_EQ(sorted(parts), all) << range << " by " << step;
  }
}

TEST(FramePattern, TheTextOfFramesIsReadBack) {
  EXPECT_EQ(frames_text(std::vector{1, 2, 3, 7, 10, 12, 14, 20, 22}), "1-3,7,10-14x2,20,22");
  EXPECT_EQ(frames_text(std::vector{-2, -1}), "-2--1");
  std::mt19937 random(2);
  for (int round = 0; round < 300; ++round) {
    std::set<int> set;
    for (int i = 0; i < round / 4 + 1; ++i) set.insert(std::uniform_int_distribution(-40, 40)(random));
    const std::vector<int> list(set.begin(), set.end());
    EXPECT_EQ(frames(frames_text(list)), list) << frames_text(list);
  }
}

TEST(FramePattern, WrongFramesAreRefusedWithWhatIsWrong) {
  EXPECT_EQ(refused(""), "--frames: expected frames, like 1-10x2,15, found none");
  EXPECT_EQ(refused("1-"),
            "--frames: expected a frame number (frames are like 1-10x2,15), found in \"1-\" nothing more");
  EXPECT_EQ(refused("1-10z2"),
            "--frames: expected x, y or : and a step after a range (frames are like 1-10x2,15), found in \"1-10z2\" "
            "\"z2\"");
  EXPECT_EQ(refused("1-10x0"),
            "--frames: expected a step of 1 or more (frames are like 1-10x2,15), found in \"1-10x0\" nothing more");
  EXPECT_EQ(refused("1-999999999"), "--frames: expected at most 1000000 frames, found 999999999");
  EXPECT_EQ(refused("1-999999999:1000"), "--frames: expected at most 1000000 frames, found 999999999");
  EXPECT_EQ(refused("5-5y2"), "--frames: expected at least one frame, found none in \"5-5y2\"");
  for (const char* text : {",", "1,", "a", "1.5", "1-2-3", "--1", "1-10x", "1-10x-2", "12345678901", "1-10x2x3", "1x2"})
    EXPECT_NE(refused(text), "done") << text;
}

TEST(FramePattern, ANameHasOnePlaceForTheFrame) {
  const auto path = [](const std::string& text, int frame) { return frame_pattern(text)->path(frame); };
  EXPECT_EQ(path("a/run.####.ply", 7), "a/run.0007.ply");
  EXPECT_EQ(path("run.#.ply", 7), "run.0007.ply");
  EXPECT_EQ(path("run.###.ply", 7), "run.007.ply");
  EXPECT_EQ(path("run@@@@@@.ply", -7), "run-00007.ply");
  EXPECT_EQ(path("run_@", 123), "run_123");
  EXPECT_EQ(path("%04d.ply", 123456), "123456.ply");
  EXPECT_EQ(path("run%d.ply", -3), "run-3.ply");
  EXPECT_EQ(path("v1.#/run.####.ply", 1), "v1.#/run.0001.ply");
  for (const char* text : {"run.ply", "a#/run.ply", "100%.ply", "%4d.ply", "%s.ply", "", "/"})
    EXPECT_FALSE(frame_pattern(text)) << text;
  EXPECT_EQ(sentence_of([] { frame_pattern("run.#.%04d.ply"); }),
            "run.#.%04d.ply: expected one place for the frame (#, @ or %04d), found \"#\" and \"%04d\"");
}

TEST(FramePattern, ANameMayHoldItsFrames) {
  const auto pattern = frame_pattern("a/run.10-1x3,20#.ply");
  EXPECT_EQ(pattern->frames, (std::vector<int>{1, 4, 7, 10, 20}));
  EXPECT_EQ(pattern->path(4), "a/run.0004.ply");
  EXPECT_EQ(frame_pattern("-2-2@.ply")->frames, (std::vector<int>{-2, -1, 0, 1, 2}));
  EXPECT_TRUE(frame_pattern("take2####.ply")->frames.empty()) << "part of the name";
  EXPECT_EQ(frame_pattern("take2####.ply")->path(1), "take20001.ply");
  EXPECT_NE(sentence_of([] { frame_pattern("run.1-x#.ply"); }), "done");
}

TEST(FramePattern, TheFrameOfANameIsThatOfItsPath) {
  for (const char* text : {"a/run.####.ply", "run.@.ply", "#", "run-%03d.ply"})
    for (const int frame : {0, 1, 9, 10, 99, 9999, 10000, 123456789, -1, -10, -9999}) {
      const FramePattern pattern = *frame_pattern(text);
      const std::string path = pattern.path(frame);
      EXPECT_EQ(pattern.frame_of(path.substr(path.find_last_of('/') + 1)), frame) << path;
    }
  const FramePattern pattern = *frame_pattern("run.####.ply");
  for (const char* name : {"run.001.ply", "run.00001.ply", "run..ply", "run.+001.ply", "run.0001.plyx", "xrun.0001.ply",
                           "run.00x1.ply", "run.-000.ply", "run.99999999999.ply"})
    EXPECT_FALSE(pattern.frame_of(name)) << name;
}

TEST(FramePattern, FramesOnTheDiskAreFound) {
  const TemporaryFolder folder;
  for (const char* name : {"run.0010.ply", "run.0002.ply", "run.-001.ply", "run.10000.ply", "run.3.ply", "run.00.ply",
                           "other.0001.ply", "run.0001.obj"})
    touch(folder / name);
  EXPECT_EQ(frames_on_disk(*frame_pattern(folder / "run.####.ply")), (std::vector<int>{-1, 2, 10, 10000}));
  EXPECT_EQ(frames_on_disk(*frame_pattern(folder / "none.####.ply")), std::vector<int>{});
  EXPECT_NE(sentence_of([&] {
              frames_on_disk(*frame_pattern(folder / "none/run.####.ply"));
            }).find("expected a folder that can be read"),
            std::string::npos);
  touch(folder / "odd#.ply");
  EXPECT_FALSE(frame_pattern(folder / "odd#.ply")) << "a file of this very name is one file";
}

}  // namespace sinew::io
