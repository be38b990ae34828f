/// CSV of markers, both ways.

#include "engine/io/marker_csv.h"

#include "tests/io/motion_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

Trajectories read_text(const std::string& text) {
  return read_marker_csv("a.csv", bytes_of(text));
}

std::string refused(const std::string& text) {
  return sentence_of([&] { read_text(text); });
}

/// As written and read again.
Trajectories again(const Trajectories& motion, std::vector<std::string> lost) {
  WriteReport report;
  const std::string text = text_of(write_marker_csv(motion, report));
  EXPECT_EQ(report.lost, lost);
  return read_text(text);
}

void expect_same(const Trajectories& a, const Trajectories& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t f = 0; f < a.frames.size(); ++f)
    for (std::size_t p = 0; p < a.names.size(); ++p)
      ASSERT_TRUE(a.frames[f][p] == b.frames[f][p] || (!seen(a.frames[f][p]) && !seen(b.frames[f][p])))
          << f << ' ' << p;
}

}  // namespace

TEST(MarkerCsv, NamesOfColumnsTellTheMarkers) {
  for (const std::string head :
       {"Frame,Time,head.x,head.y,head.z,L_ARM_X,L_ARM_Y,L_ARM_Z",
        "\xef\xbb\xbf\"frame#\",time (s),head:x, head:y ,head:z,\"L_ARM.x\",L_ARM.Y,L_ARM_z"}) {
    const Trajectories read = read_text(head + "\r\n10,0,1,2,3,4,5,6\r\n11,0.02,,,,-1,nan,2\r\n12,0.04,1,2,3,1e3,0,0");
    expect_sound(read);
    EXPECT_EQ(read.names, (std::vector<std::string>{"head", "L_ARM"}));
    EXPECT_EQ(read.first_frame, 10);
    EXPECT_EQ(read.rate, 50);
    EXPECT_TRUE(read.notes.empty());
    EXPECT_EQ(read.frames[0][1], Vec3(4, 5, 6));
    EXPECT_FALSE(seen(read.frames[1][0]));
    EXPECT_FALSE(seen(read.frames[1][1]));
    EXPECT_EQ(read.frames[2][1], Vec3(1000, 0, 0));
  }
}

TEST(MarkerCsv, ColumnsStandInAnyOrderAndOthersAreNamed) {
  const Trajectories read = read_text("a.z;force;a.x;t;a.y\n3;100;1;0;2\n6;100;4;5;5\n9;;7;7;8\n");
  expect_sound(read);
  EXPECT_EQ(read.frames[2][0], Vec3(7, 8, 9));
  EXPECT_EQ(read.rate, 0);
  EXPECT_EQ(read.notes, (std::vector<std::string>{"Its times are not evenly spaced: the rate is not known by them.",
                                                  "Columns that are not read: \"force\"."}));
}

TEST(MarkerCsv, WrongFilesAreRefused) {
  EXPECT_EQ(refused(""), "a.csv:1:1: expected names of columns as NAME.x, NAME.y and NAME.z, found \"\"");
  EXPECT_EQ(refused("x,y,z\n1,2,3"), "a.csv:1:1: expected names of columns as NAME.x, NAME.y and NAME.z, found \"x\"");
  EXPECT_EQ(refused("a.x,a.y\n1,2"), "a.csv:1: expected x, y and z of \"a\", found no z");
  EXPECT_EQ(refused("a.x,a.y,a.z,a.x\n1,2"), "a.csv:1:13: expected each column once, found \"a.x\" again");
  EXPECT_EQ(refused("a.x,a.y,a.z\n"), "a.csv: expected at least one frame, found 0");
  EXPECT_EQ(refused("a.x,a.y,a.z\n1,2,3\n\n1,two,3\n"), "a.csv:4:3: expected y of \"a\", found \"two\"");
  EXPECT_EQ(refused("a.x,a.y,a.z\n1,2,3,,4\n"), "a.csv:2:8: expected the end of the row after 3 columns, found \"4\"");
}

TEST(MarkerCsv, WhatIsWrittenReadsBackTheSame) {
  Trajectories motion;
  motion.names = {"a", "b,c \"d\"", "a", "", "a#2"};
  motion.first_frame = -3;
  motion.rate = 65.0533447265625;
  for (int f = 0; f < 4; ++f) {
    std::vector<Vec3> frame;
    for (int p = 0; p < 5; ++p) frame.emplace_back(f + 0.1 * p, 1.0 / 3 * f, -1e-300 * p);
    motion.frames.push_back(std::move(frame));
  }
  motion.frames[2][1] = not_seen;
  const Trajectories read = again(motion, {"Names that stand twice or are empty: 2 changed."});
  expect_sound(read);
  EXPECT_EQ(read.names, (std::vector<std::string>{"a", "b,c \"d\"", "a#3", "*4", "a#2"}));
  EXPECT_EQ(read.first_frame, -3);
  EXPECT_NEAR(read.rate, motion.rate, 1e-9);
  expect_same(read, motion);
}

TEST(MarkerCsv, ARealRecordingSurvives) {
  SHARED_DATA(path, "mocap/c3d/Gait.c3d");
  const Trajectories gait = read_motion(path.string());
  const Trajectories read =
      again(gait, {"The unit of length, \"mm\".", "Names that stand twice or are empty: 6 changed."});
  EXPECT_EQ(read.names[11], "RKNE");
  EXPECT_EQ(gait.names[22], "RKNE");
  EXPECT_EQ(read.names[22], "RKNE#2");
  EXPECT_EQ(read.rate, gait.rate);
  expect_same(read, gait);
}

TEST(MarkerCsv, PointsInCsvAreNotTakenForMarkers) {
  const TemporaryFolder folder;
  const auto says = [&](const std::string& text) {
    std::ofstream(folder / "a.csv") << text;
    return is_motion(folder / "a.csv");
  };
  EXPECT_TRUE(says("frame,a.x,a.y,a.z\n1,2,3,4\n"));
  EXPECT_TRUE(says("\xef\xbb\xbf\"a.x\";a.y;a.z;time (s)\r\n1;2;3;4\n"));
  EXPECT_FALSE(says("x,y,z\n1,2,3\n"));
  EXPECT_FALSE(says("x,y,z,v_x,v_y,v_z,time\n1,2,3,4,5,6,7\n"));
  EXPECT_FALSE(says("P.x,P.y,P.z\n1,2,3\n"));
  EXPECT_FALSE(says(""));
  EXPECT_FALSE(is_motion(folder / "none.csv"));
  EXPECT_TRUE(is_motion("walk.C3D"));
  EXPECT_FALSE(is_motion("walk.obj"));
}

TEST(MarkerCsv, FilesAreKnownByTheirNames) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.CSV") << "a.x,a.y,a.z\n1,2,3\n";
  EXPECT_EQ(read_motion(folder / "a.CSV").frames[0][0], Vec3(1, 2, 3));
  EXPECT_EQ(sentence_of([&] { read_motion("a.obj"); }),
            "a.obj: expected a name that ends in .c3d, .trc, .bvh, .csv, found \".obj\"");
  EXPECT_EQ(sentence_of([&] { read_motion("a"); }),
            "a: expected a name that ends in .c3d, .trc, .bvh, .csv, found no extension");
  std::ofstream(folder / "a.c3d") << "version https://git-lfs.github.com/spec/v1\n";
  EXPECT_TRUE(sentence_of([&] { read_motion(folder / "a.c3d"); }).ends_with("(the file itself was not downloaded)"));
}

}  // namespace sinew::io
