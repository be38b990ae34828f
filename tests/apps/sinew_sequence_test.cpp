/// sinew convert and sinew info over sequences of frames.

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/io/temporary_folder.h"

namespace sinew {

namespace {

using Json = nlohmann::json;

/// Two triangles and, from frame 3 on, one more point.
std::string obj(int frame) {
  return "v 0 0 " + std::to_string(frame) + "\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n" +
         (frame >= 3 ? "v 5 5 5\n" : "");
}

class SinewSequence : public testing::Test {
 protected:
  TemporaryFolder folder;
  std::string run = folder / "in.####.obj";

  void save_frames(int count, int growing_from = 1000) {
    for (int frame = 1; frame <= count; ++frame)
      save(folder / ("in.000" + std::to_string(frame) + ".obj"), obj(frame < growing_from ? 1 : frame));
  }
  std::vector<std::string> names(const std::string& beginning) const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      if (const std::string name = entry.path().filename(); name.starts_with(beginning)) out.push_back(name);
    std::sort(out.begin(), out.end());
    return out;
  }
};

}  // namespace

TEST_F(SinewSequence, ARunGoesThroughEveryFormatAndBack) {
  for (int frame = 1; frame <= 4; ++frame)
    save(folder / ("in.000" + std::to_string(frame) + ".obj"),
         "v 0 0 " + std::to_string(frame) + "\nv 1 0 0.5\nv 0.25 1 0\nf 1 2 3\n");
  std::string from = run;
  for (const char* to : {"a.glb", "b.pc2", "c.mdd", "d.gltf", "e.####.ply"}) {
    const Outcome outcome = run_sinew({"convert", from, folder / to});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    from = folder / to;
  }
  EXPECT_EQ(names("e."), (std::vector<std::string>{"e.0001.ply", "e.0002.ply", "e.0003.ply", "e.0004.ply"}));
  for (int frame = 1; frame <= 4; ++frame) {
    const std::string name = "000" + std::to_string(frame);
    const Json diff = Json::parse(
        run_sinew({"diff", "--json", folder / ("in." + name + ".obj"), folder / ("e." + name + ".ply")}).out);
    EXPECT_EQ(diff.at("distance").at("max"), 0) << diff.dump();
  }
}

TEST_F(SinewSequence, WhatIsLostIsToldOnceForAllFrames) {
  save_frames(4);
  EXPECT_EQ(run_sinew({"convert", run, folder / "a.pc2"}).err,
            "sinew: " + (folder / "a.pc2") + ": PC2 cannot hold 2 faces.\n");
}

TEST_F(SinewSequence, FramesAreChosenAndMissingOnesNamed) {
  save_frames(6);
  EXPECT_EQ(run_sinew({"convert", run, folder / "out.%03d.ply", "--frames", "6-1x2"}).status, 0);
  EXPECT_EQ(names("out"), (std::vector<std::string>{"out.002.ply", "out.004.ply", "out.006.ply"}));
  const Outcome missing = run_sinew({"convert", run, folder / "more.####.ply", "--frames", "5-9"});
  EXPECT_EQ(missing.status, 3);
  EXPECT_EQ(missing.err, "sinew: " + run + ": expected the frames 5-9, found no frame 7-9 among 1-6\n");
  EXPECT_TRUE(names("more").empty());
  EXPECT_EQ(run_sinew({"convert", run, folder / "one.ply", "--frames", "3"}).status, 0) << "one frame, one file";
  EXPECT_EQ(run_sinew({"convert", run, folder / "two.ply", "--frames", "3-x"}).status, 3);
  const Outcome one_name = run_sinew({"convert", run, folder / "three.ply"});
  EXPECT_NE(one_name.status, 0);
  EXPECT_NE(one_name.err.find("a name with a place for the frame, like name.####.ply, for 6 frames"),
            std::string::npos);
}

TEST_F(SinewSequence, ExistingFramesAreReplacedOnlyByForce) {
  save_frames(3);
  ASSERT_EQ(run_sinew({"convert", run, folder / "a.####.ply", "--frames", "2"}).status, 0);
  const Outcome refused = run_sinew({"convert", run, folder / "a.####.ply"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("a.0002.ply: expected the name of a new file"), std::string::npos) << refused.err;
  EXPECT_EQ(names("a.").size(), 1u);
  EXPECT_EQ(run_sinew({"convert", run, folder / "a.####.ply", "--force"}).status, 0);
  EXPECT_EQ(names("a.").size(), 3u);
}

TEST_F(SinewSequence, AFileOfManyFramesThatFailsLeavesNothing) {
  save_frames(5, 3);
  const Outcome grown = run_sinew({"convert", run, folder / "a.mdd"});
  EXPECT_NE(grown.status, 0);
  EXPECT_NE(grown.err.find("expected as many points in frame 3 as in others, 4, found 5"), std::string::npos);
  EXPECT_TRUE(names("a.").empty());
  EXPECT_TRUE(names(".").empty()) << "no temporary file";
}

TEST_F(SinewSequence, InfoTellsOfAllFrames) {
  save_frames(5, 3);
  const Json info = Json::parse(run_sinew({"info", "--json", run}).out);
  EXPECT_EQ(info.at("frames"), 5);
  EXPECT_EQ(info.at("frame_range"), "1-5");
  EXPECT_EQ(info.at("rate"), 24);
  EXPECT_EQ(info.at("points"), 4);
  EXPECT_EQ(info.at("least_points"), 4);
  EXPECT_EQ(info.at("most_points"), 5);
  EXPECT_EQ(info.at("bounds").at("max"), (Json{5, 5, 5}));
  const Outcome text = run_sinew({"info", run});
  EXPECT_NE(text.out.find("frames          5: 1-5, 24 a second\n"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("points          4 to 5\n"), std::string::npos) << text.out;
  EXPECT_EQ(Json::parse(run_sinew({"info", "--json", folder / "in.0001.obj"}).out).contains("rate"), false);
}

}  // namespace sinew
