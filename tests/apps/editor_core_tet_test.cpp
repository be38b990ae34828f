/// Layers of the method tet in a session: made, dragged, marked rigid and stiff, twisted by whole turns, saved.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "apps/editor/commands.h"
#include "apps/editor/session.h"
#include "apps/samples/meshes.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/io/io.h"
#include "shaders/shared.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"

namespace sinew::editor {

namespace {

/// What the session keeps saying is wrong.
std::string failure_of(const Session& session) {
  for (const Notice& hint : session.hints())
    if (hint.severity == Severity::Error) return hint.text;
  return {};
}

/// Processes that threads of this one have started.
std::string children() {
  std::string out;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "children");
    std::string text;
    std::getline(file, text);
    out += text;
  }
  return out;
}

/// A closed bar of 0.5 x 1.65 x 0.5 along y.
class EditorTet : public ::testing::Test {
 protected:
  /// With so many vertices the points of the bar are vertices of tets.
  void open(const Shape& shape, double vertices = 10'000) {
    io::write(input(), shape, true);
    session.open(input());
    ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
    session.add_layer("tet");
    session.set_setting(0, "vertices", vertices);
    session.set_setting(0, "filling", "inside");
  }
  void select_between(double low, double high) {
    PointSet out(session.input()->size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double y = session.input()->positions[i].y() + session.input()->origin.y();
      if (y >= low && y <= high) out.add(i);
    }
    session.select(out, SelectMode::Replace);
  }
  void fix_and_hold() {
    open(samples::bar());
    select_between(-1, 0.08);
    session.mark_selection(Mark::Fixed);
    select_between(1.57, 2);
    session.mark_selection(Mark::Handle);
    ASSERT_TRUE(settle(session));
    ASSERT_EQ(errors_of(session), "");
  }
  Vec3 centre_of_handle() { return session.handles()[0].target; }

  /// How far the handle's and the middle's points are turned about y, degrees, of the first point that is away from it.
  double turned_at(double height) {
    double sine = 0, cosine = 0;
    const std::span<const Vec3> bent = session.bent_positions();
    const Vec3 origin = session.input()->origin;
    for (std::size_t i = 0; i < bent.size(); ++i) {
      const Vec3 a = session.input()->positions[i] + origin, b = bent[i] + origin;
      if (std::abs(a.y() - height) > 0.02) continue;
      sine += a.z() * b.x() - a.x() * b.z();
      cosine += a.x() * b.x() + a.z() * b.z();
    }
    return std::atan2(sine, cosine) * 180 / M_PI;
  }

  double from_command_line() {
    session.save_edit(edit());
    EXPECT_TRUE(until(session, [&] { return !session.dirty() && !session.job(); })) << errors_of(session);
    const document::Project project = document::read_edit(edit());
    EXPECT_TRUE(project == session.project()) << "the saved edit reads back as another";
    const std::vector<Vec3> there =
        document::evaluate(io::read(input()), project.layers, sinew::methods()).shape->positions;
    double out = 0;
    const std::span<const Vec3> here = session.bent_positions();
    for (std::size_t i = 0; i < here.size(); ++i) out = std::max(out, (here[i] - there[i]).norm());
    return out;
  }

  std::string input() const { return folder / "bar.ply"; }
  std::string edit() const { return folder / "edit.json"; }

  TemporaryFolder folder;
  Session session{sinew::methods()};
};

}  // namespace

TEST_F(EditorTet, FollowsADragLiveAndEndsWhereTheCommandLineDoes) {
  fix_and_hold();
  const std::uint64_t before = session.bent_version();
  ASSERT_TRUE(session.begin_drag(0));
  for (int step = 1; step <= 3; ++step) {
    session.drag_to(move_by(Vec3(0.1 * step, 0, 0)));
    const std::uint64_t ticket = session.asked();
    ASSERT_TRUE(until(session, [&] { return session.shown_ticket() == ticket; }));
    select_between(1.57, 2);
    EXPECT_NEAR(session.selection_bounds().centre().x(), session.rest_bounds().centre().x() + 0.1 * step, 0.02);
  }
  EXPECT_GT(session.bent_version(), before);
  session.end_drag();
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
  EXPECT_LT(from_command_line(), 1e-5);
}

TEST_F(EditorTet, ATypedTurnByMoreThanHalfATurnTwistsByIt) {
  fix_and_hold();
  View view;
  session.choose_handle(0);
  ASSERT_TRUE(begin_manipulation(session, view, GizmoKind::Rotate, GizmoPart::Screen, true));
  for (const int key : {static_cast<int>('Y'), static_cast<int>('3'), static_cast<int>('0'), static_cast<int>('0')}) {
    ASSERT_TRUE(view.manipulation->press(key, 0));
    follow_manipulation(session, view);
  }
  const std::uint64_t ticket = session.asked();
  ASSERT_TRUE(until(session, [&] { return session.shown_ticket() == ticket; }));
  EXPECT_NEAR(turned_at(0.825), 150, 25) << "while dragging";
  view.manipulation->press(key::enter, 0);
  follow_manipulation(session, view);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
  const document::Motion& motion = session.layer()->handles[0].motion;
  ASSERT_TRUE(motion.rotate.has_value());
  EXPECT_DOUBLE_EQ(motion.rotate->degrees, 300);
  // The middle is turned by half of it, not by half of what is left to a whole turn.
  EXPECT_NEAR(turned_at(1.6), -60, 1);
  EXPECT_NEAR(turned_at(0.825), 150, 12);
  EXPECT_NEAR(turned_at(0.4125), 67, 15);
  EXPECT_LT(from_command_line(), 1e-5);

  // Part of the end as a handle of its own goes on from there.
  select_between(1.6, 2);
  session.mark_selection(Mark::Handle);
  const document::Motion& part = session.layer()->handles.back().motion;
  ASSERT_TRUE(part.rotate.has_value());
  EXPECT_NEAR(part.rotate->degrees * part.rotate->axis.normalized().y(), 300, 1);
}

TEST_F(EditorTet, TurnsAddUpAcrossDrags) {
  fix_and_hold();
  const Vec3 pivot = centre_of_handle();
  for (int drag = 0; drag < 3; ++drag) {
    ASSERT_TRUE(session.begin_drag(0));
    session.drag_to(turn_by(Vec3::UnitY(), 100, pivot));
    const std::uint64_t ticket = session.asked();
    ASSERT_TRUE(until(session, [&] { return session.shown_ticket() == ticket; }));
    session.end_drag();
    ASSERT_TRUE(settle(session));
  }
  // And a little about another axis does not lose what was wound.
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(turn_by(Vec3::UnitX(), 10, pivot));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  const document::Rotation& rotate = *session.layer()->handles[0].motion.rotate;
  EXPECT_NEAR(rotate.degrees * rotate.axis.normalized().y(), 300, 8);
  EXPECT_NEAR(std::abs(turned_at(0.825)), 150, 12);
}

TEST_F(EditorTet, MarksRigidAndStiff) {
  fix_and_hold();
  select_between(0.6, 1);
  const std::size_t count = session.selection().count();
  session.mark_selection(Mark::Rigid);
  session.mark_selection(Mark::Stiffer);
  session.mark_selection(Mark::Stiffer);
  select_between(0.6, 0.8);
  session.mark_selection(Mark::Softer);
  session.select_none();
  ASSERT_EQ(session.layer()->rigid.size(), 1u);
  ASSERT_EQ(session.layer()->stiffness.size(), 2u);
  const auto marked_rigid = [&] {
    const std::vector<std::uint8_t>& marks = session.point_marks();
    return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), gpu::shared::mark_rigid));
  };
  EXPECT_EQ(marked_rigid(), count);
  const std::vector<float> stiffness = session.point_stiffness();
  ASSERT_EQ(stiffness.size(), session.input()->size());
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const double y = session.input()->positions[i].y() + session.input()->origin.y();
    ASSERT_EQ(stiffness[i], y < 0.6 || y > 1 ? 1 : y <= 0.8 ? 2 : 4) << y;
  }
  session.select_rigid();
  EXPECT_EQ(session.selection().count(), count);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");

  // They steer the solve: a bend leaves the rigid part as it was.
  ASSERT_TRUE(session.begin_drag(0));
  session.drag_to(move_by(Vec3(0.5, -0.2, 0)));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  EXPECT_LT(from_command_line(), 1e-5);

  // Free takes all of it, undo brings it back.
  session.select_all();
  const document::Layer full = *session.layer();
  session.mark_selection(Mark::Free);
  EXPECT_TRUE(session.layer()->rigid.empty());
  EXPECT_TRUE(session.layer()->stiffness.empty());
  EXPECT_TRUE(session.layer()->handles.empty());
  EXPECT_TRUE(session.point_stiffness().empty());
  session.undo();
  EXPECT_TRUE(*session.layer() == full);

  // The middle of a region leaves a region; twice as soft as it was leaves nothing to say.
  select_between(0.7, 0.9);
  session.mark_selection(Mark::Free);
  EXPECT_LT(marked_rigid(), count);
  EXPECT_EQ(session.layer()->rigid.size(), 1u);
}

TEST_F(EditorTet, OfAMethodThatKnowsNoRigidRegionsTheCommandSaysSo) {
  session.adopt(std::make_shared<const Shape>(samples::bar()), input());
  ASSERT_TRUE(settle(session));
  session.select_all();
  View view;
  Preferences preferences;
  Context context{session, view, preferences, [](Request) {}};
  const Command* rigid = find_command("mark.rigid");
  const Command* stiffer = find_command("mark.stiffer");
  ASSERT_TRUE(rigid != nullptr && stiffer != nullptr);
  session.add_layer("graph");
  EXPECT_FALSE(rigid->enabled(context));
  EXPECT_FALSE(run_command(*stiffer, context));
  EXPECT_EQ(why_no_command_for('J', 0, context), "Rigid regions are for the method tet: this layer's is graph.");
  session.mark_selection(Mark::Rigid);  // past the command
  EXPECT_TRUE(session.layer()->rigid.empty());
  EXPECT_NE(errors_of(session), "");
  session.set_method(0, "tet");
  EXPECT_TRUE(rigid->enabled(context));
  EXPECT_EQ(why_no_command_for('J', 0, context), "");
  EXPECT_TRUE(run_command(*rigid, context));
  EXPECT_EQ(session.layer()->rigid.size(), 1u);
  // And the layer can't become one of a method that does not know it.
  session.set_method(0, "graph");
  EXPECT_EQ(session.layer()->method, "tet");
  EXPECT_NE(errors_of(session).find("rigid"), std::string::npos);
}

TEST_F(EditorTet, ALayerOfTetsTakesNoCut) {
  session.adopt(std::make_shared<const Shape>(samples::bar()), input());
  ASSERT_TRUE(settle(session));
  View view;
  Preferences preferences;
  Context context{session, view, preferences, [](Request) {}};
  const Command* cut = find_command("tool.cut");
  ASSERT_TRUE(cut != nullptr && cut->enabled(context));
  session.add_layer("tet");
  EXPECT_FALSE(cut->enabled(context));
  EXPECT_EQ(cut->why_not(context), "Cuts are for the method graph: this layer's is tet.");
  const std::vector<Vec3> path{Vec3(-1, 0.8, 1), Vec3(1, 0.8, 1)};
  session.add_cut(path, Vec3(0, 0, -2));  // past the command
  EXPECT_TRUE(session.layer()->cuts.empty());
  EXPECT_NE(errors_of(session).find("cuts"), std::string::npos);
  session.set_method(0, "graph");
  session.add_cut(path, Vec3(0, 0, -2));
  EXPECT_EQ(session.layer()->cuts.size(), 1u);
  session.set_method(0, "tet");
  EXPECT_EQ(session.layer()->method, "graph");
}

TEST_F(EditorTet, AnOpenShapeIsRefusedInOneSentenceAndTheOtherMethodBringsItBack) {
  open(samples::bumpy_plane());
  ASSERT_TRUE(until(session, [&] { return !session.solving(); }));
  const std::string errors = errors_of(session);
  EXPECT_NE(errors.find("hole"), std::string::npos) << errors;
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  EXPECT_EQ(failure_of(session) + "\n", errors);
  // Said once, though it is asked again.
  session.set_setting(0, "filling", "inside");
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
  EXPECT_FALSE(failure_of(session).empty());
  session.set_method(0, "graph");
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
  EXPECT_EQ(failure_of(session), "");
  ASSERT_EQ(session.shown().size(), 1u);
}

TEST_F(EditorTet, CancelStopsTheMakingOfTetsAndAnyChangeBeginsAnew) {
  open(samples::box({50, 160, 50}, Vec3(0.01, 0.01, 0.01)), 40'000);  // tets of which take more than a moment
  ASSERT_TRUE(until(session, [&] { return !children().empty(); })) << "sinew-tets was never seen";
  ASSERT_TRUE(until(session, [&] { return session.job() && session.job()->seconds > 0.2; }));
  EXPECT_EQ(session.job()->what, "Preparing the layer");
  ASSERT_TRUE(session.job()->can_cancel);
  const auto begin = std::chrono::steady_clock::now();
  session.cancel_job();
  ASSERT_TRUE(until(session, [&] { return !session.job() && children().empty(); }));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
  EXPECT_FALSE(session.solving());
  EXPECT_TRUE(session.shown().empty());
  EXPECT_NE(failure_of(session).find("cancelled"), std::string::npos) << failure_of(session);
  EXPECT_EQ(errors_of(session), "");

  session.set_setting(0, "vertices", 200.0);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(failure_of(session), "");
  ASSERT_EQ(session.shown().size(), 1u);
  EXPECT_FALSE(session.shown()[0].structure->tets.empty());
}

TEST(SolidFaces, ACutShowsTheFacesThatItLaysBare) {
  // Two tets on one face, apart along x.
  const std::vector<Vec3> rest{{0, 0, 0}, {1, 1, 0}, {1, -1, 1}, {1, -1, -1}, {2, 0, 0}};
  const std::vector<Tet> tets{{0, 1, 2, 3}, {4, 1, 2, 3}};
  const gpu::SolidFaces whole = gpu::faces_of(rest, tets, std::nullopt);
  EXPECT_EQ(whole.faces.size(), 6u);
  EXPECT_EQ(std::count(whole.inner.begin(), whole.inner.end(), true), 0);
  EXPECT_EQ(whole.edges.size(), 9u);
  const gpu::SolidFaces half = gpu::faces_of(rest, tets, gpu::Section{0, 0.5});
  ASSERT_EQ(half.faces.size(), 4u);
  for (std::size_t f = 0; f < 4; ++f) EXPECT_EQ(half.inner[f], (half.faces[f] == std::array<Index, 3>{1, 2, 3})) << f;
  EXPECT_EQ(half.edges.size(), 6u);
  EXPECT_TRUE(gpu::faces_of(rest, tets, gpu::Section{0, 0}).faces.empty());
  EXPECT_EQ(gpu::faces_of(rest, tets, gpu::Section{0, 1}).faces.size(), 6u);
  EXPECT_EQ(gpu::faces_of(rest, tets, gpu::Section{1, 1}).faces.size(), 6u);
  EXPECT_TRUE(gpu::faces_of({}, {}, gpu::Section{}).faces.empty());
}

TEST(SolidFaces, StifferIsRedderAndSofterGreener) {
  const gpu::PointColor plain{200, 200, 200, gpu::shared::mark_fixed};
  EXPECT_EQ(gpu::stiffness_color(plain, 1).g, 200);
  int redder = -256;  // red less green grows with the factor
  for (const double factor : {1.0 / 64, 1.0 / 4, 1.0 / 2, 1.0, 2.0, 16.0}) {
    const gpu::PointColor color = gpu::stiffness_color(plain, factor);
    EXPECT_EQ(color.marks, plain.marks);
    EXPECT_GT(color.r - color.g, redder) << factor;
    redder = color.r - color.g;
  }
  EXPECT_LT(gpu::stiffness_color(plain, 0.5).r, gpu::stiffness_color(plain, 0.5).g);
  EXPECT_GT(gpu::stiffness_color(plain, 2).r, gpu::stiffness_color(plain, 2).g);
  EXPECT_EQ(gpu::stiffness_color(plain, 1e9).r, gpu::stiffness_color(plain, 16).r);
}

}  // namespace sinew::editor
