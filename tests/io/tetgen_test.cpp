#include "engine/io/tetgen.h"

#include <gtest/gtest.h>

#include "engine/io/obj.h"
#include "engine/io/text_patch.h"
#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {
namespace {

const char* const node =
    "# points\r\n4 3 2 1 # header\n\n0 0.50 0 0 1.50 2 7 # first\n1 1 0 0 0.1 2 -1\n 2 0 1 0 3 4 0\n3 0 0 1 5 6 0";
const char* const ele = "1 4 1\n0 0 1 2 3 9\n# end\n";
const char* const face = "2 1\n0 0 1 2 4\n1 0 1 3 0\n";
const char* const plain = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";

/// A folder with NAME.node and, where they are not empty, NAME.ele and NAME.face.
class Files {
 public:
  Files(std::string_view points, std::string_view tets, std::string_view faces = "") {
    save("a.node", points);
    save("a.ele", tets);
    save("a.face", faces);
  }
  void save(const std::string& name, std::string_view text) {
    if (!text.empty()) save_bytes(folder_ / name, bytes_of(text), true);
  }
  std::string operator/(const std::string& name) const { return folder_ / name; }
  /// The refusal of a file, without the folder.
  std::string refusal(const std::string& name) const {
    std::string sentence = sentence_of([&] { read(folder_ / name); });
    const std::string prefix = folder_ / "";
    for (std::size_t at = sentence.find(prefix); at != std::string::npos; at = sentence.find(prefix))
      sentence.erase(at, prefix.size());
    return sentence;
  }

 private:
  TemporaryFolder folder_;
};

TEST(Tetgen, EachFileFindsTheOthers) {
  const Files files(node, ele, face);
  for (const char* name : {"a.node", "a.ele"}) {
    const auto shape = read(files / name);
    expect_sound(*shape, name);
    ASSERT_EQ(shape->size(), 4u);
    EXPECT_EQ(shape->positions[0], Vec3(0.5, 0, 0));
    EXPECT_EQ(shape->tets, (std::vector<Tet>{{0, 1, 2, 3}}));
    EXPECT_EQ(shape->faces.points, (std::vector<Index>{0, 1, 2, 0, 1, 3}));
    ASSERT_TRUE(shape->find("attribute 1") && shape->find("attribute 2") && shape->find("label"));
    EXPECT_EQ(shape->find("attribute 1")->number(0, 0), 1.5);
    EXPECT_EQ(shape->find("attribute 2")->number(3, 0), 6);
    EXPECT_EQ(shape->find("label")->number(1, 0), -1);
    EXPECT_EQ(shape->notes, (std::vector<std::string>{"Kept in the .ele file only: attributes of tets.",
                                                      "Kept in the .face file only: boundary markers of faces."}));
  }
}

TEST(Tetgen, NodesAloneAreAPointCloud) {
  const Files files("2\n1 1 2 3\n2 4 5 6\n", "");
  const auto shape = read(files / "a.node");
  EXPECT_STREQ(representation(*shape), "point cloud");
  EXPECT_EQ(shape->positions[1] + shape->origin, Vec3(4, 5, 6));
  write(files / "b.node", *shape);
  EXPECT_EQ(text_of_file(files / "b.node"), text_of_file(files / "a.node"));
  EXPECT_FALSE(std::filesystem::exists(files / "b.ele"));
}

TEST(Tetgen, GivesTheSameFilesBack) {
  const Files files(node, ele, face);
  for (const char* name : {"b.node", "c.ele"}) {
    const auto shape = read(files / "a.ele");
    EXPECT_TRUE(write(files / name, *shape).lost.empty());
    const std::string stem(1, name[0]);
    for (const char* extension : {".node", ".ele", ".face"})
      EXPECT_EQ(text_of_file(files / (stem + extension)), text_of_file(files / (std::string("a") + extension))) << name;
  }
}

TEST(Tetgen, WritesNothingWhereOneOfTheFilesIsThere) {
  const Files files(node, ele);
  const auto shape = read(files / "a.node");
  save_bytes(files / "b.ele", bytes_of("old"), false);
  EXPECT_EQ(sentence_of([&] { write(files / "b.node", *shape); }),
            (files / "b.ele") + ": expected the name of a new file, found an existing one (--force replaces it)");
  EXPECT_FALSE(std::filesystem::exists(files / "b.node"));
  write(files / "b.node", *shape, true);
  EXPECT_EQ(text_of_file(files / "b.ele"), ele);
  EXPECT_EQ(sentence_of([&] { write("-", *shape, false, "node"); }),
            "-: expected a name for the 2 files of TetGen nodes, found standard output");
}

TEST(Tetgen, ReplacesOnlyTokensThatChanged) {
  const Files files(node, ele, face);
  Shape shape = *read(files / "a.node");
  shape.positions[0].x() = 0.75;
  shape.positions[3].z() = 1e-5;
  shape.find("attribute 1")->set_number(1, 0, 0.2);
  shape.find("label")->set_number(2, 0, 100000);
  write(files / "b.ele", shape);
  std::string expected = node;
  for (const auto& [old, now] : {std::pair<std::string, std::string>{"0.50 ", "0.75 "},
                                 {"0 0 1 5", "0 0 1e-05 5"},
                                 {"0.1 2", "0.2 2"},
                                 {"3 4 0", "3 4 100000"}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(text_of_file(files / "b.node"), expected);
  EXPECT_EQ(text_of_file(files / "b.ele"), ele);
}

TEST(Tetgen, SecondOrderTetsHaveTheirCornersRead) {
  const Files files("5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0.5 0 0\n", "1 10\n1 1 2 3 4 5 5 5 5 5 5\n");
  const auto shape = read(files / "a.ele");
  EXPECT_EQ(shape->tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(shape->notes, std::vector<std::string>{"Kept in the .ele file only: the points in the middle of edges."});
}

TEST(Tetgen, RefusesInOneSentence) {
  struct Case {
    const char *node, *ele, *face, *sentence;
  };
  const Case cases[] = {
      {"2 2 0 0\n1 0 0\n2 1 1\n", "", "", "a.node:1:3: expected the dimension 3, found \"2\""},
      {"x\n", "", "", "a.node:1:1: expected the count of points, found \"x\""},
      {"4294967290 3\n1 0 0 0\n", "", "",
       "a.node:1:1: expected a count of points that fits into the 11 bytes left, found \"4294967290\""},
      {"1 3 99999999 0\n1 0 0 0\n", "", "",
       "a.node:1: expected a count of attributes that fits into the file, found 99999999"},
      {"1 3 -1 0\n1 0 0 0\n", "", "", "a.node:1:5: expected the count of attributes, found \"-1\""},
      {"1 3 0 0\n2 0 0 0\n", "", "", "a.node:2:1: expected the number 0 or 1 of point 1 of 1, found \"2\""},
      {"2 3 0 0\n1 0 0 0\n3 0 0 0\n", "", "", "a.node:3:1: expected the number 2 of point 2 of 2, found \"3\""},
      {"2 3 0 0\n1 0 0 0\n2 0 0   \n", "", "",
       "a.node:4:1: expected a number of point 2 of 2, found the end of the file"},
      {"1 3 0 0\n1 0 0 zero\n", "", "", "a.node:2:7: expected a number of point 1 of 1, found \"zero\""},
      {"1 3 1 0\n1 0 0 0 a\n", "", "", "a.node:2:9: expected a number of point 1 of 1, found \"a\""},
      {"1 3 0 1\n1 0 0 0 0.5\n", "", "",
       "a.node:2:9: expected the boundary marker (a whole number of 32 bits) of point 1 of 1, found \"0.5\""},
      {plain, "1 5 0\n1 1 2 3 4 4\n", "", "a.ele:1:3: expected 4 or 10 points a tet, found \"5\""},
      {plain, "1 4 0\n1 1 2 3 5\n", "", "a.ele:2:9: expected the index of a point (1 to 4) in tet 1 of 1, found \"5\""},
      {plain, "1 4 0\n1 0 2 3 4\n", "", "a.ele:2:3: expected the index of a point (1 to 4) in tet 1 of 1, found \"0\""},
      {plain, "1 4 0\n1 1 2 3 3\n", "", "a.ele:2:9: expected four different points in tet 1 of 1, found \"3\""},
      {plain, "2 4 0\n1 1 2 3 4\n3 1 2 3 4\n", "", "a.ele:3:1: expected the number 2 of tet 2 of 2, found \"3\""},
      {plain, "99 4 0\n1 1 2 3 4\n", "",
       "a.ele:1:1: expected a count of tets that fits into the 15 bytes left, found \"99\""},
      {plain, "1 4 0\n1 1 2 3 4\n", "1 0\n1 1 2 9\n",
       "a.face:2:7: expected the index of a point (1 to 4) in face 1 of 1, found \"9\""},
  };
  for (const Case& c : cases) {
    const Files files(c.node, c.ele, c.face);
    EXPECT_EQ(files.refusal("a.node"), c.sentence) << c.node << c.ele << c.face;
  }
  const TemporaryFolder folder;
  save_bytes(folder / "a.ele", bytes_of(ele), false);
  EXPECT_EQ(sentence_of([&] { read(folder / "a.ele"); }),
            (folder / "a.node") + ": expected the points of " + (folder / "a.ele") + ", found no such file");
}

TEST(Tetgen, WritesWhatAnotherFormatHeld) {
  Shape shape = read_text(read_obj, "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 0.1 1 1 1\nf 1 2 3 4\n");
  shape.tets = {{0, 1, 2, 3}};
  shape.attributes.push_back(
      number_attribute("label", {"label"}, Kind::Id, Type::UInt8, std::vector<double>{1, 2, 3, 4}));
  const TemporaryFolder folder;
  EXPECT_EQ(write(folder / "a.ele", shape).lost,
            (std::vector<std::string>{"TetGen cannot hold the name of the attribute \"color\": it is attribute 1 to 3.",
                                      "TetGen cannot hold 1 face of more than 3 corners: cut into triangles."}));
  EXPECT_EQ(text_of_file(folder / "a.node"),
            "4 3 3 1\n1 0 0 0 1 0 0 1\n2 1 0 0 0 1 0 2\n3 0 1 0 0 0 1 3\n4 0 0 0.1 1 1 1 4\n");
  EXPECT_EQ(text_of_file(folder / "a.ele"), "1 4 0\n1 1 2 3 4\n");
  EXPECT_EQ(text_of_file(folder / "a.face"), "2 0\n1 1 2 3\n2 1 3 4\n");
  const auto again = read(folder / "a.node");
  EXPECT_EQ(again->tets, shape.tets);
  EXPECT_EQ(again->find("label")->number(3, 0), 4);
  EXPECT_EQ(again->find("attribute 2")->number(1, 0), 1);
}

TEST(Tetgen, AScanOfASetBringsItsFiles) {
  const Files files(plain, "1 4 0\n1 1 2 3 4\n");
  save_bytes(files / "b.ply",
             bytes_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                      "property float z\nend_header\n1 2 3\n"),
             false);
  save_bytes(files / "s.conf", bytes_of("bmesh b.ply 0 0 0 0 0 0 1\nbmesh a.node 1 0 0 0 0 0 1\n"), false);
  const auto set = read(files / "s.conf");
  EXPECT_EQ(set->tets, (std::vector<Tet>{{1, 2, 3, 4}}));
  write_parts(files / "out", *set);
  for (const char* name : {"a.node", "a.ele", "b.ply", "s.conf"})
    EXPECT_EQ(text_of_file(files / (std::string("out/") + name)), text_of_file(files / name)) << name;
}

TEST(Tetgen, RealFilesComeBackExactly) {
  SHARED_DATA(folder, "tets");
  const std::string path = (folder / "armadillo_4k.node").string();
  expect_exact(read_node, write_node, path);
  const auto shape = read((folder / "armadillo_4k.ele").string());
  EXPECT_EQ(shape->size(), 1180u);
  EXPECT_EQ(shape->tets.size(), 3717u);
  EXPECT_EQ(shape->position_type, Type::Float64);
  WriteReport report;
  EXPECT_TRUE(text_of(write_ele("x.ele", *shape, report)) == text_of_file((folder / "armadillo_4k.ele").string()));
  Shape fresh = *shape;
  fresh.content = nullptr;
  const TemporaryFolder out;
  write(out / "a.node", fresh);
  const auto again = read(out / "a.ele");
  EXPECT_EQ(again->tets, shape->tets);
  EXPECT_EQ(again->positions, shape->positions);
}

}  // namespace
}  // namespace sinew::io
