/// Sequences on the command line: frames chosen, shared out and missing, formats with many frames, streams.

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/io/io.h"
#include "engine/io/sequence.h"
#include "tests/apps/program.h"
#include "tests/apps/sinew_fixtures.h"
#include "tests/document/moving.h"
#include "tests/io/temporary_folder.h"

namespace sinew {

namespace {

/// tube.0001.ply ... and an edit of it by keys.
struct Tube {
  explicit Tube(int frames) {
    const Sequence tube = document::waving_tube(frames);
    for (const int frame : tube.frames) io::write(path("tube.000" + std::to_string(frame) + ".ply"), *tube.load(frame));
    save(path("lift.json"), R"({ "sinew": 1, "layers": [ { "method": "graph", "settings": { "nodes": 40 },
  "fixed": [ { "box": [[-1, -9, -9], [0.45, 9, 9]] } ],
  "handles": [ { "points": { "box": [[3.95, -9, -9], [9, 9, 9]] }, "move": [0, 0, 0] } ],
  "keys": [ { "frame": 1, "handles": [ { "move": [0, 0, 0] } ], "interpolation": "smooth" },
            { "frame": 5, "handles": [ { "rotate": { "axis": [1, 0, 0], "degrees": 90 }, "move": [0, 0.3, 0] } ] } ] } ] })");
  }
  std::string path(const std::string& name) const { return folder / name; }
  std::vector<std::string> deform(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"deform", path("tube.####.ply"), "--edit", path("lift.json"), "-o", path(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  std::string frame(const std::string& name, int number) const {
    return contents(path(name + ".000" + std::to_string(number) + ".ply"));
  }

  TemporaryFolder folder;
};

}  // namespace

TEST(SinewFrames, EverySplitGivesTheSameBytes) {
  const Tube tube(6);
  const Outcome whole = run_sinew(tube.deform("one.####.ply", {"--jobs", "1", "--report", tube.path("r.json")}));
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_NE(contents(tube.path("r.json")).find("\"frames\": 6"), std::string::npos);
  ASSERT_EQ(run_sinew(tube.deform("jobs.####.ply", {"--jobs", "3"})).status, 0);
  for (const char* task : {"3/3", "1/3", "2/3"})
    ASSERT_EQ(run_sinew(tube.deform("tasks.####.ply", {"--task", task})).status, 0) << task;
  ASSERT_EQ(run_sinew(tube.deform("some.####.ply", {"--frames", "2-6x2"})).status, 0);
  for (int frame = 1; frame <= 6; ++frame) {
    const std::string expected = tube.frame("one", frame);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(expected == tube.frame("tube", frame), frame == 1) << "the key at 1 moves nothing; frame " << frame;
    EXPECT_TRUE(tube.frame("jobs", frame) == expected) << frame;
    EXPECT_TRUE(tube.frame("tasks", frame) == expected) << frame;
    EXPECT_TRUE(tube.frame("some", frame) == (frame % 2 == 0 ? expected : "")) << frame;
  }
}

TEST(SinewFrames, TasksFillOneFileOfManyFrames) {
  const Tube tube(5);
  ASSERT_EQ(run_sinew(tube.deform("one.pc2")).status, 0);
  for (const char* task : {"2/2", "1/2", "2/2"})
    ASSERT_EQ(run_sinew(tube.deform("tasks.pc2", {"--task", task})).status, 0) << task;
  EXPECT_TRUE(contents(tube.path("tasks.pc2")) == contents(tube.path("one.pc2")));
  const Outcome gltf = run_sinew(tube.deform("tasks.glb", {"--task", "1/2"}));
  EXPECT_NE(gltf.status, 0);
  EXPECT_NE(gltf.err.find("tasks.glb: expected"), std::string::npos) << gltf.err;
}

TEST(SinewFrames, AFrameThatCannotBeReadFailsAlone) {
  const Tube tube(6);
  save(tube.path("tube.0003.ply"), "ply\nnonsense\n");
  const Outcome out = run_sinew(tube.deform("bent.####.ply"));
  EXPECT_EQ(out.status, 5);
  EXPECT_NE(out.err.find("tube.0003.ply:2"), std::string::npos) << out.err;
  EXPECT_NE(out.err.find("expected all 6 frames to be bent, found 1 that failed: 3"), std::string::npos) << out.err;
  EXPECT_FALSE(tube.frame("bent", 2).empty());
  EXPECT_TRUE(tube.frame("bent", 3).empty());
  // A frame that all others need fails them all.
  save(tube.path("tube.0001.ply"), "ply\nnonsense\n");
  EXPECT_EQ(run_sinew(tube.deform("none.####.ply")).status, 3);
}

TEST(SinewFrames, WhatIsMissingIsNamed) {
  const Tube tube(6);
  std::filesystem::remove(tube.path("tube.0004.ply"));
  const Outcome gap = run_sinew(tube.deform("bent.####.ply"));
  EXPECT_EQ(gap.status, 0) << gap.err;
  EXPECT_NE(gap.err.find("expected every frame, found none of 4"), std::string::npos) << gap.err;
  const Outcome asked = run_sinew(tube.deform("more.####.ply", {"--frames", "3-8"}));
  EXPECT_EQ(asked.status, 3);
  EXPECT_NE(asked.err.find("4,7-8"), std::string::npos) << asked.err;
  EXPECT_EQ(run_sinew(tube.deform("bent.####.ply")).status, 1) << "outputs that exist are kept";
  EXPECT_EQ(run_sinew(tube.deform("one.ply")).status, 1) << "no place for the frame";
  EXPECT_EQ(run_sinew(tube.deform("x.####.ply", {"--jobs", "0"})).status, 2);
  EXPECT_EQ(run_sinew(tube.deform("x.####.ply", {"--task", "4/3"})).status, 2);
  EXPECT_EQ(run_sinew(tube.deform("x.####.ply", {"--pose", tube.path("p")})).status, 2);
}

TEST(SinewFrames, KeysMakeAStillMove) {
  const Tube tube(1);
  const Outcome out = run_sinew({"deform", tube.path("tube.0001.ply"), "--edit", tube.path("lift.json"), "-o",
                                 tube.path("still.####.ply"), "--frames", "1-5"});
  ASSERT_EQ(out.status, 0) << out.err;
  EXPECT_FALSE(tube.frame("still", 3) == tube.frame("still", 5));
  EXPECT_FALSE(tube.frame("still", 1).empty());
}

TEST(SinewFrames, AStreamKeepsItsIdsAndCounts) {
  const TemporaryFolder folder;
  const Sequence jet = document::arc_stream(8);
  for (const int frame : jet.frames)
    io::write((folder / ("jet.000" + std::to_string(frame) + ".ply")), *jet.load(frame));
  save((folder / "bend.json"), R"({ "sinew": 1, "layers": [ { "method": "graph", "settings": { "neighbours": 3 },
  "path": { "every": 2 }, "fixed": [ { "box": [[-1, -9, -9], [0.5, 9, 9]], "frame": 8 } ],
  "handles": [ { "points": { "box": [[1.2, -9, -9], [9, 9, 9]], "frame": 8 }, "move": [0, 0, 0.5] } ] } ] })");
  const Outcome out = run_sinew(
      {"deform", (folder / "jet.####.ply"), "--edit", (folder / "bend.json"), "-o", (folder / "bent.####.ply")});
  ASSERT_EQ(out.status, 0) << out.err;
  const auto before = io::read((folder / "jet.0008.ply")), after = io::read((folder / "bent.0008.ply"));
  ASSERT_EQ(before->size(), after->size());
  EXPECT_TRUE(before->find("id")->values == after->find("id")->values);
  EXPECT_FALSE(before->find("velocity")->values == after->find("velocity")->values);
  EXPECT_NEAR((after->positions.front() - before->positions.front()).z(), 0.5, 0.1);
}

}  // namespace sinew
