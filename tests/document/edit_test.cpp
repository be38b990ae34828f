#include "engine/document/edit.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/document/input_hash.h"
#include "engine/io/sha256.h"
#include "tests/document/bad_edits.h"

namespace sinew::document {

namespace {

const char* const everything = R"({
  "sinew": 1,
  "inputs": ["scan.ply"],
  "layers": [ {
    "name": "Neck", "off": true,
    "method": "graph",
    "settings": { "nodes": 250, "sampling": "simplify" },
    "frame": 3,
    "path": { "id": 17, "every": 4 },
    "cuts": [ { "path": [[0, 0, 0], [1, 0, 0.5]], "depth": [0, 0, 2] } ],
    "nodes": [ { "component": 3, "frame": 7 } ],
    "fixed":   [ { "all": true }, { "box": [[0, 0, 0], [1, 2, 3]] } ],
    "handles": [ { "points": { "indices": [3, 1, 2] }, "move": [0, 0, 0.5] },
                 { "points": { "sphere": { "center": [1, 2, 3], "radius": 0.25 } },
                   "rotate": { "axis": [0, 0, 1], "degrees": 135, "about": [0, 0.1, 0] }, "move": [1e-300, 0.1, -3e20] },
                 { "points": { "nearest": [1, 1, 1] }, "matrix": [[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]] },
                 { "points": { "labels": "bar.sel", "value": -2 }, "to": [[1, 2, 3]] } ],
    "rigid":   [ { "component": 0 } ],
    "stiffness": [ { "points": { "all": true }, "factor": 10 } ],
    "examples": [ "poses/a.obj", "../b.obj", "/c.obj" ],
    "keys": [ { "frame": 1, "handles": [ { "move": [0, 0, 0] } ] }, { "frame": 24, "handles": [ { "move": [0, 0, 0.5] } ],
                                                                    "interpolation": "smooth" } ],
    "start": [ [1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, 0.3] ]
  }, { "method": "graph" , "path": { "points": [[0, 0, 0], [0, 1, 0]] } } ]
})";

}  // namespace

TEST(Edit, EveryFieldOfTheSchemaIsRead) {
  const Project project = parse_edit("edits/e.json", everything);
  EXPECT_EQ(project.inputs, std::vector<std::string>{"edits/scan.ply"});
  ASSERT_EQ(project.layers.size(), 2u);
  const Layer& layer = project.layers[0];
  EXPECT_FALSE(layer.on);
  EXPECT_TRUE(project.layers[1].on);
  ASSERT_EQ(layer.settings.size(), 2u);
  EXPECT_EQ(std::get<double>(layer.settings[0].value), 250);
  EXPECT_EQ(std::get<std::string>(layer.settings[1].value), "simplify");
  EXPECT_EQ(layer.settings[0].place.text, "edits/e.json:7:28");
  EXPECT_EQ(layer.frame, 3);
  EXPECT_EQ(layer.path->id, 17);
  EXPECT_EQ(layer.path->every, 4);
  EXPECT_EQ(project.layers[1].path->points.get().size(), 2u);
  EXPECT_EQ(layer.cuts[0].path[1], Vec3(1, 0, 0.5));
  EXPECT_EQ(layer.cuts[0].depth, Vec3(0, 0, 2));
  EXPECT_EQ(layer.nodes[0].frame, 7);
  EXPECT_EQ(layer.keys[0].interpolation, Interpolation::Linear);
  EXPECT_EQ(layer.keys[1].interpolation, Interpolation::Smooth);
  EXPECT_EQ(std::get<SelectComponent>(layer.nodes[0].what).number, 3u);
  EXPECT_EQ(std::get<SelectBox>(layer.fixed[1].what).max, Vec3(1, 2, 3));
  ASSERT_EQ(layer.handles.size(), 4u);
  EXPECT_EQ(std::get<SelectIndices>(layer.handles[0].points.what).points.get(), (std::vector<Index>{3, 1, 2}));
  EXPECT_EQ(layer.handles[1].motion.rotate->degrees, 135);
  EXPECT_EQ(*layer.handles[1].motion.move, Vec3(1e-300, 0.1, -3e20));
  EXPECT_EQ((*layer.handles[2].motion.matrix)(0, 3), 5);
  EXPECT_EQ(std::get<SelectLabels>(layer.handles[3].points.what).path, "edits/bar.sel");
  EXPECT_EQ(std::get<SelectLabels>(layer.handles[3].points.what).value, -2);
  EXPECT_EQ(layer.examples, (std::vector<std::string>{"edits/poses/a.obj", "b.obj", "/c.obj"}));
  EXPECT_EQ(layer.keys[1].frame, 24);
  EXPECT_EQ(layer.start.get()[0](1, 3), 0.2);
  EXPECT_EQ(layer.stiffness[0].factor, 10);
}

TEST(Edit, AMatrixMayBeInAFile) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("sinew-edit-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* text) { std::ofstream(folder / "turn.def") << text; };
  const std::string edit =
      R"({"sinew": 1, "layers": [{"method": "tet", "handles": [{"points": {"all": true}, "matrix": "turn.def"}]}]})";
  write("# 4x4 handle transformation matrix\n0 -1 0 3\n1 0 0 0\n0 0 1 0\n0 0 0 1\n");
  const Project project = parse_edit((folder / "e.json").string(), edit);
  EXPECT_EQ((*project.layers[0].handles[0].motion.matrix)(0, 1), -1);
  EXPECT_EQ((*project.layers[0].handles[0].motion.matrix)(0, 3), 3);
  for (const auto& [text, sentence] :
       {std::pair("1 0 0", "16 finite numbers"), std::pair("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5", "the end of the file"),
        std::pair("1 0 0 x", "16 finite numbers"),
        std::pair("nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "16 finite numbers")}) {
    write(text);
    try {
      parse_edit((folder / "e.json").string(), edit);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
    }
  }
  std::filesystem::remove_all(folder);
}

TEST(Edit, WrittenAndReadBackItIsEqualAndWrittenAgainTheSameText) {
  const Project project = parse_edit("edits/e.json", everything);
  const std::string text = edit_text("edits/e.json", project);
  const Project again = parse_edit("edits/e.json", text);
  EXPECT_EQ(project, again);
  EXPECT_EQ(edit_text("edits/e.json", again), text);
}

TEST(Edit, PathsFollowTheFolderTheyAreSavedIn) {
  const Project project = parse_edit("edits/e.json", everything);
  const Project moved = parse_edit("elsewhere/deep/e.json", edit_text("elsewhere/deep/e.json", project));
  EXPECT_EQ(project, moved);
  EXPECT_NE(edit_text("elsewhere/deep/e.json", project).find("../../edits/scan.ply"), std::string::npos);
}

TEST(Edit, HashesOfTheInputsStandBesideThemAndAreNoPartOfTheEdit) {
  Project project = parse_edit("edits/e.json", everything);
  EXPECT_TRUE(project.hashes.of.empty());
  const Project without = project;
  project.hashes.of = {"sha256:" + std::string(64, '0')};
  EXPECT_EQ(project, without);
  const std::string text = edit_text("edits/e.json", project);
  EXPECT_NE(text.find("\"input_hashes\": [\"sha256:000"), std::string::npos) << text;
  EXPECT_EQ(parse_edit("edits/e.json", text).hashes.of, project.hashes.of);
}

TEST(Edit, AHashIsThatOfSha256sum) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("sinew-hash-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.0001.obj") << "abc";
  std::ofstream(folder / "a.0002.obj");
  const std::string one = input_hash((folder / "a.0001.obj").string());
  EXPECT_EQ(one, "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_TRUE(is_input_hash(one));
  const std::string lines = one.substr(7) + "  a.0001.obj\n" +
                            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855  a.0002.obj\n";
  EXPECT_EQ(input_hash((folder / "a.####.obj").string()),
            "sha256:" + io::hexadecimal(io::sha256(std::as_bytes(std::span(lines)))));
  EXPECT_EQ(input_hash((folder / "a.####.obj").string(), [] { return false; }), "");
  EXPECT_THROW(input_hash((folder / "b").string()), InputError);
  std::filesystem::remove_all(folder);
}

TEST(Edit, AChangedFieldIsNoticed) {
  const Project project = parse_edit("e.json", everything);
  Project other = project;
  other.layers[0].handles[1].motion.rotate->degrees = 136;
  EXPECT_NE(project, other);
}

std::string message_of(const std::string& text) {
  try {
    parse_edit("e.json", text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string mistake_of(const std::string& marked) {
  const MarkedText text(marked);
  const std::string message = message_of(text.text), place = "e.json:" + text.place + ": ";
  return message.starts_with(place) ? message.substr(place.size()) : message + " instead of " + place;
}

TEST(Edit, EachMistakeHasItsSentence) {
  for (const auto& [text, sentence] : bad_edits()) EXPECT_EQ(mistake_of(text), sentence) << text;
  EXPECT_GE(bad_edits().size(), 40u);
}

TEST(Edit, DeepNestingAndManyMembersAreRefused) {
  EXPECT_EQ(message_of(std::string(100000, '[')), "e.json:1:33: expected at most 32 levels of nesting, found more");
  std::string many = "{\"sinew\": 1";
  for (int i = 0; i < 2000; ++i) many += ", \"m" + std::to_string(i) + "\": 0";
  EXPECT_NE(message_of(many).find("expected at most 1000 members of an object, found more"), std::string::npos);
}

TEST(Edit, EveryCutOfAGoodFileIsRefused) {
  const std::string text = everything;
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_NE(message_of(text.substr(0, size)), "no error") << size;
}

}  // namespace sinew::document
