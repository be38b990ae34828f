/// A session as a window uses it: open, mark, drag, undo, save, export; and that it ends where the command line does.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <thread>

#include "apps/editor/session.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/io/io.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"

namespace sinew::editor {

namespace {

/// The surface of a bar of 1 x 0.2 x 0.2 along x, at `origin` in the file's coordinates.
Shape bar(const Vec3& origin = Vec3::Zero()) {
  Shape shape;
  const int along = 50, around = 10;
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= around; ++j)
      for (int k = 0; k <= around; ++k)
        if (i == 0 || i == along || j == 0 || j == around || k == 0 || k == around)
          shape.positions.emplace_back(origin + Vec3(i / 50.0, 0.02 * j - 0.1, 0.02 * k - 0.1));
  shape.position_type = Type::Float64;
  return shape;
}

/// Points of the input whose rest position holds `in`.
PointSet points_where(const Session& session, const std::function<bool(const Vec3&)>& in) {
  PointSet out(session.input()->size());
  for (std::size_t i = 0; i < out.size(); ++i)
    if (in(session.input()->positions[i] + session.input()->origin)) out.add(i);
  return out;
}

std::vector<Vec3> bent_of(Session& session) {
  const std::span<const Vec3> bent = session.bent_positions();
  return {bent.begin(), bent.end()};
}

double distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  EXPECT_EQ(a.size(), b.size());
  double out = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

class EditorSession : public ::testing::Test {
 protected:
  /// A session that shows the bar, read from a file.
  void open_bar(const Vec3& origin = Vec3::Zero()) {
    Shape shape = bar(origin);
    set_origin(shape);
    io::write(input(), shape, true);
    session.open(input());
    ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
    session.select_all();
    session.set_setting(0, "nodes", 60.0);  // refused: there is no layer yet
    ASSERT_TRUE(settle(session));
  }

  /// Its left end fixed, its right end a handle.
  void fix_and_hold(const Vec3& origin = Vec3::Zero()) {
    open_bar(origin);
    session.select(points_where(session, [&](const Vec3& p) { return p.x() - origin.x() < 0.1; }), SelectMode::Replace);
    session.mark_selection(Mark::Fixed);
    session.set_setting(0, "nodes", 60.0);
    session.select(points_where(session, [&](const Vec3& p) { return p.x() - origin.x() > 0.9; }), SelectMode::Replace);
    session.mark_selection(Mark::Handle);
    ASSERT_TRUE(settle(session));
    ASSERT_EQ(errors_of(session), "");
  }

  /// What the command line makes of the saved edit, relative to the same origin.
  std::vector<Vec3> command_line() {
    session.save_edit(edit());
    EXPECT_TRUE(until(session, [&] { return !session.dirty() && !session.job(); })) << errors_of(session);
    const document::Project project = document::read_edit(edit());
    EXPECT_TRUE(project == session.project()) << "the saved edit reads back as another";
    return document::evaluate(io::read(input()), project.layers, sinew::methods()).shape->positions;
  }

  std::string input() const { return folder / "bar.ply"; }
  std::string edit() const { return folder / "edit.json"; }

  TemporaryFolder folder;
  Session session{sinew::methods()};
};

}  // namespace

TEST_F(EditorSession, TheWindowShowsWhatTheCommandLineMakes) {
  fix_and_hold();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> small(-0.2, 0.2);
  for (int drag = 0; drag < 4; ++drag) {
    ASSERT_TRUE(session.begin_drag(0));
    const Vec3 goal(small(random), small(random), small(random));
    for (int step = 1; step <= 8; ++step) {
      session.drag_to(move_by(goal * (step / 8.0)));
      session.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    session.end_drag();
    ASSERT_TRUE(settle(session)) << errors_of(session);
    EXPECT_LE(distance(command_line(), bent_of(session)), 1e-12);
  }
  EXPECT_EQ(session.history().label(session.history().position()), "Drag handle");
  EXPECT_GT(session.figures().moved, 100u);
}

TEST_F(EditorSession, ADragAroundAFullTwistIsKept) {
  fix_and_hold();
  const std::vector<Vec3> rest = bent_of(session);
  ASSERT_TRUE(session.begin_drag(0));
  for (int degrees = 10; degrees <= 220; degrees += 10) {
    const std::uint64_t version = session.bent_version();
    session.drag_to(turn_by(Vec3::UnitX(), degrees, Vec3(1, 0, 0)));
    ASSERT_TRUE(until(session, [&] { return session.bent_version() != version; }));
  }
  const std::vector<Vec3> dragged = bent_of(session);
  session.end_drag();
  ASSERT_TRUE(settle(session));
  EXPECT_LE(distance(dragged, bent_of(session)), 0.05) << "the shape left where the user had brought it";
  ASSERT_FALSE(session.project().layers[0].start.get().empty());
  EXPECT_LE(distance(command_line(), bent_of(session)), 1e-12);

  document::Project plain = session.project();
  plain.layers[0].start = {};
  const auto cold = document::evaluate(io::read(input()), plain.layers, sinew::methods());
  EXPECT_GT(distance(cold.shape->positions, bent_of(session)), 0.02)
      << "from rest it ends here too: nothing was tested";

  // Undo, and redo comes back to the same twist.
  const std::vector<Vec3> twisted = bent_of(session);
  session.undo();
  ASSERT_TRUE(settle(session));
  EXPECT_LE(distance(rest, bent_of(session)), 1e-12);
  session.redo();
  ASSERT_TRUE(settle(session));
  EXPECT_LE(distance(twisted, bent_of(session)), 1e-12);

  // A change of the structure makes the pose worthless; it must not be kept.
  session.set_setting(0, "nodes", 50.0);
  ASSERT_TRUE(settle(session));
  EXPECT_TRUE(session.project().layers[0].start.get().empty());
  EXPECT_EQ(errors_of(session), "");
}

TEST_F(EditorSession, FarFromTheOriginItIsTheSame) {
  const Vec3 far(5400000, 600000, 100);
  fix_and_hold(far);
  ASSERT_GT(session.input()->origin.norm(), 0);
  ASSERT_TRUE(session.begin_drag(0));
  const Vec3 pivot = session.handles()[0].target;
  session.drag_to(turn_by(Vec3::UnitZ(), 40, pivot));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  EXPECT_LE(distance(command_line(), bent_of(session)), 1e-8);
  EXPECT_LE((session.handles()[0].target - pivot).norm(), 1e-8);
  EXPECT_LE((session.handles()[0].axes.col(0) -
             Vec3(std::cos(40 * std::numbers::pi / 180), std::sin(40 * std::numbers::pi / 180), 0))
                .norm(),
            1e-9);
}

TEST_F(EditorSession, SeveralLayersEndWhereTheCommandLineDoes) {
  fix_and_hold();
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, 0.2, 0}));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  session.add_layer("graph");
  session.set_setting(1, "nodes", 40.0);
  session.select(points_where(session, [](const Vec3& p) { return p.x() < 0.4; }), SelectMode::Replace);
  session.mark_selection(Mark::Fixed);
  session.select(points_where(session, [](const Vec3& p) { return p.x() > 0.95; }), SelectMode::Replace);
  session.mark_selection(Mark::Handle);
  ASSERT_TRUE(settle(session)) << errors_of(session);
  const std::vector<Vec3> before = bent_of(session);
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, 0, 0.1}));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  EXPECT_GT(distance(before, bent_of(session)), 0.05);
  EXPECT_LE(distance(command_line(), bent_of(session)), 1e-12);
  // The layer below again, under the one above.
  session.choose_layer(0);
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, -0.1, 0}));
  session.end_drag();
  ASSERT_TRUE(settle(session)) << errors_of(session);
  EXPECT_LE(distance(command_line(), bent_of(session)), 1e-12);
  session.toggle_layer(1);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(session.shown().size(), 1u);
  EXPECT_LE(distance(command_line(), bent_of(session)), 1e-12);
}

TEST_F(EditorSession, ACancelledDragLeavesNothing) {
  fix_and_hold();
  const document::Project project = session.project();
  const std::size_t states = session.history().size();
  const std::vector<Vec3> before = bent_of(session);
  const bool dirty = session.dirty();
  ASSERT_TRUE(session.begin_drag(0));
  for (int step = 1; step <= 5; ++step) {
    const std::uint64_t version = session.bent_version();
    session.drag_to(move_by({0, 0.05 * step, 0}));
    ASSERT_TRUE(until(session, [&] { return session.bent_version() != version; }));
  }
  EXPECT_GT(distance(before, bent_of(session)), 0.1);
  session.cancel_drag();
  EXPECT_LE(distance(before, bent_of(session)), 1e-12) << "not at once";
  ASSERT_TRUE(settle(session));
  EXPECT_LE(distance(before, bent_of(session)), 1e-12);
  EXPECT_TRUE(project == session.project());
  EXPECT_EQ(session.history().size(), states);
  EXPECT_EQ(session.dirty(), dirty);
  // A drag to nowhere is no step either.
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, 0.1, 0}));
  session.drag_to(move_by({0, 0, 0}));
  session.end_drag();
  EXPECT_EQ(session.history().size(), states);
}

TEST_F(EditorSession, ADragThatFollowsAtOnceInterruptsNothing) {
  fix_and_hold();
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, 0.2, 0}));
  session.end_drag();
  // Pressed and let go again before the answer came; then moved and cancelled before it came.
  ASSERT_TRUE(session.begin_drag(0));
  session.poll();
  session.end_drag();
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, 0.1, 0}));
  session.cancel_drag();
  ASSERT_TRUE(settle(session)) << "it waits for an answer that nobody asked for";
  EXPECT_NEAR(session.handles()[0].target.y(), 0.2, 1e-12);
  EXPECT_LE(distance(command_line(), bent_of(session)), 1e-12);
}

TEST_F(EditorSession, ASaveIsNotLostWhenTheSessionEnds) {
  fix_and_hold();
  document::Project project;
  {
    Session other(sinew::methods());
    other.adopt(session.input(), input(), session.project());
    other.save_edit(edit());
    project = other.project();
  }
  EXPECT_TRUE(document::read_edit(edit()) == project);
}

TEST_F(EditorSession, AnyEditsAreUndoneAndDoneAgain) {
  fix_and_hold();
  std::mt19937 random(11);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  std::vector<document::Project> states{session.project()};
  const std::size_t before = session.history().size() - 1;
  for (int i = 0; i < 150; ++i) {
    const double from = 0.01 * static_cast<double>(pick(100)), to = from + 0.2;
    const auto slab = points_where(session, [&](const Vec3& p) { return p.x() >= from && p.x() < to; });
    switch (pick(12)) {
      case 0: session.select(slab, SelectMode::Replace), session.mark_selection(Mark::Fixed); break;
      case 1: session.select(slab, SelectMode::Replace), session.mark_selection(Mark::Handle); break;
      case 2: session.select(slab, SelectMode::Replace), session.mark_selection(Mark::Free); break;
      case 3: session.delete_handle(pick(4)); break;
      case 4:
      case 5:
        if (!session.begin_drag(pick(3))) break;
        session.drag_to(turn_by(Vec3::UnitY(), 5.0 * static_cast<double>(pick(30)), Vec3(0.5, 0, 0)));
        pick(3) == 0 ? session.cancel_drag() : session.end_drag();
        break;
      case 6: session.add_layer("graph"); break;
      case 7:
        pick(3) == 0 ? session.remove_layer(pick(3)) : session.rename_layer(pick(3), "L" + std::to_string(i));
        break;
      case 8: session.toggle_layer(pick(3)); break;
      case 9: session.set_setting(pick(3), "nodes", 20.0 + static_cast<double>(pick(50))); break;
      case 10: session.choose_layer(pick(3)); break;
      default: session.reset_handle(pick(3)); break;
    }
    if (!(session.project() == states.back())) states.push_back(session.project());
    if (pick(4) == 0) session.poll();
    // The end of a drag may get its start, in place of the state that it was.
    if (!(session.project() == states.back())) states.back() = session.project();
    ASSERT_EQ(session.history().size(), before + states.size());
  }
  for (std::size_t i = states.size(); i-- > 0;) {
    EXPECT_TRUE(session.project() == states[i]) << i;
    if (i > 0) session.undo();
  }
  for (std::size_t i = 1; i < states.size(); ++i) {
    session.redo();
    EXPECT_TRUE(session.project() == states[i]) << i;
  }
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
}

TEST_F(EditorSession, ANewHandleKeepsTheShapeWhereItIs) {
  fix_and_hold();
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(turn_by(Vec3::UnitZ(), 60, Vec3(0.9, 0, 0)));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  const std::vector<Vec3> before = bent_of(session);
  session.select(points_where(session, [](const Vec3& p) { return p.x() > 0.48 && p.x() < 0.52; }),
                 SelectMode::Replace);
  session.mark_selection(Mark::Handle);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(session.chosen_handle(), 1u);
  EXPECT_LE(distance(before, bent_of(session)), 0.03);
}

TEST_F(EditorSession, PointsBelongToOneMark) {
  fix_and_hold();
  const auto all = points_where(session, [](const Vec3& p) { return p.x() > 0.95 || p.x() < 0.05; });
  session.select(all, SelectMode::Replace);
  session.mark_selection(Mark::Fixed);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
  const std::vector<std::uint8_t> marks = session.point_marks();
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double x = session.input()->positions[i].x();
    EXPECT_EQ(marks[i] & 7, x > 0.95 || x < 0.1 ? 2 : x > 0.9 ? 1 : 0) << x;
  }
  session.select_handle(0);
  session.mark_selection(Mark::Free);
  EXPECT_TRUE(session.layer()->handles.empty());
  EXPECT_FALSE(session.hints().empty());
}

TEST_F(EditorSession, AnEditOpensWithItsInput) {
  fix_and_hold();
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, 0.1, 0.1}));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  const std::vector<Vec3> shown = command_line();
  Session again(sinew::methods());
  again.open(edit());
  ASSERT_TRUE(until(again, [&] { return again.has_input() && !again.solving(); })) << errors_of(again);
  EXPECT_TRUE(again.project() == session.project());
  EXPECT_FALSE(again.dirty());
  EXPECT_EQ(again.edit_path(), edit());
  EXPECT_EQ(again.input_path(), input());
  EXPECT_LE(distance(shown, bent_of(again)), 1e-12);
}

TEST_F(EditorSession, ExportWritesWhatIsShownAndRefusesToReplace) {
  fix_and_hold();
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, 0.2, 0}));
  session.end_drag();
  const std::string out = folder / "bent.ply";
  session.export_shape(out);  // before the answer is settled: it waits for it
  ASSERT_TRUE(until(session, [&] { return std::filesystem::exists(out) && !session.job(); })) << errors_of(session);
  EXPECT_LE(distance(io::read(out)->positions, bent_of(session)), 1e-12);
  EXPECT_EQ(errors_of(session), "");
  session.export_shape(out);
  ASSERT_TRUE(until(session, [&] { return !session.job(); }));
  EXPECT_NE(errors_of(session).find(out), std::string::npos);
}

TEST_F(EditorSession, ABrokenFileChangesNothing) {
  fix_and_hold();
  const document::Project project = session.project();
  std::ofstream(folder / "bad.ply") << "ply\nformat ascii 1.0\nelement vertex 3\n";
  std::ofstream(folder / "bad.json") << "{ \"sinew\": 1, \"layers\": [ { \"method\": \"magic\" } ] }";
  for (const std::string& bad : {folder / "bad.ply", folder / "bad.json", folder / "missing.ply", folder / "what"}) {
    session.open(bad);
    ASSERT_TRUE(until(session, [&] { return !session.job(); }));
    EXPECT_NE(errors_of(session).find(bad), std::string::npos);
    EXPECT_TRUE(session.project() == project);
    EXPECT_EQ(session.input_path(), input());
  }
  session.set_setting(0, "nodes", -5.0);
  EXPECT_NE(errors_of(session), "");
  session.set_setting(0, "nonsense", 5.0);
  EXPECT_NE(errors_of(session), "");
  EXPECT_TRUE(session.project() == project);
}

TEST_F(EditorSession, ReadingIsCancelledAndReplaced) {
  fix_and_hold();
  Shape big = bar();
  const std::vector<Vec3> part = big.positions;
  for (int copy = 1; copy < 200; ++copy)
    for (const Vec3& p : part) big.positions.emplace_back(p + Vec3(0, copy, 0));
  io::write(folder / "big.xyz", big, true);
  session.open(folder / "big.xyz");
  session.cancel_job();
  ASSERT_TRUE(until(session, [&] { return !session.job(); }));
  EXPECT_EQ(session.input_path(), input());
  EXPECT_EQ(errors_of(session), "");
  session.open(folder / "big.xyz");
  session.open(input());
  ASSERT_TRUE(until(session, [&] { return !session.job() && session.project().layers.empty(); }));
  EXPECT_EQ(session.input_path(), input());
}

TEST_F(EditorSession, SelectionGrowsInTheBackground) {
  fix_and_hold();
  session.select(points_where(session, [](const Vec3& p) { return p.x() < 0.3; }), SelectMode::Replace);
  const std::size_t before = session.selection().count();
  session.grow_selection();
  ASSERT_TRUE(until(session, [&] { return session.selection().count() > before; }));
  session.shrink_selection();
  EXPECT_EQ(session.selection().count(), before);
  session.select_connected();
  EXPECT_EQ(session.selection().count(), session.input()->size());
  session.invert_selection();
  EXPECT_TRUE(session.selection().empty());
}

TEST_F(EditorSession, AHandleAloneIsToldWhatItNeeds) {
  open_bar();
  EXPECT_TRUE(session.hints().empty());
  session.select(points_where(session, [](const Vec3& p) { return p.x() > 0.9; }), SelectMode::Replace);
  session.mark_selection(Mark::Handle);
  ASSERT_FALSE(session.hints().empty());
  EXPECT_NE(session.hints()[0].text.find("fixed"), std::string::npos);
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by({0, 0.1, 0}));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  EXPECT_LE(distance(command_line(), bent_of(session)), 1e-12);
}

TEST(EditorMotion, DragsAddUp) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> x(-1, 1);
  const Vec3 origin(1000, 0, 0);
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 2, 0.5}};
  const Vec3 centre = (points[0] + points[1] + points[2]) / 3;
  document::Motion matrix, given;
  matrix.matrix = Eigen::Matrix4d::Identity();
  (*matrix.matrix)(0, 3) = 0.5;
  given.to = document::Shared<Vec3>({{1000, 1, 0}, {1001, 1, 0}, {1002, 1, 0}});
  document::Motion turned;
  turned.rotate = document::Rotation{{0, 0, 2}, 30, std::nullopt};
  for (document::Motion motion : {document::Motion{}, matrix, given, turned}) {
    for (int i = 0; i < 20; ++i) {
      Transform by =
          turn_by(Vec3(x(random), x(random), x(random)).normalized(), 170 * x(random), {x(random), x(random), 1});
      by.move = {x(random), x(random), x(random)};
      if (i % 3 == 0) by.degrees = 0;
      if (i % 4 == 1) by.stretch = Vec3(1.2, 0.9, 1).asDiagonal();
      const std::vector<Vec3> before = document::targets_of(motion, points, origin);
      motion = moved(motion, by, centre, origin);
      const std::vector<Vec3> after = document::targets_of(motion, points, origin);
      for (std::size_t k = 0; k < points.size(); ++k) EXPECT_LT((after[k] - by(before[k])).norm(), 1e-8);
    }
  }
  const Transform half = turn_by(Vec3::UnitY(), 120, {0, 0, 3});
  const document::Motion far = moved(moved({}, half, centre, origin), half, centre, origin);
  ASSERT_TRUE(far.rotate);
  EXPECT_EQ(far.rotate->degrees, 240) << "turns about one axis are counted on";
  const document::Motion moves =
      moved(moved({}, move_by({0, 0, 1}), centre, origin), move_by({0, 1, 0}), centre, origin);
  EXPECT_FALSE(moves.rotate || moves.matrix);
  EXPECT_EQ(*moves.move, Vec3(0, 1, 1));
}

}  // namespace sinew::editor
