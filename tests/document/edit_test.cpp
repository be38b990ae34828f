#include "engine/document/edit.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sinew::document {

namespace {

const char* const everything = R"({
  "sinew": 1,
  "inputs": ["scan.ply"],
  "layers": [ {
    "name": "Neck", "off": true,
    "method": "graph",
    "settings": { "nodes": 250, "sampling": "simplify" },
    "nodes": [ { "component": 3 } ],
    "fixed":   [ { "all": true }, { "box": [[0, 0, 0], [1, 2, 3]] } ],
    "handles": [ { "points": { "indices": [3, 1, 2] }, "move": [0, 0, 0.5] },
                 { "points": { "sphere": { "center": [1, 2, 3], "radius": 0.25 } },
                   "rotate": { "axis": [0, 0, 1], "degrees": 135, "about": [0, 0.1, 0] }, "move": [1e-300, 0.1, -3e20] },
                 { "points": { "nearest": [1, 1, 1] }, "matrix": [[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]] },
                 { "points": { "labels": "bar.sel", "value": -2 }, "to": [[1, 2, 3]] } ],
    "rigid":   [ { "component": 0 } ],
    "stiffness": [ { "points": { "all": true }, "factor": 10 } ],
    "examples": [ "poses/a.obj", "../b.obj", "/c.obj" ],
    "keys": [ { "frame": 1, "handles": [ { "move": [0, 0, 0] } ] }, { "frame": 24, "handles": [ { "move": [0, 0, 0.5] } ] } ],
    "start": [ [1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, 0.3] ]
  }, { "method": "graph" } ]
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

TEST(Edit, AChangedFieldIsNoticed) {
  const Project project = parse_edit("e.json", everything);
  Project other = project;
  other.layers[0].handles[1].motion.rotate->degrees = 136;
  EXPECT_NE(project, other);
}

/// In the layer and the handle of the sentences below.
std::string layer(const std::string& members) {
  return "{\"sinew\": 1, \"layers\": [{\"method\": \"graph\", " + members + "}]}";
}
std::string handle(const std::string& members) {
  return layer("\"handles\": [" + members + "]");
}

std::string message_of(const std::string& text) {
  try {
    parse_edit("e.json", text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// "expected ..., found ..." of a text in which @ stands before the place that the message must name.
std::string mistake_of(std::string text) {
  const std::size_t at = text.find('@');
  text.erase(at, 1);
  const std::string before = text.substr(0, at), message = message_of(text);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::string place =
      "e.json:" + std::to_string(line) + ":" + std::to_string(at - (before.rfind('\n') + 1) + 1) + ": ";
  return message.starts_with(place) ? message.substr(place.size()) : message + " instead of " + place;
}

TEST(Edit, EachMistakeHasItsSentence) {
  const std::string points = "{\"points\": {\"all\": true}, ";
  const std::pair<std::string, std::string> cases[] = {
      {"@", "expected a value, found the end of the text"},
      {"{@", "expected a text, found the end of the text"},
      {"{\"sinew\": 1,\n  \"layers\": [@}", "expected a value, found '}'"},
      {"{\"sinew\": 1 @\"layers\": []}", "expected '}', found a text"},
      {"{\"sinew\": 0@1}", "expected '}', found a number"},
      {"{\"sinew\": @nan}", "expected JSON, found invalid literal"},
      {"{\"sinew\": @1e999, \"layers\": []}", "expected a number that fits a double, found \"1e999\""},
      {"@[]", "expected an object, found an array of 0"},
      {"@{}", "expected \"sinew\", \"layers\", found an object without members"},
      {"{\"sinew\": @2, \"layers\": []}", "expected version 1 of the format, found 2"},
      {"{\"sinew\": @\"1\", \"layers\": []}", "expected a whole number from -2147483648 to 2147483647, found \"1\""},
      {"{\"sinew\": 1, \"layers\": @{}}", "expected an array, found an object"},
      {"{\"sinew\": 1, \"layers\": [], @\"layers\": []}", "expected each name once, found \"layers\" again"},
      {"{\"sinew\": 1, @\"layer\": []}", "expected one of \"sinew\", \"inputs\", \"layers\", found \"layer\""},
      {"{\"sinew\": 1, \"layers\": [@{}]}", "expected \"method\", found an object without members"},
      {"{\"sinew\": 1, \"layers\": [{\"method\": @3}]}", "expected a text, found 3"},
      {layer("@\"setings\": {}"),
       "expected one of \"name\", \"off\", \"method\", \"settings\", \"nodes\", \"fixed\", \"handles\", \"rigid\", "
       "\"stiffness\", \"examples\", \"keys\", \"start\", found \"setings\""},
      {layer("\"settings\": {\"nodes\": @true}"), "expected a number or a text, found true"},
      {layer("\"off\": @1"), "expected true or false, found 1"},
      {layer("\"fixed\": @{\"all\": true}"), "expected an array, found an object"},
      {layer("\"fixed\": [@{}]"),
       "expected a selection, one of \"all\", \"indices\", \"box\", \"sphere\", \"nearest\", \"component\", "
       "\"labels\", found an object without members"},
      {layer("\"fixed\": [@{\"boxes\": 1}]"),
       "expected a selection, one of \"all\", \"indices\", \"box\", \"sphere\", \"nearest\", \"component\", "
       "\"labels\", found \"boxes\""},
      {layer("\"fixed\": [@{\"all\": true, \"component\": 1}]"),
       "expected a selection, one of \"all\", \"indices\", \"box\", \"sphere\", \"nearest\", \"component\", "
       "\"labels\", found \"all\" and \"component\""},
      {layer("\"fixed\": [{\"all\": @false}]"), "expected true, found false"},
      {layer("\"fixed\": [{\"indices\": [0, @-1]}]"), "expected a whole number from 0 to 4294967294, found -1"},
      {layer("\"fixed\": [{\"indices\": [@1.5]}]"), "expected a whole number from 0 to 4294967294, found 1.5"},
      {layer("\"fixed\": [{\"indices\": @3}]"), "expected an array, found 3"},
      {layer("\"fixed\": [{\"box\": @[[0,0,0]]}]"), "expected 2 corners [min, max], found an array of 1"},
      {layer("\"fixed\": [{\"box\": [[0,0,0],@[1,1]]}]"), "expected 3 numbers [x, y, z], found an array of 2"},
      {layer("\"fixed\": [{\"box\": @[[0,0,2],[1,1,1]]}]"),
       "expected a box whose min is nowhere above its max, found one that is"},
      {layer("\"fixed\": [{\"sphere\": @{\"center\": [0,0,0]}}]"), "expected \"radius\", found only \"center\""},
      {layer("\"fixed\": [{\"sphere\": {\"center\": [0,0,0], \"radius\": @-1}}]"),
       "expected a number of at least 0, found -1"},
      {layer("\"fixed\": [{\"nearest\": [0, @\"a\", 0]}]"), "expected a number, found \"a\""},
      {layer("\"fixed\": [@{\"labels\": \"a.sel\"}]"), "expected \"value\", found only \"labels\""},
      {handle("@{\"move\": [0,0,0]}"), "expected \"points\", found only \"move\""},
      {handle("@{\"points\": {\"all\": true}}"),
       "expected a motion: \"move\", \"rotate\", \"matrix\" or \"to\", found none"},
      {handle(points + "\"to\": @[[0,0,0]], \"move\": [0,0,0]}"),
       "expected \"to\" alone, found another motion beside it"},
      {handle(points + "\"to\": @[]}"), "expected at least one target, found none"},
      {handle(points + "\"rotate\": {\"axis\": @[0,0,0], \"degrees\": 1}}"),
       "expected an axis of a length above 0, found [0, 0, 0]"},
      {handle(points + "\"matrix\": @[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]}"),
       "expected a last row of [0, 0, 0, 1], found another"},
      {handle(points + "\"matrix\": [@1,0,0,0]}"), "expected 4 numbers, a row of the matrix, found 1"},
      {layer("\"stiffness\": [{\"points\": {\"all\": true}, \"factor\": @0}]"), "expected a number above 0, found 0"},
      {layer("\"examples\": [@3]"), "expected a text, found 3"},
      {layer("\"keys\": [{\"frame\": @1.5, \"handles\": []}]"),
       "expected a whole number from -2147483648 to 2147483647, found 1.5"},
      {layer("\"start\": [@[1,2,3]]"), "expected 12 numbers, a 3x4 matrix row by row, found an array of 3"},
  };
  for (const auto& [text, sentence] : cases) EXPECT_EQ(mistake_of(text), sentence) << text;
  EXPECT_GE(std::size(cases), 40u);
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
