/// C3D: files made by c3d_maker.h, and real ones of all three processors.

#include "engine/io/c3d.h"

#include "tests/io/c3d_maker.h"
#include "tests/io/file_checks.h"
#include "tests/io/motion_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

Trajectories read_made(const C3dMaker& maker) {
  return read_c3d("test.c3d", bytes_of(maker.bytes()));
}

std::string refused(const std::string& bytes) {
  return sentence_of([&] { read_c3d("a.c3d", bytes_of(bytes)); });
}

std::vector<C3dMaker> six_variants() {
  std::vector<C3dMaker> makers;
  for (const auto processor : {C3dMaker::Intel, C3dMaker::Dec, C3dMaker::Mips})
    for (const bool real : {true, false}) {
      C3dMaker maker;
      maker.processor = processor;
      maker.real = real;
      makers.push_back(maker);
    }
  return makers;
}

}  // namespace

/// All coordinates are whole quarters, which floats and integers of that scale hold exactly.
TEST(C3d, AllProcessorsAndTypesOfNumbersAreRead) {
  for (C3dMaker maker : six_variants()) {
    maker.parameters = {C3dMaker::text("LABELS", {"HEAD", "L HAND", ""}, 8), C3dMaker::text("UNITS", {"mm"}, 4),
                        C3dMaker::text("X_SCREEN", {"+Y"}, 2)};
    maker.unseen = {{2, 1}, {4, 0}};
    maker.first = 7;
    const Trajectories read = read_made(maker);
    expect_sound(read);
    EXPECT_EQ(read.names, (std::vector<std::string>{"HEAD", "L HAND", "*3"}));
    EXPECT_EQ(read.unit, "mm");
    EXPECT_EQ(read.rate, 100);
    EXPECT_EQ(read.first_frame, 7);
    EXPECT_EQ(read.notes, std::vector<std::string>{"POINT:X_SCREEN is \"+Y\"."});
    ASSERT_EQ(read.frames.size(), 5u);
    for (int f = 0; f < 5; ++f)
      for (int p = 0; p < 3; ++p) {
        const Vec3& x = read.frames[static_cast<std::size_t>(f)][static_cast<std::size_t>(p)];
        if ((f == 2 && p == 1) || (f == 4 && p == 0)) {
          EXPECT_TRUE(x.array().isNaN().all()) << maker.processor << maker.real;
          continue;
        }
        for (int c = 0; c < 3; ++c) EXPECT_EQ(x[c], C3dMaker::value(f, p, c)) << maker.processor << maker.real;
      }
  }
}

TEST(C3d, AFloatOfNoNumberIsNotSeen) {
  C3dMaker maker;
  std::string bytes = maker.bytes();
  bytes.replace(1024, 4, maker.real_number(1).substr(0, 2) + "\xff\x7f");
  EXPECT_FALSE(seen(read_c3d("test.c3d", bytes_of(bytes)).frames[0][0]));
  maker.processor = C3dMaker::Dec;
  bytes = maker.bytes();
  // In F_floating, a sign without an exponent is none.
  bytes.replace(1024, 4, std::string("\0\x80\0\0", 4));
  EXPECT_FALSE(seen(read_c3d("test.c3d", bytes_of(bytes)).frames[0][0]));
  // The largest, whose bits would be no number in IEEE 754.
  bytes.replace(1024, 4, "\xff\x7f\xff\xff");
  EXPECT_EQ(read_c3d("test.c3d", bytes_of(bytes)).frames[0][0].x(), 1.7014117331926443e38);
}

TEST(C3d, MoreThan255LabelsGoOnInAnotherParameter) {
  C3dMaker maker;
  maker.points = 300;
  std::vector<std::string> names;
  for (int i = 0; i < 300; ++i) names.push_back("P" + std::to_string(i));
  maker.parameters = {C3dMaker::text("LABELS", {names.begin(), names.begin() + 255}, 5),
                      C3dMaker::text("LABELS2", {names.begin() + 255, names.end()}, 5)};
  EXPECT_EQ(read_made(maker).names, names);
}

TEST(C3d, MoreFramesThan16BitsHold) {
  C3dMaker maker;
  maker.points = 1;
  maker.channels = 0;
  maker.frames = 70000;
  maker.header_last = 65535;
  const auto expect_all = [](const C3dMaker& m, int first) {
    const Trajectories read = read_made(m);
    ASSERT_EQ(read.frames.size(), 70000u);
    EXPECT_EQ(read.first_frame, first);
    EXPECT_EQ(read.frames.back()[0].x(), static_cast<double>(static_cast<float>(C3dMaker::value(69999, 0, 0))));
  };
  C3dMaker m = maker;
  m.parameters = {{1, "LONG_FRAMES", 4, {}, maker.real_number(70000)}};
  expect_all(m, 1);
  m.parameters = {{1, "FRAMES", 4, {}, maker.real_number(70000)}};
  expect_all(m, 1);
  // Frames 65541 to 135540, in words of which the low one stands first; the header's are what is left of them.
  m.parameters = {{3, "ACTUAL_START_FIELD", 2, {2}, maker.word(5) + maker.word(1)},
                  {3, "ACTUAL_END_FIELD", 2, {2}, maker.word(135540 & 0xffff) + maker.word(135540 >> 16)}};
  m.header_first = 65535;
  expect_all(m, 65541);
  EXPECT_EQ(
      read_made(m).notes,
      std::vector<std::string>{"By the header there are 1 frames, by TRIAL:ACTUAL_END_FIELD 70000, which are read."});
}

TEST(C3d, WhatDisagreesIsNotedAndWhatFitsCounts) {
  C3dMaker maker;
  maker.header_points = 9;  // the parameters have 3, which the file bears out
  Trajectories read = read_made(maker);
  EXPECT_EQ(read.names.size(), 3u);
  EXPECT_EQ(read.notes, std::vector<std::string>{"POINT:USED is 3, the header has 9: 3 counts."});
  maker.header_points = -1;
  maker.used = 900;
  read = read_made(maker);
  EXPECT_EQ(read.names.size(), 3u);
  EXPECT_EQ(read.frames[4][2].y(), C3dMaker::value(4, 2, 1));
  EXPECT_EQ(read.notes, std::vector<std::string>{"POINT:USED is 900, the header has 3: 3 counts."});
  maker.used = -1;
  maker.parameters = {{1, "FRAMES", 2, {}, maker.word(600)}};
  read = read_made(maker);
  EXPECT_EQ(read.frames.size(), 5u);
  EXPECT_EQ(read.notes,
            std::vector<std::string>{"By POINT:FRAMES there are 600 frames, by the header 5, which are read."});
}

TEST(C3d, TheHeaderTellsWhereParametersAre) {
  C3dMaker maker;
  maker.parameter_block = 5;
  const Trajectories read = read_made(maker);
  EXPECT_EQ(read.frames[3][1].z(), C3dMaker::value(3, 1, 2));
  std::string bytes = maker.bytes();
  bytes[0] = 0;
  EXPECT_EQ(refused(bytes), "a.c3d: byte 0: expected the block of the parameters, from 2 on, found 0");
  bytes[0] = 100;
  EXPECT_EQ(refused(bytes),
            "a.c3d: byte 0: expected the block of the parameters, within the file of 3072 bytes, found 100");
}

/// Records that point behind the section or into themselves, names that do, values that overlap the next record.
TEST(C3d, BrokenParametersEndWhereTheyBreak) {
  C3dMaker maker;
  const auto with = [&](const std::string& record) {
    C3dMaker m = maker;
    std::string bytes = m.bytes();
    const std::size_t at = 512 + m.section().size() - 2;
    bytes.replace(at, record.size(), record);
    const Trajectories read = read_c3d("test.c3d", bytes_of(bytes));
    EXPECT_EQ(read.frames[4][2].y(), C3dMaker::value(4, 2, 1));
    std::string notes;
    for (const std::string& note : read.notes) notes += note + "|";
    return notes;
  };
  const std::string at = std::to_string(512 + maker.section().size() - 2);
  const std::string behind = "; what stands before that counts.|";
  EXPECT_EQ(with(std::string("\4\1LONG\xff\x7f", 8)),
            "Its parameters break off at byte " + at + ": the next record would stand behind their end" + behind);
  EXPECT_EQ(with(std::string("\4\1LONG\1\0\2\0", 10)),
            "Its parameters break off at byte " + at + ": the next record would stand within this one" + behind);
  // A float of 255 dimensions, each 255; the description is left out as some programs do.
  maker.parameters = {{1, "HUGE", 4, std::vector<int>(255, 255), ""}, C3dMaker::text("UNITS", {"m"}, 1)};
  const Trajectories read = read_made(maker);
  EXPECT_EQ(read.unit, "m");
  // A name that would go on into the data.
  maker.parameters = {C3dMaker::text("DESCRIPTIONS", {std::string(370, 'x')}, 185)};
  std::string bytes = maker.bytes();
  bytes[1020] = 100;
  bytes[1021] = 1;
  EXPECT_NO_THROW(read_c3d("test.c3d", bytes_of(bytes)));
}

TEST(C3d, WrongFilesAreRefused) {
  C3dMaker maker;
  const std::string good = maker.bytes();
  EXPECT_EQ(refused(""), "a.c3d: byte 0: expected 2 bytes of a C3D file, found the end of the file after 0");
  EXPECT_EQ(refused("hello"), "a.c3d: byte 1: expected a C3D file (80 as its second byte), found 101");
  EXPECT_EQ(refused(good.substr(0, 400)),
            "a.c3d: byte 2: expected 510 bytes of the header, found the end of the file after 398");
  EXPECT_EQ(refused(good.substr(0, 514)),
            "a.c3d: byte 512: expected 4 bytes of the head of the parameters, found the end of the file after 2");
  EXPECT_EQ(refused(good.substr(0, 1100)),
            "a.c3d: byte 1024: expected 5 frames of 64 bytes, found only 76 bytes to the end of the file");
  std::string bad = good;
  bad[515] = 7;
  EXPECT_EQ(refused(bad), "a.c3d: byte 515: expected the processor: 84 (Intel), 85 (DEC) or 86 (MIPS), found 7");
  C3dMaker flat;
  flat.real = false;
  bad = flat.bytes();
  const std::size_t scale = bad.find("SCALE") + 5 + 2 + 2;  // behind the offset, the type and the count of dimensions
  bad.replace(12, 4, 4, '\0').replace(scale, 4, 4, '\0');
  EXPECT_EQ(refused(bad), "a.c3d: byte 12: expected the scale of the points, which is not zero, found 0");
  // One of the two is enough.
  bad = flat.bytes();
  bad.replace(scale, 4, 4, '\0');
  EXPECT_EQ(read_c3d("a.c3d", bytes_of(bad)).frames[1][2].x(), C3dMaker::value(1, 2, 0));
  C3dMaker none;
  none.points = 0;
  EXPECT_EQ(refused(none.bytes()), "a.c3d: expected at least one point, found 0");
  none.points = 3;
  none.frames = 0;
  EXPECT_EQ(refused(none.bytes()), "a.c3d: expected at least one frame, found 0");
}

/// Every prefix, and every byte of header and parameters set to each of some values, is read or refused in a sentence.
TEST(C3d, DamagedFilesAreReadOrRefused) {
  C3dMaker maker;
  maker.parameters = {C3dMaker::text("LABELS", {"A", "B", "C"}, 2),
                      {1, "LONG_FRAMES", 4, {}, maker.real_number(5)},
                      {3, "ACTUAL_START_FIELD", 2, {2}, maker.word(1) + maker.word(0)},
                      {3, "ACTUAL_END_FIELD", 2, {2}, maker.word(5) + maker.word(0)}};
  const std::string good = maker.bytes();
  for (std::size_t size = 0; size < good.size(); size += 7) expect_sound_or_refused(read_c3d, good.substr(0, size));
  std::size_t refusals = 0;
  for (std::size_t i = 0; i < 512 + maker.section().size(); ++i)
    for (const int value : {0, 1, 127, 128, 255}) {
      std::string bad = good;
      bad[i] = static_cast<char>(value);
      refusals += expect_sound_or_refused(read_c3d, bad) ? 0 : 1;
    }
  EXPECT_GT(refusals, 5u);
}

/// One recording, stored by three processors: integers of Intel and MIPS, floats of DEC, which are the integers'
/// values.
TEST(C3d, TheSameRecordingOfThreeProcessorsAgrees) {
  SHARED_DATA(folder, "mocap/c3d");
  const Trajectories intel = read_motion((folder / "Eb015pi.c3d").string());
  EXPECT_EQ(intel.names.size(), 26u);
  EXPECT_EQ(intel.frames.size(), 450u);
  EXPECT_EQ(intel.rate, 50);
  EXPECT_EQ(intel.unit, "mm");
  EXPECT_EQ(intel.names[0], "RFT1");
  std::size_t hidden = 0, shown = 0;
  for (const char* name : {"Eb015si.c3d", "Eb015vr.c3d"}) {
    const Trajectories other = read_motion((folder / name).string());
    expect_sound(other);
    EXPECT_EQ(other.names, intel.names);
    EXPECT_EQ(other.rate, intel.rate);
    ASSERT_EQ(other.frames.size(), intel.frames.size());
    for (std::size_t f = 0; f < intel.frames.size(); ++f)
      for (std::size_t p = 0; p < intel.names.size(); ++p) {
        const Vec3 a = intel.frames[f][p], b = other.frames[f][p];
        ASSERT_EQ(seen(a), seen(b)) << name << ' ' << f << ' ' << p;
        if (!seen(a)) ++hidden;
        if (!seen(a)) continue;
        ++shown;
        ASSERT_LT((a - b).norm(), 1e-3) << name << ' ' << f << ' ' << p;
      }
  }
  EXPECT_GT(hidden, 0u);
  EXPECT_GT(shown, 2u * 26 * 400);
}

TEST(C3d, RealFilesAreRead) {
  SHARED_DATA(folder, "mocap/c3d");
  struct Real {
    const char* name;
    std::size_t points, frames;
    double rate;
    const char* unit;
    const char* first_name;
  };
  for (const Real& real :
       {Real{"Dance.c3d", 40, 499, 65.0533447265625, "mm", "Channel101"}, Real{"Gait.c3d", 33, 487, 100, "mm", "RSHO"},
        Real{"pc_real.c3d", 36, 89, 50, "mm", "RFT1"}, Real{"MyCube.c3d", 14, 1, 50, "mm", "PBLeiden01_1"}}) {
    const Trajectories read = read_motion((folder / real.name).string());
    expect_sound(read);
    EXPECT_EQ(read.names.size(), real.points) << real.name;
    EXPECT_EQ(read.frames.size(), real.frames) << real.name;
    EXPECT_EQ(read.first_frame, 1) << real.name;
    EXPECT_EQ(read.rate, real.rate) << real.name;
    EXPECT_EQ(read.unit, real.unit) << real.name;
    EXPECT_EQ(read.names[0], real.first_name) << real.name;
    // What people and cubes measure: some of it was seen, and all of that within a room of 20 m, in millimetres.
    std::size_t shown = 0;
    for (const auto& frame : read.frames)
      for (const Vec3& p : frame)
        if (seen(p)) {
          ++shown;
          EXPECT_LT(p.norm(), 20000) << real.name;
        }
    EXPECT_GT(3 * shown, real.points * real.frames) << real.name;
    if (real.name == std::string("Gait.c3d")) {
      EXPECT_EQ(shown, 6389u);  // samples whose fourth word is not negative
    }
  }
}

TEST(C3d, FilesThatOthersFoundBroken) {
  SHARED_DATA(folder, "malformed/btk");
  const Trajectories offset = read_motion((folder / "badParameterOffset.c3d").string());
  expect_sound(offset);
  EXPECT_EQ(offset.names.size(), 41u);
  EXPECT_EQ(offset.frames.size(), 111u);
  EXPECT_EQ(offset.names[40], "Point   41");
  const Trajectories section = read_motion((folder / "bad_parameter_section.c3d").string());
  expect_sound(section);
  EXPECT_EQ(section.names.size(), 45u);
  EXPECT_EQ(section.frames.size(), 332u);
  EXPECT_EQ(section.names[44], "P45");
  EXPECT_NE(section.notes.front().find("break off at byte 5564"), std::string::npos) << section.notes.front();
}

}  // namespace sinew::io
