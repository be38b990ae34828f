#include "engine/document/pose_file.h"

#include <gtest/gtest.h>

#include "deformers/methods.h"
#include "tests/document/toy_method.h"

namespace sinew::document {

namespace {

std::string message_of(const std::string& text) {
  const Method methods[] = {toy_method()};
  try {
    PoseApplier(parse_solved_edit("p.json", text), methods, Vec3(0, 0, 0));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const std::string toy_table = R"("binding": [{"name": "toy", "columns": 1, "values": []}], )";
const std::string unit_map = "[1,0,0,0, 0,1,0,0, 0,0,1,0]";

std::string file_with(const std::string& layer) {
  return R"({"sinew_pose": 1, "origin": [0,0,0], "layers": [{"method": "toy", )" + layer + "}]}";
}

/// A bent sheet, its graph pose and the sheet itself.
struct Sheet {
  std::shared_ptr<Shape> rest = std::make_shared<Shape>();
  std::vector<Layer> layers;
  Evaluation evaluation;

  explicit Sheet(const Vec3& origin) {
    rest->origin = origin;
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 60; ++x) rest->positions.emplace_back(0.05 * x, 0.05 * y, 0.01 * ((x * 7 + y * 3) % 5));
    Layer layer;
    layer.settings = {{"nodes", 40.0, {}}};
    Selection left, right;
    left.what = SelectBox{origin + Vec3(-1, -1, -1), origin + Vec3(0.2, 2, 1)};
    right.what = SelectBox{origin + Vec3(2.8, -1, -1), origin + Vec3(4, 2, 1)};
    layer.fixed = {left};
    HandleEdit handle;
    handle.points = right;
    handle.motion.rotate = Rotation{Vec3(0, 1, 0), -40, origin + Vec3(1.5, 0, 0)};
    layer.handles = {handle};
    layers = {layer};
    evaluation = evaluate(rest, layers, methods());
  }
};

}  // namespace

TEST(PoseFile, NumbersComeBackBitForBit) {
  SolvedEdit edit;
  edit.origin = Vec3(5400000.1, 1e-300, -0.0);
  Affine map = identity_map();
  map(1, 2) = 0.1 + 0.2;
  map(2, 3) = -1.0 / 3;
  edit.layers = {{"toy", {{"a", 3, {1.0 / 7, 2e300, 3}}, {"b", 1, {}}}, {map, identity_map()}}};
  const std::string text = solved_edit_text(edit);
  const SolvedEdit back = parse_solved_edit("p.json", text);
  EXPECT_EQ(back.origin, edit.origin);
  ASSERT_EQ(back.layers.size(), 1u);
  EXPECT_EQ(back.layers[0].binding[0].values, edit.layers[0].binding[0].values);
  EXPECT_EQ(back.layers[0].binding[0].columns, 3);
  EXPECT_EQ(back.layers[0].maps, edit.layers[0].maps);
  EXPECT_EQ(solved_edit_text(back), text);
}

TEST(PoseFile, AppliedToItsOwnInputGivesTheSolvedPoints) {
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(5400000, 400000, 50)}) {
    const Sheet sheet(origin);
    const SolvedEdit edit = parse_solved_edit("p.json", solved_edit_text(solved_edit(sheet.evaluation, sheet.layers)));
    const Shape bent = PoseApplier(edit, methods(), origin).apply(*sheet.rest);
    EXPECT_EQ(bent.positions, sheet.evaluation.shape->positions);
    EXPECT_GT((bent.positions.back() - sheet.rest->positions.back()).norm(), 0.5);
  }
}

TEST(PoseFile, AFileWithAnotherOriginBendsToTheSamePlace) {
  const Vec3 origin(5400000, 400000, 50), shift(1024, -2048, 0);
  const Sheet sheet(origin);
  const SolvedEdit edit = solved_edit(sheet.evaluation, sheet.layers);
  Shape moved = *sheet.rest;
  moved.origin = origin + shift;
  for (Vec3& p : moved.positions) p -= shift;
  const Shape bent = PoseApplier(edit, methods(), moved.origin).apply(moved);
  double worst = 0;
  for (std::size_t i = 0; i < bent.size(); ++i)
    worst = std::max(worst, (bent.positions[i] + shift - sheet.evaluation.shape->positions[i]).norm());
  EXPECT_LT(worst, 1e-9);
  EXPECT_EQ(bent.positions[0], moved.positions[0]);  // fixed: no bit changes
}

TEST(PoseFile, BlocksGiveTheSamePointsAsTheWhole) {
  const Sheet sheet(Vec3(0, 0, 0));
  const PoseApplier applier(solved_edit(sheet.evaluation, sheet.layers), methods(), Vec3(0, 0, 0));
  const Shape whole = applier.apply(*sheet.rest);
  for (std::size_t begin = 0; begin < sheet.rest->size(); begin += 77) {
    Shape block;
    const std::size_t end = std::min(sheet.rest->size(), begin + 77);
    block.positions.assign(sheet.rest->positions.begin() + static_cast<std::ptrdiff_t>(begin),
                           sheet.rest->positions.begin() + static_cast<std::ptrdiff_t>(end));
    const Shape bent = applier.apply(block);
    for (std::size_t i = 0; i < block.size(); ++i) EXPECT_EQ(bent.positions[i], whole.positions[begin + i]);
  }
}

TEST(PoseFile, EachMistakeHasItsSentence) {
  EXPECT_EQ(message_of(file_with(toy_table + "\"maps\": [" + unit_map + "]")), "no error");
  EXPECT_EQ(message_of(file_with("\"maps\": []")),
            "p.json:1:49: expected \"binding\", found only \"method\", \"maps\"");
  EXPECT_EQ(message_of("{\"sinew\": 1}"),
            "p.json:1:2: expected one of \"sinew_pose\", \"origin\", \"layers\", found \"sinew\"");
  EXPECT_EQ(message_of(R"({"sinew_pose": 7, "origin": [0,0,0], "layers": []})"),
            "p.json:1:16: expected version 1 of the format, found 7");
  EXPECT_EQ(message_of(file_with(R"("maps": [], "binding": [{"name": "toy", "columns": 2, "values": [1, 2, 3]}])")),
            "p.json:1:91: expected rows of whole \"columns\", found 3 values in 2");
  EXPECT_EQ(message_of(file_with(R"("maps": [], "binding": [{"name": "toy", "columns": 0, "values": []}])")),
            "p.json:1:91: expected rows of whole \"columns\", found 0 values in 0");
  EXPECT_EQ(message_of(file_with(toy_table + "\"maps\": []")),
            "expected more than 0 maps, one for each that points follow, found 0");
  EXPECT_EQ(message_of(file_with("\"binding\": [], \"maps\": [" + unit_map + "]")),
            "expected a table \"toy\", found none");
  EXPECT_EQ(
      message_of(R"({"sinew_pose": 1, "origin": [0,0,0], "layers": [{"method": "tot", "binding": [], "maps": []}]})"),
      "layer: expected a method, one of \"toy\", found \"tot\"");
}

}  // namespace sinew::document
