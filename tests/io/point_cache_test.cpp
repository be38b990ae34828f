/// PC2 and MDD: both are point caches, and most of what holds for one holds for the other.

#include <array>
#include <random>

#include "engine/geometry/parallel.h"
#include "engine/io/byte_source.h"
#include "engine/io/mdd.h"
#include "engine/io/pc2.h"
#include "engine/io/values.h"
#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

constexpr bool little = std::endian::native == std::endian::little;

template <class T>
void put(std::string& out, T x, bool big_endian) {
  std::array<std::byte, sizeof(T)> bytes;
  store(bytes.data(), x, big_endian == little);
  out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// Coordinate c of point p in frame number i.
float value(int i, int p, int c) {
  return static_cast<float>(100 * i + 10 * p + c) + 0.1F;
}

void put_frames(std::string& out, int points, int frames, bool big_endian) {
  for (int i = 0; i < frames; ++i)
    for (int p = 0; p < points; ++p)
      for (int c = 0; c < 3; ++c) put(out, value(i, p, c), big_endian);
}

std::string pc2_file(float start, float sampling, int points = 3, int frames = 4) {
  std::string out("POINTCACHE2\0", 12);
  for (const int x : {1, points}) put(out, x, false);
  put(out, start, false);
  put(out, sampling, false);
  put(out, frames, false);
  put_frames(out, points, frames, false);
  return out;
}

std::string mdd_file(const std::vector<float>& times, int points = 3) {
  std::string out;
  put(out, static_cast<int>(times.size()), true);
  put(out, points, true);
  for (const float time : times) put(out, time, true);
  put_frames(out, points, static_cast<int>(times.size()), true);
  return out;
}

void save(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

Sequence open_text(Sequence (*open)(std::shared_ptr<const ByteSource>, const ReadOptions&), const std::string& text) {
  return open(bytes_in_memory("test", bytes_of(text)), {});
}

void copy(const std::string& from, const std::string& to) {
  const Sequence sequence = open_sequence(from);
  FrameWriterOptions options;
  options.frames = sequence.frames;
  options.rate = sequence.rate;
  const auto writer = create_frames(to, options);
  for (const int frame : sequence.frames) writer->write(frame, *sequence.load(frame));
  EXPECT_TRUE(writer->commit().lost.empty());
}

Shape moving(int frame, std::size_t points = 500) {
  Shape shape;
  std::mt19937 random(static_cast<unsigned>(frame));
  std::uniform_real_distribution<float> number(-1, 1);
  shape.positions.resize(points);
  for (Vec3& p : shape.positions)
    for (int c = 0; c < 3; ++c) p[c] = static_cast<double>(number(random));
  return shape;
}

FrameWriterOptions ten_frames() {
  FrameWriterOptions options;
  options.frames = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  return options;
}

class PointCaches : public testing::TestWithParam<const char*> {};

}  // namespace

TEST(Pc2, FramesStartAndStepAreRead) {
  const Sequence sequence = open_text(open_pc2, pc2_file(10, 2));
  EXPECT_EQ(sequence.frames, (std::vector<int>{10, 12, 14, 16}));
  const auto shape = sequence.load(14);
  ASSERT_EQ(shape->size(), 3u);
  EXPECT_EQ(shape->positions[1] + shape->origin,
            Vec3(static_cast<double>(value(2, 1, 0)), static_cast<double>(value(2, 1, 1)),
                 static_cast<double>(value(2, 1, 2))));
  EXPECT_EQ(read_text(read_pc2, pc2_file(10, 2)).notes,
            std::vector<std::string>{"Only the first of 4 frames is read."});
}

TEST(Pc2, HalfFramesAreCounted) {
  const Sequence sequence = open_text(open_pc2, pc2_file(0.5F, 0.25F));
  EXPECT_EQ(sequence.frames, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(sequence.load(1)->notes,
            std::vector<std::string>{"Its samples begin at 0.5 and are 0.25 frames apart: they are counted from 1."});
  for (const float odd : {NAN, INFINITY, -1.0F, 0.0F, 1e30F}) {
    EXPECT_EQ(open_text(open_pc2, pc2_file(1, odd)).frames.size(), 4u) << odd;
    EXPECT_EQ(open_text(open_pc2, pc2_file(odd, 1)).frames.size(), 4u) << odd;
  }
}

TEST(Pc2, WrongFilesAreRefused) {
  const auto refused = [](const std::string& text) { return refusal(read_pc2, text, "a.pc2"); };
  const std::string good = pc2_file(1, 1);
  EXPECT_EQ(refused(""), "a.pc2: byte 0: expected a PC2 file (\"POINTCACHE2\"), found an empty file");
  EXPECT_EQ(refused("hello"), "a.pc2: byte 0: expected a PC2 file (\"POINTCACHE2\"), found \"hello\"");
  EXPECT_EQ(refused(good.substr(0, 30)),
            "a.pc2: byte 28: expected 4 bytes of the count of samples, found the end of the file after 2");
  EXPECT_EQ(refused(good.substr(0, good.size() - 1)),
            "a.pc2: byte 32: expected 4 frames of 3 points of 12 bytes, found only 143 bytes to the end of the file");
  std::string bad = good;
  bad[12] = 2;
  EXPECT_EQ(refused(bad), "a.pc2: byte 12: expected version 1, found 2");
  EXPECT_EQ(refused(pc2_file(1, 1, 0, 4)), "a.pc2: expected at least one point, found 0");
  EXPECT_EQ(refused(pc2_file(1, 1, -3, 4)), "a.pc2: expected at least one point, found -3");
  EXPECT_EQ(refused(pc2_file(1, 1, 3, 0)), "a.pc2: expected at least one frame, found 0");
  bad = good;
  bad.replace(16, 4, "\xff\xff\xff\x7f");
  bad.replace(28, 4, "\xff\xff\xff\x7f");
  EXPECT_EQ(refused(bad),
            "a.pc2: byte 32: expected 2147483647 frames of 2147483647 points of 12 bytes, found only 144 bytes to the "
            "end of the file");
}

TEST(Mdd, FramesAndRateAreRead) {
  const Sequence sequence = open_text(open_mdd, mdd_file({0.4F, 0.44F, 0.48F}));
  EXPECT_EQ(sequence.frames, (std::vector<int>{10, 11, 12}));
  EXPECT_EQ(sequence.rate, 25);
  const auto shape = sequence.load(12);
  EXPECT_EQ(shape->positions[2] + shape->origin,
            Vec3(static_cast<double>(value(2, 2, 0)), static_cast<double>(value(2, 2, 1)),
                 static_cast<double>(value(2, 2, 2))));
  const Sequence odd = open_text(open_mdd, mdd_file({0, 0, 5}));
  EXPECT_EQ(odd.frames, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(odd.load(3)->notes,
            std::vector<std::string>{"Its times are no multiples of one step: frames are counted from 1."});
}

TEST(Mdd, WrongFilesAreRefused) {
  const auto refused = [](const std::string& text) { return refusal(read_mdd, text, "a.mdd"); };
  const std::string good = mdd_file({0, 1, 2});
  EXPECT_EQ(refused(""), "a.mdd: byte 0: expected 4 bytes of the count of frames, found the end of the file after 0");
  EXPECT_EQ(refused(good.substr(0, good.size() - 1)),
            "a.mdd: byte 20: expected 3 frames of 3 points of 12 bytes, found only 107 bytes to the end of the file");
  EXPECT_EQ(refused(mdd_file({})), "a.mdd: expected at least one frame, found 0");
  EXPECT_EQ(refused(mdd_file({0}, 0)), "a.mdd: expected at least one point, found 0");
  EXPECT_EQ(refused(std::string(8, '\x7f')),
            "a.mdd: byte 8556248580: expected 2139062143 frames of 2139062143 points of 12 bytes, found only 0 bytes "
            "to the end of the file");
}

TEST(PointCache, AnUnchangedFileIsWrittenWithItsBytes) {
  const TemporaryFolder folder;
  int i = 0;
  std::string odd = pc2_file(3, 1);
  // A negative zero, a signalling not-a-number and a large coordinate beside small ones keep their bits.
  odd.replace(32, 12, std::string("\0\0\0\x80\x01\0\x80\x7f\0\0\0\x7f", 12));
  for (const std::string& text : {pc2_file(10, 2), pc2_file(0.5F, 0.25F), pc2_file(NAN, -0.0F), odd, pc2_file(-3, 1)}) {
    const std::string name = std::to_string(i++);
    save(folder / (name + ".pc2"), text);
    copy(folder / (name + ".pc2"), folder / ("copy" + name + ".pc2"));
    EXPECT_TRUE(text_of_file(folder / ("copy" + name + ".pc2")) == text) << name;
  }
  for (const std::string& text : {mdd_file({0, 1, 2, 3}), mdd_file({0, 0, 0}), mdd_file({0.1F, 0.2F, 0.30000001F})}) {
    const std::string name = std::to_string(i++);
    save(folder / (name + ".mdd"), text);
    copy(folder / (name + ".mdd"), folder / ("copy" + name + ".mdd"));
    EXPECT_TRUE(text_of_file(folder / ("copy" + name + ".mdd")) == text) << name;
  }
}

TEST(PointCache, OneCoordinateOfOneFrameChangesAlone) {
  const TemporaryFolder folder;
  const std::string text = pc2_file(1, 1);
  save(folder / "in.pc2", text);
  const Sequence sequence = open_sequence(folder / "in.pc2");
  FrameWriterOptions options;
  options.frames = sequence.frames;
  const auto writer = create_frames(folder / "out.pc2", options);
  for (const int frame : {4, 3, 2, 1}) {
    Shape shape = *sequence.load(frame);
    if (frame == 3) shape.positions[1].y() += 1;
    writer->write(frame, shape);
  }
  writer->commit();
  std::string expected = text, changed;
  put(changed, value(2, 1, 1) + 1, false);
  expected.replace(32 + 36 * 2 + 16, 4, changed);
  EXPECT_TRUE(text_of_file(folder / "out.pc2") == expected);
}

TEST_P(PointCaches, FramesAreWrittenInAnyOrderAndFromSeveralThreads) {
  const TemporaryFolder folder;
  const std::string type = GetParam();
  const FrameWriterOptions options = ten_frames();
  const auto serial = create_frames(folder / ("a." + type), options);
  for (const int frame : options.frames) serial->write(frame, moving(frame));
  serial->commit();
  const auto parallel = create_frames(folder / ("b." + type), options);
  set_thread_count(4);
  parallel_for(10, 1, [&](std::size_t i, std::size_t) {
    const int frame = options.frames[9 - i];
    parallel->write(frame, moving(frame));
  });
  set_thread_count(0);
  parallel->commit();
  EXPECT_TRUE(text_of_file(folder / ("a." + type)) == text_of_file(folder / ("b." + type)));
  const Sequence again = open_sequence(folder / ("b." + type));
  EXPECT_EQ(again.frames, options.frames);
  for (const int frame : again.frames) EXPECT_TRUE(again.load(frame)->positions == moving(frame).positions) << frame;
}

TEST_P(PointCaches, TasksShareOneFile) {
  const TemporaryFolder folder;
  const std::string whole = folder / ("whole." + std::string(GetParam()));
  const std::string path = folder / ("shared." + std::string(GetParam()));
  FrameWriterOptions options = ten_frames();
  const auto run = [&](const std::string& to, int frames) {
    const auto writer = create_frames(to, options);
    for (const int frame : options.own_frames())
      if (frames-- > 0) writer->write(frame, moving(frame));
    writer->commit();
  };
  run(whole, 10);
  for (std::uint64_t i = 3; i >= 1; --i) {
    options.share = Share{i, 3};
    // The second task is stopped after its first frame, and run again.
    const std::string stopped = i == 2 ? sentence_of([&] { run(path, 1); }) : "";
    if (i == 2) {
      EXPECT_EQ(stopped, path + ": expected all of its 3 frames, found no frame 5-6");
    }
    run(path, 10);
    run(path, 10);
  }
  EXPECT_TRUE(text_of_file(path) == text_of_file(whole));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);

  options.frames.pop_back();
  EXPECT_NE(sentence_of([&] { run(path, 10); }).find("(--force replaces it)"), std::string::npos);
  options.force = true;
  for (std::uint64_t i = 1; i <= 3; ++i) {
    options.share = Share{i, 3};
    run(path, 10);
  }
  options.share.reset();
  run(whole, 10);
  EXPECT_TRUE(text_of_file(path) == text_of_file(whole));
}

TEST_P(PointCaches, AnOutputThatIsNotFinishedLeavesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder / ("a." + std::string(GetParam()));
  const FrameWriterOptions options = ten_frames();
  const auto writer = create_frames(path, options);
  for (int frame = 1; frame < 9; ++frame) writer->write(frame, moving(frame));
  EXPECT_EQ(sentence_of([&] { writer->write(9, moving(9, 7)); }),
            path + ": expected as many points in frame 9 as in others, 500, found 7");
  EXPECT_EQ(sentence_of([&] { writer->commit(); }), path + ": expected all of its 10 frames, found no frame 9-10");
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_NE(
      sentence_of([&] { create_frames(path, options)->write(1, Shape()); }).find("expected 1 to 2147483647 points"),
      std::string::npos);
}

TEST_P(PointCaches, WhatCannotBeHeldIsTold) {
  const TemporaryFolder folder;
  FrameWriterOptions options;
  options.frames = {1, 2, 4};
  options.rate = 30;
  const bool pc2 = GetParam() == std::string("pc2");
  const auto writer = create_frames(folder / ("a." + std::string(GetParam())), options);
  for (const int frame : options.frames) {
    Shape shape = moving(frame);
    shape.position_type = Type::Float64;
    shape.positions[0].x() = 0.1;
    shape.faces.add(std::array<Index, 3>{0, 1, 2});
    shape.attributes.push_back({});
    shape.attributes[0].name = "color";
    shape.attributes[0].fields = {"color"};
    shape.attributes[0].values.resize(4 * shape.size());
    writer->write(frame, shape);
  }
  const std::string name = pc2 ? "PC2" : "MDD";
  std::vector<std::string> expected;
  if (pc2)
    expected = {"PC2 cannot hold the frames 1-2,4: they follow each other without gaps.",
                "PC2 cannot hold the rate of 30 frames a second."};
  for (const char* what :
       {"1 face", "coordinates beyond float: they change by up to 1.4901161e-09", "the attribute \"color\""})
    expected.push_back(name + " cannot hold " + what + ".");
  EXPECT_EQ(writer->commit().lost, expected);
}

INSTANTIATE_TEST_SUITE_P(Formats, PointCaches, testing::Values("pc2", "mdd"));

TEST(PointCache, ARealMddIsWrittenWithItsBytes) {
  SHARED_DATA(cube, "anim/mdd/cube.mdd");
  const TemporaryFolder folder;
  copy(cube.string(), folder / "cube.mdd");
  EXPECT_TRUE(text_of_file(folder / "cube.mdd") == text_of_file(cube.string()));
  const Sequence sequence = open_sequence(cube.string());
  EXPECT_EQ(sequence.frames, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(sequence.load(3)->size(), 24u);
}

}  // namespace sinew::io
