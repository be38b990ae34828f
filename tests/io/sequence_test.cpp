#include "engine/io/sequence.h"

#include "engine/geometry/parallel.h"
#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

/// Three points that depend on the frame.
Shape shape_of(int frame) {
  Shape shape;
  shape.positions = {{0.5 * frame, 0, 0}, {1, 0.25, 0}, {0, 1, 2.0 * frame}};
  return shape;
}

std::vector<int> first_to(int last) {
  std::vector<int> frames;
  for (int f = 1; f <= last; ++f) frames.push_back(f);
  return frames;
}

void write_all(const std::string& path, const FrameWriterOptions& options) {
  const auto writer = create_frames(path, options);
  for (const int frame : options.own_frames()) writer->write(frame, shape_of(frame));
  writer->commit();
}

FrameWriterOptions with(std::vector<int> frames) {
  FrameWriterOptions options;
  options.frames = std::move(frames);
  return options;
}

}  // namespace

TEST(Sequence, FramesOfTetsSayOnceThatTheyAreLost) {
  const TemporaryFolder folder;
  for (const char* name : {"a.pc2", "a.mdd", "a.gltf", "a.####.ply", "a.####.mesh"}) {
    const auto writer = create_frames(folder / name, with({1, 2}));
    for (const int frame : {1, 2}) {
      Shape shape = shape_of(frame);
      shape.positions.emplace_back(0, 0, -1);
      shape.tets = {{0, 1, 2, 3}};
      writer->write(frame, shape);
    }
    const std::vector<std::string> lost = writer->commit().lost;
    const auto count =
        std::count_if(lost.begin(), lost.end(), [](const std::string& s) { return s.ends_with("cannot hold 1 tet."); });
    EXPECT_EQ(count, std::string(name).ends_with("mesh") ? 0 : 1) << name;
  }
}

TEST(Sequence, ARunIsWrittenAndFoundAgain) {
  const TemporaryFolder folder;
  const std::string path = folder / "run.####.ply";
  write_all(path, with({-1, 2, 30}));
  const Sequence run = open_sequence(path);
  EXPECT_EQ(run.frames, (std::vector<int>{-1, 2, 30}));
  for (const int frame : run.frames) EXPECT_EQ(run.load(frame)->positions, shape_of(frame).positions);
  EXPECT_TRUE(std::filesystem::exists(folder / "run.0030.ply"));
}

TEST(Sequence, AMissingFrameIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder / "run.####.ply";
  EXPECT_EQ(
      sentence_of([&] { open_sequence(path); }),
      path + ": expected a file a frame, such as " + (folder / "run.0001.ply") + ", found no file of such a name");
  write_all(path, with({1, 2, 3, 5, 6}));
  const Sequence run = open_sequence(path);
  EXPECT_EQ(sentence_of([&] { run.load(4); }), path + ": expected frame 4, found only 1-3,5-6");
  EXPECT_EQ(sentence_of([&] { open_sequence(folder / "run.1-9#.ply"); }),
            (folder / "run.1-9#.ply") + ": expected all frames of the name, found no file of frame 4,7-9");
  EXPECT_EQ(sentence_of([&] { chosen_frames(run, path, "1-9x2"); }),
            path + ": expected the frames 1-9x2, found no frame 7,9 among 1-3,5-6");
  EXPECT_EQ(chosen_frames(run, path, "6,1-3x2").frames, (std::vector<int>{1, 3, 6}));
  EXPECT_EQ(open_sequence(folder / "run.1-5x2#.ply").frames, (std::vector<int>{1, 3, 5}));
  std::filesystem::remove(folder / "run.0002.ply");
  EXPECT_NE(sentence_of([&] { run.load(2); }).find("run.0002.ply: expected a file that can be read"),
            std::string::npos);
}

TEST(Sequence, AStillHasOneFrame) {
  const TemporaryFolder folder;
  write_all(folder / "still.ply", with({5}));
  const Sequence still = open_sequence(folder / "still.ply");
  EXPECT_EQ(still.frames, std::vector<int>{1});
  EXPECT_EQ(still.load(1)->positions, shape_of(5).positions);
  EXPECT_EQ(sentence_of([&] { still.load(2); }), (folder / "still.ply") + ": expected frame 2, found only 1");
}

TEST(Sequence, OutputsAreRefusedBeforeTheyBegin) {
  const TemporaryFolder folder;
  EXPECT_EQ(sentence_of([&] {
              create_frames("still.ply", with({1, 2}));
            }),
            "still.ply: expected a name with a place for the frame, like name.####.ply, for 2 frames, found the name "
            "of one file");
  EXPECT_NE(sentence_of([&] {
              create_frames("run.####.xxx", with({1, 2}));
            }).find("a name that ends in"),
            std::string::npos);
  EXPECT_EQ(sentence_of([&] {
              create_frames("run.####.conf", with({1, 2}));
            }),
            "run.####.conf: expected a format that has a file a frame, found \"Scan set\"");
  EXPECT_EQ(sentence_of([&] {
              create_frames("run.1-3#.ply", with({1, 2}));
            }),
            "run.1-3#.ply: expected a name with the frames that are written, 1-2, found 1-3");
  write_all(folder / "run.####.ply", with({1, 2}));
  EXPECT_EQ(
      sentence_of([&] {
        create_frames(folder / "run.####.ply", with({2, 3}));
      }),
      (folder / "run.0002.ply") + ": expected the name of a new file, found an existing one (--force replaces it)");
  FrameWriterOptions force = with({2, 3});
  force.force = true;
  write_all(folder / "run.####.ply", force);
}

TEST(Sequence, SharesAreThePartsOfTheWhole) {
  for (const std::size_t n : {0u, 1u, 5u, 48u, 1000u})
    for (const std::uint64_t count : {1u, 2u, 3u, 7u, 60u}) {
      std::size_t next = 0;
      for (std::uint64_t i = 1; i <= count; ++i) {
        const Share share{i, count};
        EXPECT_EQ(share.first(n), next);
        EXPECT_LE(share.last(n) - share.first(n), n / count + 1);
        next = share.last(n);
      }
      EXPECT_EQ(next, n);
    }
  const TemporaryFolder folder;
  FrameWriterOptions options = with(first_to(10));
  for (std::uint64_t i = 3; i >= 1; --i) {
    options.share = Share{i, 3};
    write_all(folder / "run.####.ply", options);
  }
  EXPECT_EQ(open_sequence(folder / "run.####.ply").frames, first_to(10));
}

TEST(Sequence, WhatIsLostIsToldOnce) {
  const TemporaryFolder folder;
  const auto writer = create_frames(folder / "run.####.stl", with({1, 2, 3}));
  for (const int frame : {2, 3, 1}) {
    Shape shape = shape_of(frame);
    // More loose points from frame to frame.
    shape.positions.resize(static_cast<std::size_t>(3 + frame), Vec3::Zero());
    shape.faces.add(std::array<Index, 3>{0, 1, 2});
    writer->write(frame, shape);
  }
  EXPECT_EQ(writer->commit().lost, std::vector<std::string>{"STL cannot hold 1 point of no face."});
}

TEST(Sequence, TheHorseGallops) {
  SHARED_DATA(gallop, "anim/horse_gallop_obj");
  const Sequence run = open_sequence((gallop / "####.obj").string());
  EXPECT_EQ(run.frames, first_to(48));
  const auto first = run.load(1), last = run.load(48);
  EXPECT_EQ(first->size(), 8431u);
  EXPECT_EQ(last->faces.points, first->faces.points);
  EXPECT_NE(last->positions, first->positions);
}

}  // namespace sinew::io
