/// Motion capture on the command line.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/io/c3d_maker.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

using Json = nlohmann::json;

/// Three markers over five frames from frame 7 on; the second is not seen in frames 8 and 9.
std::string made() {
  io::C3dMaker maker;
  maker.first = 7;
  maker.unseen = {{1, 1}, {2, 1}};
  maker.parameters = {io::C3dMaker::text("LABELS", {"HEAD", "HAND"}, 4), io::C3dMaker::text("UNITS", {"mm"}, 2)};
  return maker.bytes();
}

}  // namespace

TEST(SinewMotion, InfoSaysWhatMarkersThereAre) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.c3d";
  std::ofstream(path, std::ios::binary) << made();
  const Outcome text = run_sinew({"info", path});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.out, path +
                          "\n"
                          "  representation  markers\n"
                          "  points          3\n"
                          "  frames          5: 7-11, 100 a second\n"
                          "  unit            mm\n"
                          "  min             -20.5 -19.5 -18.5\n"
                          "  max             400 401 402\n"
                          "  diagonal        728.327\n"
                          "  names           HEAD, HAND, *3\n"
                          "  not seen        2 of 15\n"
                          "                  HAND: 2 in 1 gap, the longest 8-9\n");
  const Json info = Json::parse(run_sinew({"info", "--json", path}).out);
  EXPECT_EQ(info["representation"], "markers");
  EXPECT_EQ(info["points"], 3);
  EXPECT_EQ(info["frames"], 5);
  EXPECT_EQ(info["frame_range"], "7-11");
  EXPECT_EQ(info["rate"], 100);
  EXPECT_EQ(info["unit"], "mm");
  EXPECT_EQ(info["not_seen"], 2);
  EXPECT_EQ(info["names"], (std::vector<std::string>{"HEAD", "HAND", "*3"}));
  EXPECT_EQ(info["gaps"][0]["name"], "HAND");
  EXPECT_EQ(info["gaps"][0]["frames"], Json::parse("[[8, 9]]"));
  EXPECT_EQ(info["bounds"]["max"], Json::parse("[400, 401, 402]"));
  EXPECT_EQ(Json::parse(run_sinew({"info", "--json", path, path}).out).size(), 2u);
  EXPECT_EQ(Json::parse(run_sinew({"info", "--json", "-", "--from", "c3d"}, made()).out)["points"], 3);
}

TEST(SinewMotion, InfoSaysWhatSkeletonThereIs) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.bvh";
  std::ofstream(path) << "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 2 0\n}\n}\n"
                         "MOTION\nFrames: 2\nFrame Time: 0.04\n0\n90\n";
  const Json info = Json::parse(run_sinew({"info", "--json", path}).out);
  EXPECT_EQ(info["representation"], "skeleton");
  EXPECT_EQ(info["bones"], 1);
  EXPECT_EQ(info["rate"], 25);
  EXPECT_FALSE(info.contains("unit"));
  EXPECT_EQ(info["names"], (std::vector<std::string>{"hip", "hip end"}));
  EXPECT_NE(run_sinew({"info", path}).out.find("bones           1\n"), std::string::npos);
}

TEST(SinewMotion, BadFilesAreStatus3InOneSentence) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.c3d";
  std::ofstream(path, std::ios::binary) << made().substr(0, 1100);
  const Outcome cut = run_sinew({"info", path});
  EXPECT_EQ(cut.status, 3);
  EXPECT_EQ(cut.err, "sinew: " + path +
                         ": byte 1024: expected 5 frames of 64 bytes, found only 76 bytes to the end of the file\n");
  EXPECT_EQ(run_sinew({"info", folder / "none.trc"}).status, 3);
}

TEST(SinewMotion, InfoReadsRealFiles) {
  SHARED_DATA(folder, "mocap");
  for (const char* name : {"c3d/Dance.c3d", "c3d/Gait.c3d", "trc/T.trc", "bvh/pirouette.bvh"}) {
    const Outcome outcome = run_sinew({"info", "--json", (folder / name).string()});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_GT(Json::parse(outcome.out)["bounds"]["diagonal"], 100) << name;
  }
}

}  // namespace sinew
