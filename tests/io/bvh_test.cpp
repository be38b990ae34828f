/// BVH: hand-made skeletons against closed forms, and a real dance.

#include "engine/io/bvh.h"

#include <Eigen/Geometry>
#include <numbers>

#include "tests/io/motion_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

Trajectories read_text(const std::string& text) {
  return read_bvh("a.bvh", bytes_of(text));
}

std::string refused(const std::string& text) {
  return sentence_of([&] { read_text(text); });
}

/// An arm: a root, an elbow without a channel of its own between, and a hand with an end.
std::string arm(const std::string& root_channels, const std::string& hand_channels, const std::string& rows) {
  return "HIERARCHY\nROOT root\n{\n OFFSET 1 2 3\n CHANNELS " + root_channels +
         "\n JOINT elbow of arm {\n  OFFSET 2 0 0\n  JOINT hand\n  {\n   OFFSET 0 1 0\n   CHANNELS " + hand_channels +
         "\n   End Site\n   {\n    OFFSET 0 0 4\n   }\n  }\n }\n}\nMOTION\nFrames: 2\nFrame Time: 0.04\n" + rows;
}

void expect_at(const Vec3& p, double x, double y, double z) {
  EXPECT_LT((p - Vec3(x, y, z)).norm(), 1e-12) << p.transpose();
}

/// Turns by degrees, written out.
Eigen::Matrix3d about_x(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  Eigen::Matrix3d m;
  m << 1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a);
  return m;
}
Eigen::Matrix3d about_y(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  Eigen::Matrix3d m;
  m << std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a);
  return m;
}
Eigen::Matrix3d about_z(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  Eigen::Matrix3d m;
  m << std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1;
  return m;
}

}  // namespace

TEST(Bvh, JointsFollowTheirParents) {
  // Root turned by 90 degrees about z: x -> y. Hand turned by 90 about x: z -> -y of the root's frame, x of the world.
  const Trajectories read =
      read_text(arm("6 Xposition Yposition Zposition Zrotation Xrotation Yrotation", "3 Zrotation Xrotation Yrotation",
                    "0 0 0 0 0 0 0 0 0\n10 20 30 90 0 0 0 90 0\n"));
  expect_sound(read);
  EXPECT_EQ(read.names, (std::vector<std::string>{"root", "elbow of arm", "hand", "hand end"}));
  EXPECT_EQ(read.bones, (std::vector<std::array<int, 2>>{{0, 1}, {1, 2}, {2, 3}}));
  EXPECT_EQ(read.rate, 25);
  EXPECT_TRUE(read.notes.empty());
  expect_at(read.rest[0], 1, 2, 3);
  expect_at(read.rest[3], 3, 3, 7);
  // Positions stand in place of the offset: the root of the first frame lies in the origin.
  expect_at(read.frames[0][0], 0, 0, 0);
  expect_at(read.frames[0][3], 2, 1, 4);
  expect_at(read.frames[1][0], 10, 20, 30);
  expect_at(read.frames[1][1], 10, 22, 30);
  expect_at(read.frames[1][2], 9, 22, 30);
  expect_at(read.frames[1][3], 13, 22, 30);
}

/// Also in the order of the channels' words, and whatever their case.
TEST(Bvh, RotationsMultiplyInTheOrderOfTheChannels) {
  struct Order {
    const char* channels;
    Eigen::Matrix3d turn;
  };
  for (const Order& order : {Order{"3 Zrotation Xrotation Yrotation", about_z(20) * about_x(-35) * about_y(70)},
                             Order{"3 YROTATION zRotation Xrotation", about_y(20) * about_z(-35) * about_x(70)},
                             Order{"3 Xrotation Yrotation Xrotation", about_x(20) * about_y(-35) * about_x(70)}}) {
    const Trajectories read = read_text(arm(order.channels, "1 Yrotation", "20 -35 70 15\n0 0 0 0\n"));
    expect_sound(read);
    const Vec3 root(1, 2, 3), elbow = root + order.turn * Vec3(2, 0, 0), hand = elbow + order.turn * Vec3(0, 1, 0);
    const Vec3 end = hand + order.turn * about_y(15) * Vec3(0, 0, 4);
    EXPECT_LT((read.frames[0][2] - hand).norm(), 1e-12) << order.channels;
    EXPECT_LT((read.frames[0][3] - end).norm(), 1e-12) << order.channels;
    EXPECT_LT((read.transforms[0][3].leftCols<3>() - order.turn * about_y(15)).norm(), 1e-12) << order.channels;
  }
}

TEST(Bvh, PositionsOfAnyJointStandForItsOffset) {
  const Trajectories read = read_text(
      arm("2 Zrotation Xposition", "4 Yposition Zrotation Zposition Xrotation", "90 5 7 0 8 0\n0 0 0 0 0 0\n"));
  expect_sound(read);
  expect_at(read.frames[0][0], 5, 2, 3);
  expect_at(read.frames[0][1], 5, 4, 3);
  // x of the hand's offset has no channel: it stays 0.
  expect_at(read.frames[0][2], 5 - 7, 4, 3 + 8);
}

TEST(Bvh, TransformsDriveWhatHangsOnAJoint) {
  const Trajectories read =
      read_text(arm("6 Xposition Yposition Zposition Zrotation Xrotation Yrotation", "3 Zrotation Xrotation Yrotation",
                    "1 2 3 0 0 0 0 0 0\n4 5 6 10 20 30 40 50 60\n"));
  for (std::size_t p = 0; p < 4; ++p) {
    EXPECT_LT((read.transforms[0][p] * read.rest[p].homogeneous() - read.rest[p]).norm(), 1e-12);
    EXPECT_LT((read.transforms[1][p] * read.rest[p].homogeneous() - read.frames[1][p]).norm(), 1e-12);
  }
  // What hangs on the hand keeps its distance to it and to the hand's end.
  const Vec3 x = read.rest[2] + Vec3(0.5, -1, 2), moved = read.transforms[1][2] * x.homogeneous();
  EXPECT_NEAR((moved - read.frames[1][2]).norm(), (x - read.rest[2]).norm(), 1e-12);
  EXPECT_NEAR((moved - read.frames[1][3]).norm(), (x - read.rest[3]).norm(), 1e-12);
}

TEST(Bvh, SeveralRootsAndCountsThatDisagree) {
  const std::string root = "ROOT a{OFFSET 0 0 0\nCHANNELS 1 Xposition\n}\n";
  const Trajectories read =
      read_text("HIERARCHY\n" + root + root + "MOTION\r\n\r\nFrames : 7\r\nFrame Time: 0\r\n1 2\r\n\r\n3 4\r\n5 6");
  expect_sound(read);
  EXPECT_EQ(read.frames.size(), 3u);
  EXPECT_EQ(read.rate, 0);
  EXPECT_EQ(read.frames[2][1], Vec3(6, 0, 0));
  EXPECT_TRUE(read.bones.empty());
  EXPECT_EQ(read.notes, (std::vector<std::string>{"Its Frame Time is 0: the rate is not known.",
                                                  "It says 7 frames and has 3, which are read."}));
}

TEST(Bvh, WrongFilesAreRefused) {
  const std::string three = "3 Zrotation Xrotation Yrotation";
  EXPECT_EQ(refused(""), "a.bvh:1:1: expected \"HIERARCHY\", found the end of the data");
  EXPECT_EQ(refused("HIERARCHY\nMOTION"), "a.bvh:2:1: expected ROOT, found \"MOTION\"");
  EXPECT_EQ(refused("HIERARCHY\nROOT\n{"), "a.bvh:2: expected the name of a joint, of at most 255 bytes, found \"\"");
  EXPECT_EQ(refused("HIERARCHY\nROOT a\n{\n OFFSET 1 2\n"),
            "a.bvh:4:12: expected three numbers of an OFFSET, found the end of the line");
  EXPECT_EQ(refused("HIERARCHY\nROOT a\n{\n}\n"), "a.bvh:4:1: expected OFFSET, found \"}\"");
  EXPECT_EQ(refused("HIERARCHY\nROOT a\n{\n OFFSET 1 2 3\n"),
            "a.bvh:5:1: expected OFFSET, CHANNELS, JOINT, End Site or \"}\", found the end of the data");
  EXPECT_EQ(refused("HIERARCHY\nROOT a\n{\n OFFSET 1 2 3\n CHANNELS 1000000000 Xrotation\n}"),
            "a.bvh:6:1: expected a channel (Xposition ... Zrotation), found \"}\"");
  EXPECT_EQ(refused("HIERARCHY\nROOT a\n{\n OFFSET 1 2 3\n CHANNELS 1 Wrotation\n}"),
            "a.bvh:5:13: expected a channel (Xposition ... Zrotation), found \"Wrotation\"");
  EXPECT_EQ(refused(arm("0", "0", "")), "a.bvh: expected at least one channel, found 0");
  EXPECT_EQ(refused(arm(three, three, "")), "a.bvh: expected at least one frame, found 0");
  EXPECT_EQ(refused(arm(three, three, "1 2 3 4 5\n")),
            "a.bvh:22:10: expected value 6 of 6 of row 1, found the end of the line");
  EXPECT_EQ(refused(arm(three, three, "1 2 3 4 5 6 7\n")),
            "a.bvh:22:13: expected the end of the line after 6 values, found \"7\"");
  EXPECT_EQ(refused(arm(three, three, "1 2 3 4 5 nan\n")),
            "a.bvh:22:11: expected value 6 of 6 of row 1, found \"nan\"");
  EXPECT_EQ(refused(arm(three, three, "").replace(arm(three, three, "").find("Frames"), 6, "Count!")),
            "a.bvh:20: expected \"Frames: NUMBER\", found \"Count!: 2\"");
}

/// Very many joints of no channel and very many rows of one value; braces nested as deeply as a file can be long.
TEST(Bvh, AFileCannotTakeMuchMoreMemoryThanItHas) {
  std::string text = "HIERARCHY\nROOT a{OFFSET 0 0 0\nCHANNELS 1 Xposition\n";
  for (int i = 0; i < 20000; ++i) text += "End Site{OFFSET 1 0 0\n}\n";
  text += "}\nMOTION\nFrames: 100000\nFrame Time: 1\n";
  for (int i = 0; i < 100000; ++i) text += "1\n";
  EXPECT_TRUE(refused(text).ends_with("found 100000 frames of 20001 points")) << refused(text);
  text = "HIERARCHY\nROOT a{OFFSET 0 0 0\nCHANNELS 1 Xposition\n";
  for (int i = 0; i < 20000; ++i) text += "JOINT b{OFFSET 1 0 0\n";
  for (int i = 0; i < 20001; ++i) text += "}";
  const Trajectories read = read_text(text + "MOTION\nFrames: 1\nFrame Time: 1\n5\n");
  EXPECT_EQ(read.frames[0][20000].x(), 20005);
}

TEST(Bvh, DamagedFilesAreReadOrRefused) {
  const std::string good = arm("3 Zrotation Xrotation Yposition", "1 Zrotation", "1 2 3 4\n5 6 7 8\n");
  for (std::size_t i = 0; i < good.size(); ++i) {
    expect_sound_or_refused(read_bvh, good.substr(0, i));
    for (const char c : {'\0', '\n', '{', '}', '9', '\xff'}) {
      std::string bad = good;
      bad[i] = c;
      expect_sound_or_refused(read_bvh, bad);
    }
  }
}

/// Places were computed once by another program, written for that.
TEST(Bvh, ARealDanceIsRead) {
  SHARED_DATA(path, "mocap/bvh/pirouette.bvh");
  const Trajectories read = read_motion(path.string());
  expect_sound(read);
  EXPECT_EQ(read.names.size(), 43u + 14);
  EXPECT_EQ(read.frames.size(), 592u);
  EXPECT_EQ(read.rate, 120);
  EXPECT_EQ(read.bones.size(), 56u);
  EXPECT_TRUE(read.notes.empty());
  const auto expect_place = [&](std::size_t f, std::size_t p, const Vec3& place) {
    EXPECT_LT((read.frames[f][p] - place).norm(), 2e-6) << f << ' ' << p << ": " << read.frames[f][p].transpose();
  };
  expect_place(0, 0, {15.3137, 84.8855, 152.037});
  expect_place(0, 6, {20.408076, 154.564843, 157.88803});
  expect_place(300, 6, {-42.982629, 150.603735, 94.07187});
  expect_place(300, 56, {-46.271277, 5.334097, 107.97943});
  expect_place(591, 56, {-46.156511, 7.721472, 106.146474});
  for (const auto& frame : read.frames)
    for (const auto& [parent, child] : read.bones) {
      const auto a = static_cast<std::size_t>(parent), b = static_cast<std::size_t>(child);
      ASSERT_NEAR((frame[b] - frame[a]).norm(), (read.rest[b] - read.rest[a]).norm(), 1e-9);
    }
}

}  // namespace sinew::io
