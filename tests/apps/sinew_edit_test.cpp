/// Every mistake in an edit, through the program: its sentence, its status, and nothing written.

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/document/input_hash.h"
#include "tests/apps/program.h"
#include "tests/apps/sinew_fixtures.h"
#include "tests/document/bad_edits.h"
#include "tests/io/temporary_folder.h"

namespace sinew {

namespace {

/// Mistakes that show only beside the table of methods, the shape or other files; @ as in bad_edits().
std::vector<std::pair<std::string, std::string>> mistakes_of_meaning() {
  using document::handle_with;
  using document::layer_with;
  const std::string move = ", \"move\": [0, 0, 1]}";
  return {
      {"{\"sinew\": 1, \"layers\": [@{\"method\": \"bone\"}]}",
       "expected a method, one of \"graph\", \"tet\", \"shell\", found \"bone\""},
      {layer_with("\"settings\": {\"nodes\": @-5}"),
       "expected a whole number from 1 to 100000 for \"nodes\", found -5"},
      {layer_with("\"settings\": {\"nodes\": @2.5}"),
       "expected a whole number from 1 to 100000 for \"nodes\", found 2.5"},
      {layer_with("\"settings\": {\"sampling\": @\"best\"}"),
       "expected one of \"radius\", \"simplify\" for \"sampling\", found \"best\""},
      {layer_with("\"fixed\": [@{\"indices\": [0, 800]}]"),
       "expected indices below 800, the number of points, found 800"},
      {layer_with("\"fixed\": [@{\"component\": 1}]"), "expected a component below 1, found 1"},
      {layer_with("\"fixed\": [@{\"box\": [[10, 10, 10], [11, 11, 11]]}]"),
       "expected a selection of at least one point, found none"},
      {layer_with("\"fixed\": [@{\"sphere\": {\"center\": [9, 9, 9], \"radius\": 1}}]"),
       "expected a selection of at least one point, found none"},
      {layer_with("\"fixed\": [@{\"labels\": \"labels.sel\", \"value\": 5}]"),
       "expected a selection of at least one point, found none"},
      {handle_with("{\"points\": @{\"indices\": [900]}" + move),
       "expected indices below 800, the number of points, found 900"},
      {handle_with("@{\"points\": {\"indices\": [1, 2]}, \"to\": [[0, 0, 0]]}"),
       "expected 2 targets in \"to\", one a point, found 1"},
      {handle_with("{\"points\": @{\"indices\": [1, 1]}, \"to\": [[0, 0, 0], [0, 0, 0]]}"),
       "expected each index once, because \"to\" has a target for each, found 1 again"},
      {handle_with("{\"points\": {\"indices\": [1, 2]}" + move + ", @{\"points\": {\"indices\": [2, 3]}" + move),
       "expected points of this handle alone, found point 2, which is also one of handle 1"},
      {"{\"sinew\": 1, \"layers\": [@{\"method\": \"graph\", \"rigid\": [{\"all\": true}]}]}",
       "expected no \"rigid\" for method graph, found 1"},
      {"{\"sinew\": 1, \"layers\": [@{\"method\": \"graph\", \"stiffness\": [{\"points\": {\"all\": true}, \"factor\": "
       "2}]}]}",
       "expected no \"stiffness\" for method graph, found 1"},
      {"{\"sinew\": 1, \"layers\": [@{\"method\": \"graph\", \"examples\": [\"a.obj\"]}]}",
       "expected no \"examples\" for method graph, found 1"},
      {"{\"sinew\": 1, \"layers\": [@{\"method\": \"tet\", \"cuts\": [{\"path\": [[0, 0, 0], [1, 0, 0]], \"depth\": "
       "[0, "
       "0, 1]}]}]}",
       "expected no \"cuts\" for method tet, found 1"},
      {"{\"sinew\": 1, \"layers\": [@{\"method\": \"tet\", \"path\": {\"every\": 2}}]}",
       "expected no \"path\" for method tet, found 1"},
      {"{\"sinew\": 1, \"layers\": [@{\"method\": \"tet\", \"nodes\": [{\"indices\": [0]}]}]}",
       "expected no \"nodes\" for method tet, found 1"},
  };
}

}  // namespace

TEST(SinewEdit, EachMistakeHasItsSentenceAndStatus3) {
  const TemporaryFolder folder;
  const std::string scan = folder / "scan.ply", edit = folder / "edit.json", out = folder / "out.ply";
  save(scan, sheet_ply());
  std::string labels;
  for (int i = 0; i < 800; ++i) labels += "1\n";
  save(folder / "labels.sel", labels);
  std::vector<std::pair<std::string, std::string>> cases = document::bad_edits();
  const auto more = mistakes_of_meaning();
  cases.insert(cases.end(), more.begin(), more.end());
  EXPECT_GE(cases.size(), 50u);
  for (const auto& [marked, sentence] : cases) {
    const document::MarkedText text(marked);
    save(edit, text.text);
    const Outcome outcome = run_sinew({"deform", scan, "--edit", edit, "-o", out});
    EXPECT_EQ(outcome.status, 3) << text.text;
    EXPECT_EQ(outcome.err, "sinew: " + edit + ":" + text.place + ": " + sentence + "\n") << text.text;
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

TEST(SinewEdit, FilesThatAnEditNamesHaveTheirOwnSentences) {
  const TemporaryFolder folder;
  save(folder / "scan.ply", sheet_ply());
  save(folder / "labels.sel", "# too few\n1\n2\n");
  const auto message = [&](const std::string& labels) {
    save(folder / "edit.json", document::layer_with("\"fixed\": [{\"labels\": \"" + labels + "\", \"value\": 1}]"));
    return run_sinew({"deform", folder / "scan.ply", "--edit", folder / "edit.json", "-o", folder / "out.ply"}).err;
  };
  EXPECT_EQ(message("labels.sel"),
            "sinew: " + (folder / "labels.sel") + ": expected 800 labels, one a point, found 2\n");
  EXPECT_EQ(message("none.sel"), "sinew: " + (folder / "none.sel") +
                                     ": expected a file that can be read, found \"No such file or directory\"\n");
}

TEST(SinewDeform, AnInputThatIsNotTheOneOfTheEditIsTold) {
  const TemporaryFolder folder;
  const std::string in = folder / "in.xyz", edit = folder / "edit.json", out = folder / "out.xyz";
  std::string points;
  for (int i = 0; i < 100; ++i) points += std::to_string(i % 10) + " " + std::to_string(i / 10) + " 0\n";
  save(in, points);
  const auto save_edit = [&](const std::string& hash) {
    save(edit, "{\"sinew\": 1, \"inputs\": [\"in.xyz\"], \"input_hashes\": [\"" + hash +
                   "\"], \"layers\": [{\"method\": \"graph\", \"handles\": [{\"points\": {\"indices\": [0]}, "
                   "\"move\": [0, 0, 1]}], \"fixed\": [{\"indices\": [99]}]}]}");
  };
  save_edit(document::input_hash(in));
  Outcome outcome = run_sinew({"deform", in, "--edit", edit, "-o", out});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
  const std::string bent = contents(out);
  save_edit("sha256:" + std::string(64, '0'));
  outcome = run_sinew({"deform", in, "--edit", edit, "-o", out, "--force"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(outcome.err.ends_with("sinew: warning: " + document::sentence_of_other_input(in) + "\n")) << outcome.err;
  EXPECT_EQ(contents(out), bent);
}

}  // namespace sinew
