/// Example poses in a session: opened, refused, blended by weights, found by handles, pinned, let go, removed, saved.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "apps/editor/commands.h"
#include "apps/editor/session.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/io/io.h"
#include "engine/io/sequence.h"
#include "tests/apps/bent_poses.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

class EditorExamples : public ::testing::Test {
 protected:
  EditorExamples() { test::write_poses(folder / ""); }

  /// Opens and returns what was said.
  std::string open(const std::vector<std::string>& paths) {
    session.open(paths);
    return said();
  }
  std::string said() {
    EXPECT_TRUE(until(session, [&] { return !session.job(); }));
    EXPECT_TRUE(settle(session));
    std::string out;
    for (const Notice& notice : session.take_notices()) out += notice.text + "\n";
    return out;
  }
  /// The shape with both poses.
  void open_posed() {
    open({folder / "rest.obj"});
    const std::string notices = open({folder / "poses"});
    EXPECT_EQ(notices, "2 poses added to the examples of the layer.\n");
  }
  PointSet end_of(bool top) const {
    std::vector<Index> points;
    for (Index i = 0; i < session.input()->size(); ++i)
      if (const double y = session.input()->positions[i].y(); top ? y > 1.1 : y < 0.05) points.push_back(i);
    return PointSet(session.input()->size(), points);
  }
  void mark(bool top, Mark mark) {
    session.select(end_of(top), SelectMode::Replace);
    session.mark_selection(mark);
  }
  /// The farthest that a point is from where `sinew deform` puts it, in units of the diagonal.
  double apart() {
    EXPECT_TRUE(settle(session));
    const std::string file = folder / "apart.json";
    session.save_edit(file);
    EXPECT_TRUE(until(session, [&] { return !session.dirty() && !session.job(); }));
    const document::Project saved = document::read_edit(file);
    document::Workspace workspace(std::make_shared<const Sequence>(io::open_sequence(session.input_path())),
                                  sinew::methods());
    const auto bent = document::evaluate(workspace, saved.layers, session.frame()).shape;
    return farthest(bent->positions);
  }
  double farthest(std::span<const Vec3> from) {
    const std::span<const Vec3> here = session.bent_positions();
    if (here.size() != from.size()) return 1e300;
    double out = 0;
    for (std::size_t i = 0; i < here.size(); ++i) out = std::max(out, (here[i] - from[i]).norm());
    return out / session.rest_bounds().diagonal();
  }
  /// As one drag of a bar.
  void drag_weight(std::size_t example, std::initializer_list<double> weights) {
    ASSERT_TRUE(session.begin_weight(example));
    for (const double weight : weights) {
      session.weight_to(weight);
      ASSERT_TRUE(until(session, [&] { return session.shown_ticket() == session.asked(); }));
    }
    session.end_drag();
    ASSERT_TRUE(settle(session));
  }
  /// The weights that are shown, pinned ones with a star: "0.50* 0.00".
  std::string weights() const {
    std::string out;
    for (const ExampleView& example : session.examples()) {
      char text[32] = "?";
      if (example.weight) snprintf(text, sizeof text, "%.2f", std::abs(*example.weight) < 5e-3 ? 0 : *example.weight);
      out += (out.empty() ? "" : " ") + std::string(text) + (example.pinned ? "*" : "");
    }
    return out;
  }

  TemporaryFolder folder;
  Session session{sinew::methods()};
};

}  // namespace

TEST_F(EditorExamples, AFolderOfPosesMakesALayerOfThem) {
  open_posed();
  ASSERT_NE(session.layer(), nullptr);
  EXPECT_EQ(session.layer()->method, "shell");
  const std::vector<ExampleView> examples = session.examples();
  ASSERT_EQ(examples.size(), 2u);
  EXPECT_EQ(examples[0].name, "bent");
  EXPECT_EQ(examples[1].path, folder / "poses/twisted.obj");
  EXPECT_EQ(weights(), "0.00 0.00");
  EXPECT_EQ(session.history().label(session.history().position()), "Add poses");
  ASSERT_EQ(session.hints().size(), 1u) << session.hints()[0].text << session.hints()[1].text;
  EXPECT_EQ(session.hints()[0].text, "Drag the bar of an example to blend, or mark handles and drag them.");
  EXPECT_EQ(open({folder / "poses"}), "These poses are examples already.\n");
  EXPECT_EQ(session.examples().size(), 2u);
  session.undo();
  EXPECT_EQ(session.layer(), nullptr);
  EXPECT_TRUE(session.examples().empty());
  session.redo();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(session.examples().size(), 2u);
}

TEST_F(EditorExamples, PosesOpenWithTheirShape) {
  EXPECT_FALSE(session.joins({folder / "rest.obj", folder / "poses"}));
  EXPECT_EQ(open({folder / "rest.obj", folder / "poses"}),
            "rest.obj is the shape; 2 poses beside it are its examples.\n");
  EXPECT_EQ(session.examples().size(), 2u);
  session.undo();
  EXPECT_EQ(session.layer(), nullptr);
}

TEST_F(EditorExamples, AFolderAloneGivesTheShapeToo) {
  EXPECT_EQ(open({folder / "poses"}), "bent.obj is the shape; 1 pose beside it is one of its examples.\n");
  EXPECT_EQ(session.input_path(), folder / "poses/bent.obj");
  ASSERT_EQ(session.examples().size(), 1u);
  EXPECT_EQ(session.examples()[0].name, "twisted");
  // The folder again: the shape itself is not its own example.
  EXPECT_EQ(open({folder / "poses"}), "These poses are examples already.\n");
  session.close();
  fs::create_directories(folder / "empty");
  const std::string empty = open({folder / "empty"});
  EXPECT_NE(empty.find("expected files of poses in the folder"), std::string::npos) << empty;
  EXPECT_FALSE(session.has_input());
}

TEST_F(EditorExamples, FilesOfARunAreExamplesOverTheOpenShell) {
  for (int i = 1; i <= 3; ++i)
    io::write(folder / ("walk.000" + std::to_string(i) + ".obj"), test::bent_cylinder(0.3 * i));
  open_posed();
  EXPECT_TRUE(session.joins({folder / "walk.####.obj"}));
  EXPECT_EQ(open({folder / "walk.####.obj"}), "3 poses added to the examples of the layer.\n");
  EXPECT_EQ(session.examples().size(), 5u);
  EXPECT_FALSE(session.moves());
  session.undo();
  EXPECT_EQ(open({folder / "walk.0002.obj"}), "1 pose added to the examples of the layer.\n");
  EXPECT_EQ(session.examples()[2].name, "walk.0002");
  // Without such a layer it is the run that opens.
  session.close();
  open({folder / "rest.obj"});
  EXPECT_FALSE(session.joins({folder / "walk.####.obj"}));
  open({folder / "walk.####.obj"});
  EXPECT_TRUE(session.moves());
  EXPECT_EQ(session.layer(), nullptr);
}

TEST_F(EditorExamples, WhatIsNoPoseIsNamedAndChangesNothing) {
  io::write(folder / "other.obj", samples::cylinder(18, 3, 16));
  open_posed();
  session.add_poses(folder / "other.obj");
  const std::string said_of_it = said();
  EXPECT_NE(said_of_it.find("other.obj: expected"), std::string::npos) << said_of_it;
  EXPECT_NE(said_of_it.find("an example has the points and faces of the shape it is for"), std::string::npos);
  EXPECT_FALSE(session.take_declined().has_value());
  // Opened like any shape it may be one; the window asks.
  open({folder / "other.obj"});
  EXPECT_EQ(session.take_declined(), folder / "other.obj");
  EXPECT_EQ(session.take_declined(), std::nullopt);
  // What can't be read is no shape either.
  io::save_bytes(folder / "cut.obj", std::as_bytes(std::span("v 1 2\n", 6)), true);
  const std::string said_of_cut = open({folder / "cut.obj"});
  EXPECT_NE(said_of_cut.find("cut.obj"), std::string::npos) << said_of_cut;
  EXPECT_EQ(said_of_cut.find("examples"), std::string::npos) << said_of_cut;
  EXPECT_EQ(session.take_declined(), std::nullopt);
  EXPECT_EQ(session.input_path(), folder / "rest.obj");
  EXPECT_EQ(session.examples().size(), 2u);
  session.open_shape(folder / "other.obj");
  said();
  EXPECT_EQ(session.input_path(), folder / "other.obj");

  // One bad file of a folder, and none of the folder is taken.
  const std::string mixed = open({folder / "poses"});
  EXPECT_NE(mixed.find("bent.obj: "), std::string::npos) << mixed;
  EXPECT_EQ(session.layer(), nullptr);
  session.add_layer("graph");
  EXPECT_EQ(open({folder / "poses"}), "Poses are examples of a layer of the method shell: this layer's is graph.\n");
  std::ofstream(folder / "scan.xyz") << "0 0 0\n1 0 0\n0 1 0\n";
  session.open_shape(folder / "scan.xyz");
  said();
  EXPECT_EQ(open({folder / "poses"}), "scan.xyz has no faces: poses are examples of surfaces.\n");
}

TEST_F(EditorExamples, ABarBlends) {
  open_posed();
  const std::size_t before = session.history().position();
  drag_weight(0, {0.2, 0.6, 1});
  EXPECT_EQ(weights(), "1.00* 0.00");
  EXPECT_EQ(*session.examples()[1].weight, 0);  // nothing pulls: it is not looked for
  EXPECT_EQ(session.history().position(), before + 1);
  EXPECT_EQ(session.history().label(before + 1), "Weight of bent");
  // All of it is the pose itself, laid over the rest shape as a rigid body.
  EXPECT_LE(farthest(io::read(folder / "poses/bent.obj")->positions), 0.02);
  EXPECT_LE(apart(), 1e-6);
  EXPECT_TRUE(session.hints().empty()) << session.hints()[0].text;

  drag_weight(1, {0.3});
  drag_weight(0, {0.5});
  EXPECT_EQ(weights(), "0.50* 0.30*");
  EXPECT_LE(apart(), 1e-6);
  drag_weight(0, {1.7});  // typed: beyond the bar
  EXPECT_LE(apart(), 1e-6);
  session.undo();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.50* 0.30*");

  // A drag that is cancelled leaves all as it was.
  const std::vector<Vec3> here(session.bent_positions().begin(), session.bent_positions().end());
  ASSERT_TRUE(session.begin_weight(1));
  session.weight_to(-0.4);
  session.cancel_drag();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.50* 0.30*");
  EXPECT_LE(farthest(here), 1e-6);
}

TEST_F(EditorExamples, HandlesFindTheWeightsThatAreFree) {
  open_posed();
  mark(false, Mark::Fixed);
  mark(true, Mark::Handle);
  ASSERT_TRUE(settle(session));
  const std::vector<Vec3> rest(session.bent_positions().begin(), session.bent_positions().end());
  const std::shared_ptr<const Shape> bent = io::read(folder / "poses/bent.obj");
  Vec3 from(0, 0, 0), to(0, 0, 0);
  const std::vector<Index> top = end_of(true).indices();
  for (const Index i : top) {
    from += rest[i] / static_cast<double>(top.size());
    to += bent->positions[i] / static_cast<double>(top.size());
  }
  ASSERT_TRUE(session.begin_drag(0));
  // Where the end of the bent pose is, turned as it is.
  session.drag_to({Vec3::UnitZ(), -1.2 * 180 / M_PI, from, to - from});
  session.end_drag();
  ASSERT_TRUE(settle(session));
  const std::vector<ExampleView> found = session.examples();
  EXPECT_GT(*found[0].weight, 0.8);
  EXPECT_LT(std::abs(*found[1].weight), 0.1);
  EXPECT_FALSE(found[0].pinned.has_value());
  EXPECT_LE(farthest(bent->positions), 0.02);
  EXPECT_LE(apart(), 1e-6);

  // Held at another, it is no longer found; let go, it is again.
  drag_weight(0, {0.3});
  EXPECT_EQ(weights().substr(0, 5), "0.30*");
  EXPECT_LE(apart(), 1e-6);
  session.pin_example(0, std::nullopt);
  ASSERT_TRUE(settle(session));
  EXPECT_NEAR(*session.examples()[0].weight, *found[0].weight, 1e-3);
  EXPECT_TRUE(session.layer()->example_weights.empty());
}

TEST_F(EditorExamples, CommandsPinFreeAndRestAll) {
  open_posed();
  View view;
  Preferences preferences;
  std::vector<Request> requests;
  Context context{session, view, preferences, [&](Request request) { requests.push_back(request); }};
  const auto run = [&](const char* id) {
    const Command* command = find_command(id);
    EXPECT_TRUE(command != nullptr && run_command(*command, context)) << id;
    EXPECT_TRUE(settle(session));
  };
  drag_weight(0, {0.5});
  run("layer.pin_weights");
  EXPECT_EQ(weights(), "0.50* 0.00*");
  run("layer.rest_weights");
  EXPECT_EQ(weights(), "0.00* 0.00*");
  EXPECT_LE(farthest(session.input()->positions), 1e-6);
  run("layer.free_weights");
  EXPECT_EQ(weights(), "0.00 0.00");
  run("layer.add_poses");
  EXPECT_EQ(requests, std::vector{Request::AddPoses});
  session.undo();
  session.undo();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.50* 0.00*");
  session.add_layer("graph");
  const Command* add = find_command("layer.add_poses");
  EXPECT_FALSE(run_command(*add, context));
  EXPECT_EQ(add->why_not(context), "Poses are for the method shell: this layer's is graph.");
}

TEST_F(EditorExamples, APoseIsRemovedWithItsWeight) {
  open_posed();
  drag_weight(0, {0.25});
  drag_weight(1, {0.75});
  session.remove_example(0);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.75*");
  EXPECT_EQ(session.examples()[0].name, "twisted");
  EXPECT_LE(apart(), 1e-6);
  session.undo();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.25* 0.75*");

  // Of a folder written as such the other poses stay; of a run, which is one entry, none.
  std::ofstream(folder / "folder.json") << R"({ "sinew": 1, "inputs": ["rest.obj"], "layers": [
    { "method": "shell", "examples": ["poses"], "example_weights": [0.25, 0.75] } ] })";
  open({folder / "folder.json"});
  EXPECT_EQ(weights(), "0.25* 0.75*");
  session.remove_example(1);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.25*");
  EXPECT_EQ(session.layer()->examples, std::vector<std::string>{folder / "poses/bent.obj"});
}

TEST_F(EditorExamples, APoseThatIsGoneCanBeRemoved) {
  std::ofstream(folder / "gone.json") << R"({ "sinew": 1, "inputs": ["rest.obj"], "layers": [
    { "method": "shell", "examples": ["gone.obj", "poses/bent.obj"], "example_weights": [0, 0.5] } ] })";
  EXPECT_NE(open({folder / "gone.json"}).find("gone.obj"), std::string::npos);
  EXPECT_EQ(weights(), "? ?");
  EXPECT_FALSE(session.begin_weight(0));
  session.remove_example(0);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.50*");
}

TEST_F(EditorExamples, ASavedBlendOpensAgain) {
  open_posed();
  drag_weight(0, {0.4});
  session.save_edit(folder / "blend.json");
  ASSERT_TRUE(until(session, [&] { return !session.dirty() && !session.job(); })) << errors_of(session);
  const std::vector<Vec3> here(session.bent_positions().begin(), session.bent_positions().end());
  session.close();
  EXPECT_EQ(open({folder / "blend.json"}).find("expected"), std::string::npos);
  EXPECT_EQ(weights(), "0.40* 0.00");
  EXPECT_LE(farthest(here), 1e-9);
  EXPECT_FALSE(session.dirty());
}

TEST_F(EditorExamples, WeightsAreKeyedOverTime) {
  for (int i = 1; i <= 5; ++i)
    io::write(folder / ("walk.000" + std::to_string(i) + ".obj"), test::twisted_cylinder(0.05 * i));
  open({folder / "walk.####.obj"});
  session.add_layer("shell");
  ASSERT_TRUE(settle(session));
  session.add_poses(folder / "poses/bent.obj");
  EXPECT_EQ(said(), "1 pose added to the examples of the layer.\n");
  drag_weight(0, {0.2});
  ASSERT_EQ(session.layer()->keys.size(), 1u);
  session.go_to_frame(5);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.20*");
  drag_weight(0, {1});
  ASSERT_EQ(session.layer()->keys.size(), 2u);
  session.go_to_frame(3);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.60*");
  EXPECT_LE(apart(), 1e-6);
  // A key set between them changes nothing.
  session.insert_key();
  ASSERT_TRUE(settle(session));
  ASSERT_EQ(session.layer()->keys.size(), 3u);
  EXPECT_EQ(weights(), "0.60*");
  session.go_to_frame(4);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(weights(), "0.80*");
  session.delete_key(1);
  session.delete_key(3);
  session.delete_key(5);
  ASSERT_TRUE(settle(session));
  EXPECT_TRUE(session.layer()->keys.empty());
  EXPECT_EQ(weights(), "1.00*");  // what the last key said
}

}  // namespace sinew::editor
