#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/io/io.h"
#include "engine/io/motion.h"
#include "tests/apps/program.h"
#include "tests/apps/sinew_fixtures.h"
#include "tests/io/temporary_folder.h"

namespace sinew {

namespace {

class Sinew : public testing::Test {
 protected:
  void SetUp() override {
    save(scan, sheet_ply());
    save(edit, turn_edit());
  }
  /// Names of what lies in the folder.
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      found.push_back(entry.path().filename());
    std::sort(found.begin(), found.end());
    return found;
  }

  TemporaryFolder folder;
  std::string scan = folder / "scan.ply", edit = folder / "edit.json", out = folder / "out.ply";
};

using Json = nlohmann::json;

}  // namespace

TEST_F(Sinew, EveryCommandHasHelpWithExamples) {
  const Outcome help = run_sinew({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.err, "");
  for (const char* command : {"info", "deform", "blend", "apply", "render", "diff", "convert", "formats", "methods"}) {
    EXPECT_NE(help.out.find(std::string("\n  ") + command + " "), std::string::npos) << command;
    const Outcome of_command = run_sinew({command, "--help"});
    EXPECT_EQ(of_command.status, 0);
    EXPECT_NE(of_command.out.find("Examples:\n  "), std::string::npos) << command;
    EXPECT_EQ(of_command.out.back(), '\n');
  }
}

TEST_F(Sinew, UsageMistakesAreOneLineAndStatus2) {
  const std::vector<std::vector<std::string>> cases = {
      {},
      {"bend"},
      {"info"},
      {"info", "--jsn", scan},
      {"deform", scan, "--edit", edit},
      {"deform", scan, "-o", out},
      {"deform", "-", "--edit", "-", "-o", out},
      {"deform", scan, "--edit", edit, "-o", "-", "--to", "ply", "--report", "-"},
      {"deform", scan, "--edit", edit, "-o", folder / "out.abc"},
      {"convert", scan, folder / "bent/"},
      {"convert", scan, "-"},
      {"convert", scan, folder / "out"},
      {"convert", scan, folder / "out.conf"},
      {"render", scan, "-o", folder / "out.jpg"},
      {"render", scan, "-o", folder / "a.png", "--size", "0x10"},
      {"render", scan, "-o", folder / "a.png", "--size", "640"},
      {"render", scan, "-o", folder / "a.png", "--view", "1,2,3"},
      {"render", scan, "-o", folder / "a.png", "--show", "grph"},
      {"render", scan, "-o", folder / "a.png", "--up", "x"},
  };
  for (const auto& arguments : cases) {
    const Outcome outcome = run_sinew(arguments);
    std::string line;
    for (const std::string& argument : arguments) line += argument + " ";
    EXPECT_EQ(outcome.status, 2) << line << outcome.err;
    EXPECT_EQ(outcome.out, "") << line;
    EXPECT_TRUE(outcome.err.starts_with("sinew: ")) << line;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"edit.json", "scan.ply"}));
}

TEST_F(Sinew, InfoSaysWhatAFileHolds) {
  const Outcome text = run_sinew({"info", scan});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("points          800\n"), std::string::npos) << text.out;
  const Json info = Json::parse(run_sinew({"info", "--json", scan}).out);
  EXPECT_EQ(info["representation"], "point cloud");
  EXPECT_EQ(info["points"], 800);
  EXPECT_EQ(info["components"], 1);
  EXPECT_EQ(info["frames"], 1);
  EXPECT_EQ(info["bounds"]["max"][0], static_cast<double>(3.9f));
  EXPECT_EQ(info["attributes"][0]["kind"], "normal");
  EXPECT_EQ(info["attributes"][1]["type"], "uint8");
  EXPECT_EQ(Json::parse(run_sinew({"info", "--json", scan, scan}).out).size(), 2u);
  EXPECT_EQ(run_sinew({"info", "-", "--from", "ply"}, sheet_ply()).status, 0);
}

TEST_F(Sinew, TetsAreCountedAndConverted) {
  save(folder / "a.mesh",
       "MeshVersionFormatted 1\nDimension 3\nVertices 5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 0\n"
       "Triangles 1\n1 2 3 0\nTetrahedra 2\n1 2 3 4 0\n2 3 4 5 0\nEnd\n");
  EXPECT_NE(run_sinew({"info", folder / "a.mesh"}).out.find("tets            2\n"), std::string::npos);
  std::string last = "a.mesh";
  for (const char* name : {"b.ele", "c.msh", "d.vtu", "e.vtk", "f.node", "g.mesh"}) {
    const Outcome done = run_sinew({"convert", folder / last, folder / name});
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(done.err, "") << name;
    const Json info = Json::parse(run_sinew({"info", "--json", folder / name}).out);
    EXPECT_EQ(info["representation"], "solid mesh") << name;
    EXPECT_EQ(info["points"], 5) << name;
    EXPECT_EQ(info["faces"], 1) << name;
    EXPECT_EQ(info["tets"], 2) << name;
    EXPECT_EQ(info["components"], 1) << name;
    last = name;
  }
  EXPECT_EQ(run_sinew({"convert", folder / "g.mesh", out}).err, "sinew: " + out + ": PLY cannot hold 2 tets.\n");
  EXPECT_EQ(Json::parse(run_sinew({"info", "--json", out}).out)["tets"], 0);
  // The files of TetGen are compared as one.
  EXPECT_EQ(run_sinew({"convert", folder / "a.mesh", folder / "h.node"}).status, 0);
  const auto rest = [&] {
    return Json::parse(run_sinew({"diff", "--json", folder / "f.node", folder / "h.node"}).out)["rest"];
  };
  EXPECT_EQ(rest(), "equal");
  save(folder / "h.ele", "2 4 0\n1 1 2 3 4\n2 2 3 5 4\n");
  EXPECT_EQ(rest(), "changed");
}

TEST_F(Sinew, BadInputIsStatus3AndLeavesNothing) {
  save(scan, sheet_ply().substr(0, 2000));
  const Outcome cut = run_sinew({"deform", scan, "--edit", edit, "-o", out, "--report", folder / "r.json"});
  EXPECT_EQ(cut.status, 3);
  EXPECT_TRUE(cut.err.starts_with("sinew: " + scan + ":")) << cut.err;
  EXPECT_EQ(run_sinew({"info", folder / "none.ply"}).status, 3);
  EXPECT_EQ(run_sinew({"info", folder.path().string()}).status, 3);
  EXPECT_EQ(run_sinew({"info", folder / "frame.####.obj"}).err,
            "sinew: " + (folder / "frame.####.obj") + ": expected a file a frame, such as " +
                (folder / "frame.0001.obj") + ", found no file of such a name\n");
  EXPECT_EQ(names(), (std::vector<std::string>{"edit.json", "scan.ply"}));
}

TEST_F(Sinew, ExistingOutputsAreRefusedBeforeTheWorkStarts) {
  for (const char* name : {"out.ply", "r.json", "p.json"}) {
    save(folder / name, "mine");
    // The input does not even exist: the output is looked at first.
    const Outcome refused = run_sinew({"deform", folder / "none.ply", "--edit", edit, "-o", out, "--report",
                                       folder / "r.json", "--pose", folder / "p.json"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_EQ(refused.err, "sinew: " + (folder / name) +
                               ": expected the name of a new file, found an existing one (--force replaces it)\n");
    EXPECT_EQ(contents(folder / name), "mine");
    std::filesystem::remove(folder / name);
  }
  save(out, "mine");
  EXPECT_EQ(run_sinew({"convert", scan, out}).status, 1);
  EXPECT_EQ(run_sinew({"convert", scan, out, "--force"}).status, 0);
  EXPECT_EQ(contents(out), sheet_ply());
}

TEST_F(Sinew, AFullDiskIsStatus1) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  std::filesystem::create_symlink("/dev/full", folder / "full.ply");
  const Outcome outcome = run_sinew({"convert", scan, folder / "full.ply"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("No space left"), std::string::npos) << outcome.err;
}

TEST_F(Sinew, StreamsStandForFiles) {
  EXPECT_EQ(run_sinew({"convert", "-", "-", "--from", "ply", "--to", "ply"}, sheet_ply()).out, sheet_ply());
  ASSERT_EQ(run_sinew({"deform", scan, "--edit", edit, "-o", out}).status, 0);
  const Outcome piped =
      run_sinew({"deform", "-", "--from", "ply", "--edit", edit, "-o", "-", "--to", "ply"}, sheet_ply());
  EXPECT_EQ(piped.status, 0) << piped.err;
  EXPECT_EQ(piped.out, contents(out));
  EXPECT_EQ(run_sinew({"deform", scan, "--edit", "-", "-o", "-", "--to", "ply"}, turn_edit()).out, contents(out));
}

TEST_F(Sinew, DeformGivesThePointsOfEvaluate) {
  ASSERT_EQ(run_sinew({"deform", scan, "--edit", edit, "-o", out}).status, 0);
  const document::Project project = document::read_edit(edit);
  const document::Evaluation evaluation = document::evaluate(io::read(scan), project.layers, methods());
  io::write(folder / "same.ply", *evaluation.shape);
  EXPECT_EQ(contents(out), contents(folder / "same.ply"));
  EXPECT_NE(contents(out), sheet_ply());
}

TEST_F(Sinew, ApplyGivesThePointsOfDeform) {
  const std::string pose = folder / "pose.json", applied = folder / "applied.ply";
  ASSERT_EQ(run_sinew({"deform", scan, "--edit", edit, "-o", out, "--pose", pose}).status, 0);
  const Outcome outcome = run_sinew({"apply", pose, scan, "-o", applied});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(contents(applied), contents(out));
  EXPECT_EQ(run_sinew({"apply", pose, "-", "-o", "-", "--from", "ply"}, sheet_ply()).out, contents(out));
}

TEST_F(Sinew, ApplyRefusesAPoseThatDoesNotFitWithItsPath) {
  const std::string pose = folder / "pose.json";
  save(pose, R"({"sinew_pose": 1, "origin": [0, 0, 0], "layers": [{"method": "graph", "binding": [], "maps": []}]})");
  const Outcome outcome = run_sinew({"apply", pose, scan, "-o", out});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(outcome.err.starts_with("sinew: " + pose + ": expected ")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Sinew, TheReportHasTheFieldsOthersRelyOn) {
  const std::string path = folder / "r.json";
  ASSERT_EQ(run_sinew({"deform", scan, "--edit", edit, "-o", out, "--report", path, "--set", "nodes=40"}).status, 0);
  const Json report = Json::parse(contents(path));
  EXPECT_EQ(report["input"]["representation"], "point cloud");
  EXPECT_EQ(report["input"]["points"], 800);
  const Json& layer = report["layers"].at(0);
  EXPECT_EQ(layer["method"], "graph");
  EXPECT_EQ(layer["status"], "converged");
  EXPECT_GT(layer["iterations"], 0);
  EXPECT_GT(layer["unknowns"], 0);
  EXPECT_LE(layer["nodes"], 60);
  EXPECT_GT(layer["edges"], 0);
  for (const char* name : {"total", "rotation", "regularization", "constraint"})
    EXPECT_GE(layer["energy"].at(name), 0) << name;
  EXPECT_GT(layer["handle_error"]["max"], 0);
  EXPECT_LT(layer["handle_error"]["rms"], 0.01);
  ASSERT_GE(layer["handles"].size(), 1u);
  double worst = 0;
  for (const Json& handle : layer["handles"]) {
    EXPECT_GT(handle["points"], 0);
    EXPECT_LE(handle["rms"], handle["max"]);
    worst = std::max(worst, handle["max"].get<double>());
  }
  EXPECT_EQ(worst, layer["handle_error"]["max"]);
  for (const char* name : {"build", "bind", "prefactor", "solve", "per_iteration", "skin"})
    EXPECT_GE(layer["seconds"].at(name), 0) << name;
  for (const char* name : {"read", "write", "total"}) EXPECT_GT(report["seconds"].at(name), 0) << name;
}

TEST_F(Sinew, OnlyPositionsAndNormalsChange) {
  ASSERT_EQ(run_sinew({"deform", scan, "--edit", edit, "-o", out}).status, 0);
  const Json diff = Json::parse(run_sinew({"diff", scan, out, "--json"}).out);
  EXPECT_GT(diff["moved"], 500);
  EXPECT_LT(diff["moved"], 800);  // the fixed points have not
  EXPECT_GT(diff["distance"]["max"], 1);
  EXPECT_LE(diff["distance"]["rms"], diff["distance"]["max"]);
  EXPECT_EQ(diff["attributes"]["normal"]["state"], "changed");
  EXPECT_EQ(diff["attributes"]["intensity"]["state"], "equal");
  EXPECT_EQ(diff["faces"], "equal");
  EXPECT_EQ(diff["rest"], "equal");
}

TEST_F(Sinew, DiffSeesWhatIsPlanted) {
  const auto diff_with = [&](std::string from, const std::string& to) {
    std::string text = sheet_ply();
    const std::size_t at = text.find(from);
    save(out, text.replace(at, from.size(), to));
    return Json::parse(run_sinew({"diff", scan, out, "--json"}).out);
  };
  EXPECT_EQ(diff_with("kept as", "lost as")["rest"], "changed");
  EXPECT_EQ(diff_with("0.100000 0.000000", "0.100001 0.000000")["moved"], 1);
  EXPECT_EQ(diff_with("0 0 1 0\n", "0 0 1 7\n")["attributes"]["intensity"]["rows"], 1);
  const Json renamed = diff_with("uchar intensity", "uchar confidence");
  EXPECT_EQ(renamed["attributes"]["intensity"]["state"], "missing");
  EXPECT_EQ(renamed["attributes"]["confidence"]["state"], "added");
  EXPECT_EQ(diff_with("uchar intensity", "ushort intensity")["attributes"]["intensity"]["what"], "type");
  const Json same = diff_with("ply", "ply");
  EXPECT_EQ(same["moved"], 0);
  EXPECT_EQ(same["rest"], "equal");
  save(folder / "mesh.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n");
  save(folder / "other.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 3\n");
  EXPECT_EQ(Json::parse(run_sinew({"diff", "--json", folder / "mesh.off", folder / "other.off"}).out)["faces"],
            "changed");
  EXPECT_EQ(Json::parse(run_sinew({"diff", "--json", folder / "mesh.off", scan}).out)["points"], Json({4, 800}));
}

TEST_F(Sinew, AScanSetIsBentAsOneAndWrittenMergedOrAsOneFileAScan) {
  save(folder / "b.ply", sheet_ply());
  save(folder / "set.conf", "bmesh scan.ply 0 0 0 0 0 0 1\nbmesh b.ply 0 3 0 0 0 0 1\n");
  ASSERT_EQ(run_sinew({"deform", folder / "set.conf", "--edit", edit, "-o", out}).status, 0);
  EXPECT_EQ(io::read(out)->size(), 1600u);
  const Outcome parts = run_sinew({"deform", folder / "set.conf", "--edit", edit, "-o", folder / "bent/"});
  ASSERT_EQ(parts.status, 0) << parts.err;
  EXPECT_EQ(io::read(folder / "bent/scan.ply")->size(), 800u);
  EXPECT_EQ(contents(folder / "bent/b.ply").substr(0, 200), sheet_ply().substr(0, 200));
  EXPECT_EQ(run_sinew({"deform", folder / "set.conf", "--edit", edit, "-o", folder / "bent/"}).status, 1);
}

TEST_F(Sinew, StrictTellsWhatDidNotConverge) {
  // Fifty times the sheet's length away and turned around: more than the solver's iterations reach.
  std::string far = turn_edit();
  far.replace(far.find("-50"), 3, "170");
  far.replace(far.find("} } ] } ] }"), 1, "}, \"move\": [200, 0, 0] ");
  save(edit, far);
  const std::vector<std::string> loose = {"deform", scan, "--edit", edit, "-o", out, "--force"};
  std::vector<std::string> strict = loose;
  strict.push_back("--strict");
  EXPECT_EQ(run_sinew(loose).status, 0);
  const Outcome outcome = run_sinew(strict);
  EXPECT_EQ(outcome.status, 4);
  EXPECT_TRUE(outcome.err.starts_with("sinew: layer 1: expected a solve that converges, found ")) << outcome.err;
  save(edit, turn_edit());
  EXPECT_EQ(run_sinew(strict).status, 0);
}

TEST_F(Sinew, AFailedSolveIsStatus1AndWritesNothing) {
  const Outcome outcome = run_sinew({"deform", scan, "--edit", edit, "-o", out, "--set", "rotation=0", "--set",
                                     "regularization=0", "--set", "constraint=0"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(outcome.err.starts_with("sinew: layer 1: ")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Sinew, SettingsFromTheCommandLine) {
  ASSERT_EQ(run_sinew({"deform", scan, "--edit", edit, "-o", out}).status, 0);
  ASSERT_EQ(run_sinew({"deform", scan, "--edit", edit, "-o", folder / "b.ply", "--set", "nodes=30"}).status, 0);
  EXPECT_NE(contents(out), contents(folder / "b.ply"));
  const Outcome bad = run_sinew({"deform", scan, "--edit", edit, "-o", folder / "c.ply", "--set", "nodes=0"});
  EXPECT_EQ(bad.status, 3);
  EXPECT_TRUE(bad.err.starts_with("sinew: --set nodes=0: expected a whole number from 1 to ")) << bad.err;
}

TEST_F(Sinew, ListsAreTheTables) {
  const Outcome text = run_sinew({"methods"});
  const Json list = Json::parse(run_sinew({"methods", "--json"}).out);
  ASSERT_EQ(list.size(), methods().size());
  for (std::size_t m = 0; m < list.size(); ++m)
    for (std::size_t s = 0; s < methods()[m].settings.size(); ++s) {
      EXPECT_EQ(list[m]["settings"][s]["standard"], methods()[m].settings[s].standard);
      EXPECT_NE(text.out.find(methods()[m].settings[s].help), std::string::npos);
    }
  const Outcome rows = run_sinew({"formats"});
  EXPECT_EQ(static_cast<std::size_t>(std::count(rows.out.begin(), rows.out.end(), '\n')),
            io::formats().size() + io::motion_formats().size());
}

}  // namespace sinew
