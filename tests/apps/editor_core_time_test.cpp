/// A session over what moves: frames, keys that drags set, and streams.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <thread>

#include "apps/editor/session.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/io/io.h"
#include "engine/io/sequence.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"

namespace sinew::editor {

namespace {

constexpr int last_frame = 5;

/// A bar along x whose right half swings up and down: frame 1 is straight.
Shape bar_at(int frame) {
  Shape shape;
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        const double x = i / 40.0, lift = 0.05 * (frame - 1) * std::max(0.0, x - 0.5);
        shape.positions.emplace_back(x, 0.04 * j + lift, 0.04 * k);
      }
  shape.position_type = Type::Float64;
  return shape;
}

/// Particles that fly along x; frame f has those with ids f to f + 59.
Shape spray_at(int frame) {
  Shape shape;
  Attribute id;
  id.name = "id";
  id.type = Type::Int32;
  id.kind = Kind::Id;
  const auto count = static_cast<std::size_t>(60 + frame);
  id.values.resize(count * sizeof(std::int32_t));
  for (std::size_t i = 0; i < count; ++i) {
    const int number = static_cast<int>(i);
    shape.positions.emplace_back(0.1 * frame + 0.002 * number, 0.05 * std::sin(number), 0.05 * std::cos(number));
    id.set_number(i, 0, number);
  }
  shape.attributes.push_back(std::move(id));
  return shape;
}

class EditorTime : public ::testing::Test {
 protected:
  void open(const std::function<Shape(int)>& shape_at) {
    for (int frame = 1; frame <= last_frame; ++frame)
      io::write(folder / ("run.000" + std::to_string(frame) + ".ply"), shape_at(frame), true);
    session.open(folder / "run.####.ply");
    ASSERT_TRUE(until([&] { return session.has_input(); })) << errors();
    ASSERT_TRUE(settle());
    ASSERT_EQ(session.frames().size(), static_cast<std::size_t>(last_frame));
  }

  /// The left end fixed, the right end a handle.
  void fix_and_hold() {
    open(bar_at);
    mark(Mark::Fixed, [](const Vec3& p) { return p.x() < 0.1; });
    session.set_setting(0, "nodes", 40.0);
    mark(Mark::Handle, [](const Vec3& p) { return p.x() > 0.9; });
    ASSERT_TRUE(settle());
    ASSERT_EQ(errors(), "");
  }

  void mark(Mark what, const std::function<bool(const Vec3&)>& in) { mark_where(session, what, in); }

  void drag(const Vec3& by) {
    ASSERT_TRUE(session.begin_drag(0));
    for (int step = 1; step <= 4; ++step) {
      session.drag_to(move_by(by * (step / 4.0)));
      session.poll();
    }
    session.end_drag();
    ASSERT_TRUE(settle()) << errors();
  }

  void go_to(int frame) {
    session.go_to_frame(frame);
    ASSERT_TRUE(settle()) << errors();
    ASSERT_EQ(session.frame(), frame);
  }

  bool until(const std::function<bool()>& done) { return editor::until(session, done); }
  bool settle() { return editor::settle(session); }
  std::string errors() { return errors_of(session); }

  std::vector<int> keys() const {
    std::vector<int> out;
    for (const document::Key& key : session.layer()->keys) out.push_back(key.frame);
    return out;
  }

  std::vector<Vec3> bent() {
    const std::span<const Vec3> positions = session.bent_positions();
    return {positions.begin(), positions.end()};
  }

  /// What the command line makes of the session's edit at a frame.
  std::vector<Vec3> command_line(int frame) {
    document::Workspace workspace(std::make_shared<const Sequence>(io::open_sequence(folder / "run.####.ply")),
                                  sinew::methods());
    return document::evaluate(workspace, session.project().layers, frame).shape->positions;
  }

  TemporaryFolder folder;
  Session session{sinew::methods()};
};

double distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  EXPECT_EQ(a.size(), b.size());
  double out = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

}  // namespace

TEST_F(EditorTime, FramesAreShownAndHeldToThoseThatThereAre) {
  open(bar_at);
  EXPECT_TRUE(session.moves());
  EXPECT_FALSE(session.stream());
  go_to(3);
  EXPECT_LE(distance(bent(), bar_at(3).positions), 1e-12);
  session.go_to_frame(99);
  ASSERT_TRUE(settle());
  EXPECT_EQ(session.frame(), last_frame);
  session.step_frame(-1);
  ASSERT_TRUE(settle());
  EXPECT_EQ(session.frame(), last_frame - 1);
  EXPECT_EQ(errors(), "");
}

TEST_F(EditorTime, ADragSetsAKeyAndTheWindowShowsWhatTheCommandLineMakes) {
  fix_and_hold();
  const document::Project before = session.project();
  go_to(2);
  drag({0, 0, 0.2});
  EXPECT_EQ(keys(), std::vector{2});
  go_to(5);
  EXPECT_LE(distance(bent(), command_line(5)), 1e-12);
  drag({0, 0, -0.3});
  EXPECT_EQ(keys(), (std::vector{2, 5}));
  EXPECT_EQ(session.layer()->frame, 1) << "the structure must stay where it was made";
  for (const int frame : {1, 2, 3, 4, 5}) {
    go_to(frame);
    EXPECT_LE(distance(bent(), command_line(frame)), 1e-12) << frame;
  }
  // Half way between two keys a second drag begins where the handle is.
  go_to(4);
  const Vec3 held = session.handles()[0].target;
  drag({0, 0.1, 0});
  EXPECT_EQ(keys(), (std::vector{2, 4, 5}));
  EXPECT_LE((session.handles()[0].target - held - Vec3(0, 0.1, 0)).norm(), 1e-9);
  session.undo();
  session.undo();
  session.undo();
  ASSERT_TRUE(settle());
  EXPECT_TRUE(session.project() == before);
  go_to(2);
  EXPECT_LE(distance(bent(), bar_at(2).positions), 1e-9);
}

TEST_F(EditorTime, KeysAreSetMovedAndDeleted) {
  fix_and_hold();
  drag({0, 0, 0.2});
  ASSERT_EQ(keys(), std::vector{1});
  go_to(4);
  const std::vector<Vec3> held = bent();
  session.insert_key();
  ASSERT_TRUE(settle());
  EXPECT_EQ(keys(), (std::vector{1, 4}));
  EXPECT_LE(distance(held, bent()), 1e-6) << "a key that is set moves nothing";
  session.move_key(4, 3);
  EXPECT_EQ(keys(), (std::vector{1, 3}));
  session.set_interpolation(1, document::Interpolation::Hold);
  EXPECT_EQ(session.layer()->keys[0].interpolation, document::Interpolation::Hold);
  session.move_key(3, 1);
  EXPECT_EQ(keys(), std::vector{1}) << "one that is moved onto another takes its place";
  session.undo();
  EXPECT_EQ(keys(), (std::vector{1, 3}));
  session.delete_key(1);
  EXPECT_EQ(keys(), std::vector{3});
  ASSERT_TRUE(settle());
  go_to(3);
  const std::vector<Vec3> last = bent();
  session.delete_key(3);
  ASSERT_TRUE(settle());
  EXPECT_TRUE(keys().empty());
  // Only the structure is made anew, at that frame.
  EXPECT_LE(distance(last, bent()), 0.01) << "without its last key the edit does not stay what it was there";
  EXPECT_LE(distance(bent(), command_line(3)), 1e-12);
  EXPECT_EQ(errors(), "");
}

TEST_F(EditorTime, AHandleIsResetAtTheFrameShown) {
  fix_and_hold();
  drag({0, 0, 0.2});
  go_to(4);
  session.reset_handle(0);
  ASSERT_TRUE(settle());
  EXPECT_EQ(keys(), (std::vector{1, 4}));
  EXPECT_LE(distance(bent(), bar_at(4).positions), 1e-6);
  go_to(1);
  EXPECT_GT(distance(bent(), bar_at(1).positions), 0.1);
}

TEST_F(EditorTime, ACutIsAStepOfHistoryAndTheCommandLineCutsAsWell) {
  fix_and_hold();
  drag(Vec3(0, 0.2, 0));
  const std::vector<Vec3> before = bent();
  // Across the bar: what is fixed no longer holds the other end.
  const std::vector<Vec3> path{Vec3(0.5, -2, -2), Vec3(0.5, 2, -2)};
  session.add_cut(path, Vec3(0, 0, 4));
  ASSERT_TRUE(settle()) << errors();
  ASSERT_EQ(session.layer()->cuts.size(), 1u);
  EXPECT_EQ(session.layer()->cuts[0].path[1], path[1] + session.input()->origin);
  EXPECT_LE(distance(bent(), command_line(session.frame())), 1e-12);
  EXPECT_GT(distance(bent(), before), 1e-3);
  session.add_cut(std::vector<Vec3>{Vec3(0, 0, 0)}, Vec3(1, 0, 0));  // a point parts nothing
  EXPECT_EQ(session.layer()->cuts.size(), 1u);
  session.remove_cut();
  ASSERT_TRUE(settle()) << errors();
  EXPECT_TRUE(session.layer()->cuts.empty());
  EXPECT_LE(distance(bent(), before), 1e-12);
  session.undo();
  EXPECT_EQ(session.layer()->cuts.size(), 1u);
}

TEST_F(EditorTime, ItPlaysAndADragStopsThat) {
  fix_and_hold();
  std::vector<int> seen;
  session.play(true);
  EXPECT_TRUE(until([&] {
    if (seen.empty() || seen.back() != session.frame()) seen.push_back(session.frame());
    return seen.size() > 6;
  })) << "it does not play round";
  ASSERT_TRUE(session.begin_drag(0));
  EXPECT_FALSE(session.playing());
  const int frame = session.frame();
  session.drag_to(move_by(Vec3(0, 0, 0.1)));
  session.end_drag();
  ASSERT_TRUE(settle());
  EXPECT_EQ(session.frame(), frame);
  EXPECT_EQ(keys(), std::vector{frame});
  session.play(true);
  session.save_edit(folder / "edit.json");
  EXPECT_TRUE(until([&] { return !session.dirty(); })) << "saving waits for what plays";
  EXPECT_TRUE(document::read_edit(folder / "edit.json") == session.project());
}

TEST_F(EditorTime, AFrameThatCannotBeReadIsASentence) {
  open(bar_at);
  std::filesystem::resize_file(folder / "run.0004.ply", 300);
  session.go_to_frame(4);
  ASSERT_TRUE(until([&] { return session.wanted_frame() == 1; })) << "it waits for a frame that will not come";
  EXPECT_NE(errors().find("run.0004.ply"), std::string::npos);
  EXPECT_EQ(session.frame(), 1);
  go_to(3);
}

TEST_F(EditorTime, LayersAreRaisedAndLowered) {
  fix_and_hold();
  drag({0, 0, 0.2});
  session.add_layer("graph");
  session.rename_layer(1, "Fine");
  mark(Mark::Fixed, [](const Vec3& p) { return p.x() < 0.4; });
  mark(Mark::Handle, [](const Vec3& p) { return p.x() > 0.55 && p.x() < 0.65; });
  ASSERT_TRUE(settle());
  go_to(3);
  drag({0, 0.1, 0});
  const std::vector<Vec3> above = bent();
  session.move_layer(1, -1);
  ASSERT_TRUE(settle());
  EXPECT_EQ(session.project().layers[0].name, "Fine");
  EXPECT_EQ(session.chosen_layer(), 0u);
  EXPECT_LE(distance(bent(), command_line(3)), 1e-12);
  session.move_layer(0, -1);  // there is nothing below
  EXPECT_EQ(session.project().layers[0].name, "Fine");
  session.move_layer(0, 1);
  ASSERT_TRUE(settle());
  EXPECT_EQ(session.project().layers[1].name, "Fine");
  EXPECT_LE(distance(bent(), above), 1e-12);
  EXPECT_EQ(errors(), "");
}

TEST_F(EditorTime, AStreamGetsAPathAndItsSelectionsAFrame) {
  open(spray_at);
  EXPECT_TRUE(session.stream());
  go_to(2);
  mark(Mark::Fixed, [](const Vec3& p) { return p.x() < 0.22; });
  ASSERT_NE(session.layer(), nullptr);
  EXPECT_TRUE(session.layer()->path.has_value());
  EXPECT_EQ(session.layer()->fixed.at(0).frame, 2);
  ASSERT_TRUE(settle());
  const std::size_t fixed = session.layer()->fixed.size();
  go_to(4);
  EXPECT_EQ(session.bent_positions().size(), 64u);
  mark(Mark::Handle, [](const Vec3& p) { return p.x() > 0.48; });
  ASSERT_TRUE(settle());
  EXPECT_EQ(session.layer()->fixed.size(), fixed) << "points of another frame were freed";
  EXPECT_EQ(session.layer()->handles.at(0).points.frame, 4);
  drag({0, 0.1, 0});
  EXPECT_EQ(errors(), "");
  EXPECT_LE(distance(bent(), command_line(4)), 1e-12);
  session.undo();
  ASSERT_TRUE(settle());
  EXPECT_LE(distance(bent(), session.input()->positions), 1e-9);
}

TEST(EditorMarks, AKeyGivesHandlesThatOtherKeysLackTheirOwnMotion) {
  document::Layer layer;
  layer.handles.resize(2);
  layer.handles[1].motion.move = Vec3(0, 1, 0);
  layer.keys.resize(1);
  layer.keys[0].frame = 3;
  layer.keys[0].handles.resize(1);
  const document::Layer out = with_key(layer, 8, 1, std::vector<document::Motion>(2));
  ASSERT_EQ(out.keys.size(), 2u);
  ASSERT_EQ(out.keys[0].handles.size(), 2u);
  EXPECT_EQ(out.keys[0].handles[1].move, Vec3(0, 1, 0));
  EXPECT_EQ(out.frame, 3);
}

}  // namespace sinew::editor
