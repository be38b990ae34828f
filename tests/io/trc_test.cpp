/// TRC: hand-made files, and real ones of two programs.

#include "engine/io/trc.h"

#include "tests/io/motion_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

Trajectories read_text(const std::string& text) {
  return read_trc("a.trc", bytes_of(text));
}

std::string refused(const std::string& text) {
  return sentence_of([&] { read_text(text); });
}

const std::string header =
    "PathFileType\t4\t(X/Y/Z)\ta.trc\t\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\t\n"
    "120.00\t120.00\t3\t3\tmm\t120.00\t5\t3\t\n";
const std::string names = "Frame#\tTime\tHead Top\t\t\tB\t\t\t\t\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3\t\n\t\n";
const std::string rows =
    "5\t0.000\t1\t2\t3\t-4.5\t5e1\t6\t7\t8\t9\t\t\t\n"
    "6\t0.008\t\t\t\t1\t2\t3\t7\t\t9\n"
    "\n"
    "7\t0.017\tNaN\tnan\tNaN\t1\t2\t3\t\t\t\t";

}  // namespace

TEST(Trc, MarkersAndGapsAreRead) {
  for (const bool carriage_returns : {false, true}) {
    std::string text = header + names + rows;
    for (std::size_t at = 0; carriage_returns && (at = text.find('\n', at)) != std::string::npos; at += 2)
      text.replace(at, 1, "\r\n");
    const Trajectories read = read_text(text);
    expect_sound(read);
    EXPECT_EQ(read.names, (std::vector<std::string>{"Head Top", "B", "*3"}));
    EXPECT_EQ(read.rate, 120);
    EXPECT_EQ(read.unit, "mm");
    EXPECT_EQ(read.first_frame, 5);
    EXPECT_TRUE(read.notes.empty()) << read.notes.front();
    ASSERT_EQ(read.frames.size(), 3u);
    EXPECT_EQ(read.frames[0][0], Vec3(1, 2, 3));
    EXPECT_EQ(read.frames[0][1], Vec3(-4.5, 50, 6));
    EXPECT_EQ(read.frames[0][2], Vec3(7, 8, 9));
    EXPECT_FALSE(seen(read.frames[1][0]));
    EXPECT_TRUE(seen(read.frames[1][1]));
    EXPECT_FALSE(seen(read.frames[1][2]));  // y is missing
    EXPECT_FALSE(seen(read.frames[2][0]));
    EXPECT_FALSE(seen(read.frames[2][2]));
  }
}

TEST(Trc, WhatTheHeaderHasWrongIsNoted) {
  const Trajectories read = read_text(
      "PathFileType\t4\t(Z/X/Y)\ta\nDataRate\tNumFrames\tNumMarkers\tOrigDataStartFrame\n0\t9\t9\t4\n"
      "Frame#\tTime\tA\nX\t\tX1\tY1\tZ1\n1\t0.5\t1\t2\t3\n3\t0.75\t1\t2\n4\t1.0\t1\t2\t3\n");
  expect_sound(read);
  EXPECT_EQ(read.rate, 4);  // by its times
  EXPECT_EQ(read.unit, "");
  EXPECT_FALSE(seen(read.frames[1][0]));
  EXPECT_EQ(read.notes, (std::vector<std::string>{
                            "Its frames are not numbered one after the other: rows are counted from 1.",
                            "In 1 row the last columns are missing.", "NumMarkers is 9: 1 have columns and are read.",
                            "NumFrames is 9: 3 have rows and are read.",
                            "OrigDataStartFrame is 4: 1 is the number of the first row, and counts.",
                            "Its axes are \"(Z/X/Y)\"."}));
}

TEST(Trc, TheRowOfColumnNamesMayBeLeftOut) {
  const Trajectories read =
      read_text("PathFileType\t4\t(X/Y/Z)\ta\nDataRate\n50\nFrame#\tTime\tA\t\t\n1\t0\t1\t2\t3\n2\t0.02\t4\t5\t6\n");
  ASSERT_EQ(read.frames.size(), 2u);
  EXPECT_EQ(read.frames[0][0], Vec3(1, 2, 3));
}

TEST(Trc, WrongFilesAreRefused) {
  EXPECT_EQ(refused(""), "a.trc:1:1: expected a TRC file (\"PathFileType\"), found the end of the file");
  EXPECT_EQ(refused("hello\tyou"), "a.trc:1:1: expected a TRC file (\"PathFileType\"), found \"hello\"");
  EXPECT_EQ(refused("PathFileType\t4\n"),
            "a.trc:2:1: expected the names of properties (DataRate, ...), found the end of the file");
  EXPECT_EQ(refused(header), "a.trc:4:1: expected the names of markers, found the end of the file");
  EXPECT_EQ(refused(header + "Number\t\n"),
            "a.trc:4:1: expected \"Frame#\" and the names of markers, found \"Number\"");
  EXPECT_EQ(refused(header + "Frame#\tTime\tA\tB\n"),
            "a.trc:4:15: expected an empty cell, as each marker has three columns, found \"B\"");
  EXPECT_EQ(refused(header + "Frame#\tTime\n\t\t\n1\t2\n"), "a.trc: expected at least one marker, found 0");
  EXPECT_EQ(refused(header + names), "a.trc: expected at least one frame, found 0");
  EXPECT_EQ(refused(header + names + "1\t0\t1\tx\t3"), "a.trc:7:7: expected y of \"Head Top\", found \"x\"");
  EXPECT_EQ(refused(header + names + "1\t0\t1\t2\t3\t4\t5\t6\t7\t8\t9\t10"),
            "a.trc:7:23: expected the end of the row after 11 columns, found \"10\"");
  EXPECT_EQ(refused(header + names + "one\t0\t1\t2\t3"), "a.trc:7:1: expected the number of a frame, found \"one\"");
}

TEST(Trc, AFileCannotTakeMuchMoreMemoryThanItHas) {
  std::string text = header + "Frame#\tTime";
  for (int i = 0; i < 20000; ++i) text += "\tA\t\t";
  text += "\n\t\tX\n";
  for (int i = 0; i < 100000; ++i) text += "1\n";
  EXPECT_TRUE(refused(text).ends_with(" frames of 20000 points")) << refused(text);
}

TEST(Trc, DamagedFilesAreReadOrRefused) {
  const std::string good = header + names + rows;
  for (std::size_t i = 0; i < good.size(); ++i) {
    expect_sound_or_refused(read_trc, good.substr(0, i));
    for (const char c : {'\0', '\n', '\t', '9', '"', '\xff'}) {
      std::string bad = good;
      bad[i] = c;
      expect_sound_or_refused(read_trc, bad);
    }
  }
}

TEST(Trc, RealFilesAreRead) {
  SHARED_DATA(folder, "mocap/trc");
  const Trajectories anto = read_motion((folder / "Anto.trc").string());
  expect_sound(anto);
  EXPECT_EQ(anto.names.size(), 34u);
  EXPECT_EQ(anto.frames.size(), 128u);
  EXPECT_EQ(anto.rate, 100);
  EXPECT_EQ(anto.unit, "mm");
  EXPECT_EQ(anto.names[0], "R.Poignee");
  EXPECT_EQ(anto.frames[127][0], Vec3(-200.70854, -116.63701, 721.52441));
  const Trajectories t = read_motion((folder / "T.trc").string());
  expect_sound(t);
  EXPECT_EQ(t.names.size(), 41u);
  EXPECT_EQ(t.frames.size(), 89u);
  EXPECT_EQ(t.rate, 30);
  EXPECT_EQ(t.frames[0][1], Vec3(-173.49149, 1579.73837, 76.41232));
}

TEST(Trc, AFileThatOthersFoundBroken) {
  SHARED_DATA(path, "malformed/btk/Truncated.trc");
  EXPECT_EQ(sentence_of([&] { read_motion(path.string()); }),
            path.string() + ":3:1: expected the values of properties, found the end of the file");
}

}  // namespace sinew::io
