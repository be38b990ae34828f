/// What a session shows by colours and ghosts, what it copies as a command line, and what an export would lose.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "apps/editor/coloring.h"
#include "apps/editor/command_line.h"
#include "apps/editor/export_notes.h"
#include "apps/editor/legend.h"
#include "apps/editor/onion.h"
#include "apps/editor/portraits.h"
#include "apps/editor/session.h"
#include "apps/editor/view.h"
#include "deformers/methods.h"
#include "engine/document/evaluate.h"
#include "engine/gpu/png.h"
#include "engine/io/io.h"
#include "tests/apps/editor_session.h"
#include "tests/apps/program.h"
#include "tests/io/temporary_folder.h"

namespace sinew::editor {

namespace {

using document::FieldKind;
using document::ValueRange;

/// A bar along x, `n` points, at a frame of a swing; with an intensity from -1 to 3.
Shape bar_at(int frame, int along = 40) {
  Shape shape;
  Attribute intensity;
  intensity.name = "intensity";
  intensity.fields = {"intensity"};
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        const double x = static_cast<double>(i) / along;
        shape.positions.emplace_back(x, 0.04 * j + 0.05 * (frame - 1) * std::max(0.0, x - 0.5), 0.04 * k);
      }
  intensity.values.resize(shape.size() * intensity.row_size());
  for (std::size_t i = 0; i < shape.size(); ++i)
    intensity.set_number(i, 0, -1 + 4 * static_cast<double>(i) / static_cast<double>(shape.size() - 1));
  shape.attributes.push_back(std::move(intensity));
  return shape;
}

class EditorSeeing : public ::testing::Test {
 protected:
  void open_still(int along = 40) {
    io::write(folder / "bar.ply", bar_at(1, along), true);
    session.open(folder / "bar.ply");
    ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
    mark_ends();
  }

  void open_run(int frames) {
    for (int frame = 1; frame <= frames; ++frame)
      io::write(folder / ("run.000" + std::to_string(frame) + ".ply"), bar_at(frame), true);
    session.open(folder / "run.####.ply");
    ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
    mark_ends();
  }

  void mark_ends() {
    mark(Mark::Fixed, [](const Vec3& p) { return p.x() < 0.1; });
    session.set_setting(0, "nodes", 40.0);
    mark(Mark::Handle, [](const Vec3& p) { return p.x() > 0.9; });
    ASSERT_TRUE(settle(session)) << errors_of(session);
  }

  void mark(Mark what, const std::function<bool(const Vec3&)>& in) { mark_where(session, what, in); }

  void move_handle(const Vec3& by) {
    ASSERT_TRUE(session.begin_drag(0));
    session.drag_to(move_by(by));
  }

  /// Updates until the colours are those of the pose that is shown.
  bool painted() {
    std::uint64_t quiet = 0;
    return until(session, [&] {
      quiet = painter.update(session, view) || painter.busy() ? 0 : quiet + 1;
      return quiet > 2;
    });
  }

  TemporaryFolder folder;
  Session session{methods()};
  View view;
  Painter painter;
};

std::vector<document::LayerResult> shown_of(const Session& session) {
  return session.shown();
}

}  // namespace

TEST(EditorLegend, ReachesAsFarAsThereIsSomethingToDragInto) {
  const ValueRange usual{0, 8}, extent{-1, 100};
  EXPECT_EQ(legend_domain(usual, usual, extent), (ValueRange{-1, 10}));
  EXPECT_EQ(legend_domain({0, 40}, usual, extent), (ValueRange{-1, 40}));
  const ValueRange one = legend_domain({3, 3}, {3, 3}, {3, 3});
  EXPECT_LT(one.low, 3);
  EXPECT_GT(one.high, 3);
  EXPECT_EQ(value_at({2, 4}, place_of({2, 4}, 2.5)), 2.5);
}

TEST(EditorLegend, ItsEndsAreDraggedAloneOrTogether) {
  const ValueRange domain{0, 10}, range{2, 8};
  EXPECT_EQ(legend_part(domain, range, 0.22, 0.03), LegendPart::Low);
  EXPECT_EQ(legend_part(domain, range, 0.79, 0.03), LegendPart::High);
  EXPECT_EQ(legend_part(domain, range, 0.5, 0.03), LegendPart::Both);
  EXPECT_EQ(legend_part(domain, range, 0.05, 0.03), LegendPart::None);
  EXPECT_EQ(dragged(range, LegendPart::High, 0.1, domain, false), (ValueRange{2, 9}));
  EXPECT_EQ(dragged(range, LegendPart::High, 5, domain, false), (ValueRange{2, 10}));
  EXPECT_EQ(dragged(range, LegendPart::High, -5, domain, false), (ValueRange{2, 2.1}));
  EXPECT_EQ(dragged(range, LegendPart::Low, -5, domain, false), (ValueRange{0, 8}));
  EXPECT_EQ(dragged(range, LegendPart::Both, 0.5, domain, false), (ValueRange{4, 10}));
  EXPECT_EQ(dragged({-4, 4}, LegendPart::Low, 0.1, {-5, 5}, true), (ValueRange{-3, 3})) << "0 stays in the middle";
}

TEST(EditorLegend, TicksAreRoundAndTheirTextAsFineAsTheyAre) {
  const Ticks ticks = ticks_of({-0.31, 1.02}, 6);
  EXPECT_NEAR(ticks.step, 0.5, 1e-12);
  ASSERT_EQ(ticks.values.size(), 3U);
  EXPECT_EQ(tick_text(ticks.values[0], ticks.step), "0.0");
  EXPECT_EQ(tick_text(-1500, 500), "-1500");
  EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_text(2.5e-7, 5e-8), "2.5e-07");
  std::mt19937 random(2);
  std::uniform_real_distribution<double> exponent(-9, 9);
  for (int i = 0; i < 500; ++i) {
    const double low = std::pow(10, exponent(random)) * (i % 2 == 0 ? 1 : -1);
    const ValueRange domain{low, low + std::pow(10, exponent(random))};
    const Ticks found = ticks_of(domain, 6);
    EXPECT_LE(found.values.size(), 7U);
    for (const double value : found.values) {
      EXPECT_GE(value, domain.low - 1e-6 * (domain.high - domain.low));
      EXPECT_LE(value, domain.high + 1e-6 * (domain.high - domain.low));
    }
  }
}

TEST_F(EditorSeeing, AttributesTakeAnyMapAndRange) {
  open_still();
  view.color_by = "intensity";
  ASSERT_TRUE(painter.update(session, view));
  ASSERT_TRUE(painter.coloring().field);
  EXPECT_NEAR(painter.coloring().range.low, -0.96, 0.01);
  EXPECT_NEAR(painter.coloring().range.high, 2.96, 0.01);
  EXPECT_FALSE(painter.update(session, view)) << "nothing changed";
  const auto first = painter.coloring().colors.front(), last = painter.coloring().colors.back();
  EXPECT_EQ(first.r, gpu::color_at(gpu::Colormap::Viridis, 0).r);
  EXPECT_EQ(last.r, gpu::color_at(gpu::Colormap::Viridis, 1).r);
  view.colormap = gpu::Colormap::CoolWarm;
  ASSERT_TRUE(painter.update(session, view));
  EXPECT_EQ(painter.coloring().range.low, -painter.coloring().range.high) << "0 is in the middle";
  view.color_range = ValueRange{100, 200};
  ASSERT_TRUE(painter.update(session, view));
  EXPECT_EQ(painter.coloring().colors.back().b, gpu::color_at(gpu::Colormap::CoolWarm, 0).b);
  view.color_by = "";
  ASSERT_TRUE(painter.update(session, view));
  EXPECT_FALSE(painter.coloring().field);
}

TEST_F(EditorSeeing, HeatMapsFollowADrag) {
  open_still();
  view.heat = FieldKind::Displacement;
  ASSERT_TRUE(painted());
  EXPECT_NEAR(painter.coloring().range.high, 0, 1e-9);
  move_handle(Vec3(0, 0.3, 0));
  ASSERT_TRUE(until(session, [&] { return session.shown_ticket() == session.asked(); }));
  ASSERT_TRUE(painted());
  const std::vector<float>& values = painter.coloring().field->values;
  const std::span<const Vec3> bent = session.bent_positions();
  for (std::size_t i = 0; i < values.size(); i += 37)
    EXPECT_NEAR(values[i], (bent[i] - session.input()->positions[i]).norm(), 1e-6);
  EXPECT_GT(painter.coloring().range.high, 0.2);
  session.end_drag();
  ASSERT_TRUE(settle(session));
  for (const FieldKind kind : {FieldKind::Stretch, FieldKind::Rotation, FieldKind::Energy}) {
    view.heat = kind;
    ASSERT_TRUE(painted());
    const document::Field wanted = document::field_of(kind, session.input()->positions, shown_of(session));
    EXPECT_EQ(painter.coloring().field->values, wanted.values) << wanted.name;
    EXPECT_GT(painter.coloring().range.high, 0) << wanted.name;
  }
  EXPECT_EQ(painter.coloring().map, gpu::Colormap::Viridis);
  view.heat = FieldKind::Stretch;
  ASSERT_TRUE(painted());
  EXPECT_EQ(painter.coloring().map, gpu::Colormap::CoolWarm);
}

TEST_F(EditorSeeing, InfluenceIsThatOfTheChosenHandleOrOfTheClickedPoint) {
  open_still();
  view.heat = FieldKind::Influence;
  session.choose_handle({});
  EXPECT_FALSE(influencing_map(session, view));
  view.clicked = 0;
  const std::optional<Index> clicked = influencing_map(session, view);
  ASSERT_TRUE(clicked);
  ASSERT_TRUE(painted());
  const auto strongest = [&] {
    const std::vector<float>& values = painter.coloring().field->values;
    const auto at = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
    return session.input()->positions[at].x() + session.input()->origin.x();
  };
  EXPECT_LT(strongest(), 0.3) << "near the end that was clicked";
  session.choose_handle(0);
  EXPECT_NE(influencing_map(session, view), clicked);
  ASSERT_TRUE(painted());
  EXPECT_GT(strongest(), 0.7) << "near the handle";
}

// The window's thread only starts the work and takes its colours.
TEST_F(EditorSeeing, HeatMapsOfManyPointsCostAPictureLittle) {
  open_still(2200);  // 79,236 points
  for (const FieldKind kind : {FieldKind::Displacement, FieldKind::Stretch, FieldKind::Rotation, FieldKind::Energy}) {
    view.heat = kind;
    ASSERT_TRUE(painted());
    move_handle(Vec3(0, 0.1, 0));
    std::vector<double> times;
    for (int step = 0; step < 12; ++step) {
      session.drag_to(move_by(Vec3(0, 0.1 + 0.01 * step, 0)));
      until(session, [&] { return session.shown_ticket() == session.asked(); });
      const double begin = seconds_now();
      painter.update(session, view);
      times.push_back(1000 * (seconds_now() - begin));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::sort(times.begin(), times.end());
    const double begin = seconds_now();
    document::field_of(kind, session.input()->positions, session.shown());
    std::printf("%s of %zu points: %.2f ms of the window's thread (median), %.1f ms in the background\n",
                document::field_names[static_cast<std::size_t>(kind)], session.input()->size(), times[times.size() / 2],
                1000 * (seconds_now() - begin));
    session.cancel_drag();
    ASSERT_TRUE(settle(session));
    EXPECT_LT(times[times.size() / 2], 10);
  }
}

TEST(EditorOnion, FramesLieOnBothSidesNearestFirst) {
  const std::vector<int> frames{1, 2, 3, 4, 6, 8, 10};
  using Pairs = std::vector<std::pair<int, int>>;
  EXPECT_EQ(onion_frames(frames, 4, 2, 1), (Pairs{{-1, 3}, {1, 6}, {-2, 2}, {2, 8}}));
  EXPECT_EQ(onion_frames(frames, 1, 2, 3), (Pairs{{1, 4}, {2, 10}}));
  EXPECT_EQ(onion_frames(frames, 10, 1, 2), (Pairs{{-1, 6}}));
}

TEST_F(EditorSeeing, GhostsAreTheBentFramesAroundAndGoWhileSomethingMoves) {
  open_run(7);
  move_handle(Vec3(0, 0.2, 0));
  session.end_drag();
  session.go_to_frame(4);
  ASSERT_TRUE(settle(session));
  OnionSkin onion;
  EXPECT_FALSE(onion.update(session, view));
  view.show_onion = true;
  view.onion_frames = 2;
  view.onion_step = 1;
  ASSERT_TRUE(until(session, [&] {
    onion.update(session, view);
    return onion.ghosts().size() == 4;
  }));
  document::Workspace workspace(session.sequence(), session.methods());
  for (const OnionSkin::Ghost& ghost : onion.ghosts()) {
    const document::Evaluation expected = document::evaluate(workspace, session.project().layers, ghost.frame);
    EXPECT_EQ(ghost.shape->positions, expected.shape->positions) << ghost.frame;
    EXPECT_EQ(ghost.frame - 4, ghost.away);
  }
  session.go_to_frame(6);
  EXPECT_TRUE(onion.update(session, view)) << "they go at once";
  EXPECT_TRUE(onion.ghosts().empty());
  ASSERT_TRUE(settle(session));
  ASSERT_TRUE(until(session, [&] {
    onion.update(session, view);
    return onion.ghosts().size() == 3;  // 5, 7, 4
  }));
  ASSERT_TRUE(session.begin_drag(0));
  EXPECT_TRUE(onion.update(session, view));
  EXPECT_TRUE(onion.ghosts().empty());
  session.cancel_drag();
}

TEST_F(EditorSeeing, PlaysItsRangeAndNoMore) {
  open_run(7);
  session.set_play_range(std::pair(3, 5));
  EXPECT_EQ(session.play_range(), std::pair(3, 5));
  session.play(true);
  std::vector<int> seen;
  ASSERT_TRUE(until(session, [&] {
    if (seen.empty() || seen.back() != session.frame()) seen.push_back(session.frame());
    return seen.size() > 8;
  }));
  session.play(false);
  for (std::size_t i = 1; i < seen.size(); ++i) {
    EXPECT_GE(seen[i], 3);
    EXPECT_LE(seen[i], 5);
  }
  session.set_looping(false);
  session.go_to_frame(7);
  session.play(true);
  EXPECT_EQ(session.wanted_frame(), 3) << "from beyond the range it begins again";
  ASSERT_TRUE(until(session, [&] { return !session.playing(); }));
  EXPECT_EQ(session.wanted_frame(), 5);
  session.set_play_range(std::pair(100, 200));
  EXPECT_EQ(session.play_range(), std::pair(1, 7)) << "a range of another clip";
}

// A drag that time is moved under is kept: as a step of history, with a key at the frame where it was made.
TEST_F(EditorSeeing, ScrubbingNeverLosesAnEdit) {
  open_run(7);
  std::mt19937 random(7);
  for (int round = 0; round < 40; ++round) {
    const int at = 1 + static_cast<int>(random() % 7), to = 1 + static_cast<int>(random() % 7);
    session.go_to_frame(at);
    const Vec3 by(0, 0.01 * (1 + static_cast<double>(random() % 9)), 0);
    until(session, [&] { return session.frame() == at || random() % 50 == 0; });
    const int shown = session.frame();
    const document::Project before = session.project();
    const std::size_t step = session.history().position();
    const Vec3 rested = session.handles()[0].target;
    move_handle(by);
    if (random() % 2 == 0) session.poll();
    if (round % 5 == 4)
      session.play(true);
    else
      session.go_to_frame(to == shown ? 1 + to % 7 : to);
    EXPECT_FALSE(session.dragging());
    ASSERT_EQ(session.history().position(), step + 1) << "round " << round;
    ASSERT_NE(session.project(), before);
    session.play(false);
    session.go_to_frame(shown);
    ASSERT_TRUE(settle(session)) << errors_of(session);
    EXPECT_LT((session.handles()[0].target - rested - by).norm(), 1e-9) << "round " << round;
    const document::Project kept = session.project();
    session.undo();
    EXPECT_EQ(session.project(), before);
    session.redo();
    EXPECT_EQ(session.project(), kept);
  }
}

TEST(EditorCommandLine, QuotesForAShell) {
  EXPECT_EQ(shell_word("/a/b-1.ply"), "/a/b-1.ply");
  EXPECT_EQ(shell_word("/my scans/it's $HOME.ply"), "'/my scans/it'\\''s $HOME.ply'");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("walk.####.obj"), "'walk.####.obj'");
}

TEST(EditorCommandLine, WritesBesideTheInput) {
  EXPECT_EQ(bent_name("/a/bunny.ply", false), "/a/bunny-bent.ply");
  EXPECT_EQ(bent_name("/a/walk.####.obj", true), "/a/walk-bent.####.obj");
  EXPECT_EQ(bent_name("/a/walk_%04d.obj", true), "/a/walk-bent_%04d.obj");
  EXPECT_EQ(bent_name("/a/walk.pc2", true), "/a/walk-bent.pc2");
  EXPECT_EQ(bent_name("/a/body.obj", true), "/a/body-bent.pc2") << "a still that a motion drives";
}

// Any edit: the line is given to a shell, in a folder whose name needs quotes, and comes to the session's points.
TEST_F(EditorSeeing, TheCopiedCommandLineDoesTheSame) {
  const std::string place = folder / "it's a folder";
  std::filesystem::create_directories(place);
  const std::string program = shell_word(SINEW_BINARY_DIR "/bin/sinew");
  for (const int frames : {1, 3}) {
    const std::string name = place + (frames == 1 ? "/my bar.ply" : "/run.%04d.ply");
    for (int frame = 1; frame <= frames; ++frame)
      io::write(frames == 1 ? name : place + "/run.000" + std::to_string(frame) + ".ply", bar_at(frame), true);
    session.open(name);
    ASSERT_TRUE(until(session, [&] { return session.has_input() && session.input_path() == name; }))
        << errors_of(session);
    mark_ends();
    move_handle(Vec3(0.02, 0.2, 0.1));
    session.end_drag();
    ASSERT_TRUE(settle(session));
    EXPECT_EQ(command_line_of(session, program), "") << "no file of the edit yet";
    session.save_edit(place + "/an edit.json");
    ASSERT_TRUE(until(session, [&] { return !session.dirty(); })) << errors_of(session);
    const std::string line = command_line_of(session, program);
    ASSERT_EQ(std::system((line + " 2>/dev/null").c_str()), 0) << line;
    const std::string out = frames == 1 ? place + "/my bar-bent.ply" : place + "/run-bent.0001.ply";
    const std::shared_ptr<const Shape> bent = io::read(out);
    session.go_to_frame(1);
    ASSERT_TRUE(settle(session));
    const std::span<const Vec3> positions = session.bent_positions();
    ASSERT_EQ(bent->size(), positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
      EXPECT_LT((bent->positions[i] + bent->origin - positions[i] - session.input()->origin).norm(), 1e-6);
  }
}

TEST_F(EditorSeeing, TheCopiedCommandLineOfASetOfScansWritesThemToAFolder) {
  for (const std::string name : {"a.ply", "b.ply"}) io::write(folder / name, bar_at(1, 20), true);
  const std::string conf = "bmesh a.ply 0 0 0 0 0 0 1\nbmesh b.ply 0 0 0.5 0 0 0 1\n";
  io::save_bytes(folder / "scans.conf", std::as_bytes(std::span(conf)), true);
  session.open(folder / "scans.conf");
  ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
  mark_ends();
  move_handle(Vec3(0, 0.2, 0));
  session.end_drag();
  session.save_edit(folder / "edit.json");
  ASSERT_TRUE(until(session, [&] { return !session.dirty(); })) << errors_of(session);
  const std::string line = command_line_of(session, shell_word(SINEW_BINARY_DIR "/bin/sinew"));
  ASSERT_EQ(std::system((line + " 2>/dev/null").c_str()), 0) << line;
  const std::shared_ptr<const Shape> bent = io::read(folder / "scans-bent/scans.conf");
  const std::span<const Vec3> positions = session.bent_positions();
  ASSERT_EQ(bent->size(), positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    EXPECT_LT((bent->positions[i] + bent->origin - positions[i] - session.input()->origin).norm(), 1e-5);
}

TEST_F(EditorSeeing, AnExportIsToldBeforeWhatItLoses) {
  Shape shape = bar_at(1);
  const Index corners[] = {0, 1, 6};
  shape.faces.add(corners);
  const auto kept = std::make_shared<const Shape>(shape);
  const Sequence alone = still(kept);
  EXPECT_TRUE(export_notes(folder / "a.ply", *kept, alone, 1).empty());
  const auto joined = [](const std::vector<std::string>& notes) {
    std::string out;
    for (const std::string& note : notes) out += note + "\n";
    return out;
  };
  EXPECT_NE(joined(export_notes(folder / "a.obj", *kept, alone, 1)).find("intensity"), std::string::npos);
  EXPECT_TRUE(export_notes(folder / "a.nothing", *kept, alone, 1).empty());
  Sequence run;
  run.frames = {1, 2, 3};
  run.load = [kept](int) { return kept; };
  const std::string one = joined(export_notes(folder / "a.ply", *kept, run, 2));
  EXPECT_EQ(one, "Only frame 2 of 3 is written; a name with #### before its ending writes all of them.\n");
  EXPECT_TRUE(export_notes(folder / "a.####.ply", *kept, run, 2).empty());
  EXPECT_NE(joined(export_notes(folder / "a.pc2", *kept, run, 2)).find("1 face"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "")) << "nothing is written";
  // What is told is what the export then says.
  session.adopt(kept, folder / "bar.ply");
  ASSERT_TRUE(settle(session));
  session.export_shape(folder / "a.obj");
  ASSERT_TRUE(until(session, [&] { return std::filesystem::exists(folder / "a.obj") && !session.job(); }));
  EXPECT_EQ(session.lost(), export_notes(folder / "a.obj", *kept, alone, 1));
}

TEST_F(EditorSeeing, PortraitsShowTheBentShapeFromEverySide) {
  open_still();
  painter.update(session, view);
  const auto draw = [&](const std::string& name) {
    Portrait portrait = portrait_of(session, view, painter.coloring(), gpu::dark_look());
    portrait.width = 200;
    portrait.height = 120;
    portrait.ground = false;
    portrait.point_size = 4;
    gpu::Camera camera;
    gpu::look_from(camera, "front", gpu::UpAxis::Y);
    gpu::frame_bounds(camera, session.rest_bounds(), 200.0 / 120, 0.6);
    int number = 0;
    for (const gpu::Camera& from :
         gpu::cameras_around(camera, gpu::UpAxis::Y, 2, 180, session.rest_bounds(), 200.0 / 120, 0))
      portrait.pictures.emplace_back(from, (folder / "new folder/") + name + std::to_string(++number) + ".png");
    draw_portrait(portrait, [](double) { return true; });
    return gpu::read_png((folder / "new folder/") + name + "1.png");
  };
  const gpu::Picture rest = draw("rest");
  EXPECT_TRUE(std::filesystem::exists(folder / "new folder/rest2.png"));
  move_handle(Vec3(0, 0.3, 0));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  const gpu::Picture bent = draw("bent");
  const auto height_of = [](const gpu::Picture& picture, int x) {
    for (int y = 0; y < picture.height; ++y)
      if (picture.at(x, y)[0] > 100) return y;
    return picture.height;
  };
  const int right = 135;
  EXPECT_LT(height_of(bent, right), height_of(rest, right) - 4) << "the right end has gone up";
}

TEST_F(EditorSeeing, APortraitStopsWhenItIsTold) {
  open_still();
  painter.update(session, view);
  Portrait portrait = portrait_of(session, view, painter.coloring(), gpu::dark_look());
  portrait.width = portrait.height = 32;
  for (int i = 0; i < 5; ++i) portrait.pictures.emplace_back(gpu::Camera{}, folder / (std::to_string(i) + ".png"));
  int asked = 0;
  EXPECT_THROW(draw_portrait(portrait, [&](double) { return ++asked < 3; }), io::Cancelled);
  EXPECT_TRUE(std::filesystem::exists(folder / "1.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "2.png"));
}

TEST(EditorPortraits, PicturesOfRecentFilesAreKeptInTheCacheAndForgotten) {
  const TemporaryFolder folder;
  const char* before = std::getenv("XDG_CACHE_HOME");
  const std::string saved = before == nullptr ? "" : before;
  setenv("XDG_CACHE_HOME", (folder / "").c_str(), 1);
  const std::string a = picture_path("/a.ply"), b = picture_path("/b.ply");
  EXPECT_NE(a, b);
  EXPECT_EQ(a.find(folder / "sinew/pictures/"), 0U);
  std::filesystem::create_directories(folder / "sinew/pictures");
  for (const std::string& path : {a, b}) io::save_bytes(path, {}, true);
  forget_pictures({"/b.ply"});
  EXPECT_FALSE(std::filesystem::exists(a));
  EXPECT_TRUE(std::filesystem::exists(b));
  before == nullptr ? unsetenv("XDG_CACHE_HOME") : setenv("XDG_CACHE_HOME", saved.c_str(), 1);
}

}  // namespace sinew::editor
