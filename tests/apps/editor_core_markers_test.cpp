/// A motion in a session: frames, markers, alignment; opened with an edit or dropped onto a layer.

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
#include "tests/apps/bar_motion.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::editor {

namespace {

class EditorMarkers : public ::testing::Test {
 protected:
  EditorMarkers() { test::write_bar_motion(folder / ""); }

  void open(const std::string& path) {
    session.open(path);
    EXPECT_TRUE(until(session, [&] { return session.has_input() && !session.job(); }));
    EXPECT_TRUE(settle(session));
    for (const Notice& notice : session.take_notices()) {
      notices += notice.text + "\n";
      EXPECT_NE(notice.severity, Severity::Error) << notice.text;
    }
  }
  void drop(const std::string& path) {
    notices.clear();
    session.open(path);
    EXPECT_TRUE(until(session, [&] { return !session.job(); }));
    EXPECT_TRUE(settle(session));
    for (const Notice& notice : session.take_notices()) notices += notice.text + "\n";
  }
  /// The farthest that a point is from where `sinew deform` puts it at the frame shown.
  double apart(const std::string& input) {
    const std::vector<document::Layer>& layers = session.project().layers;
    const auto frames =
        std::make_shared<const Sequence>(document::with_frames_of_markers(io::open_sequence(input), layers));
    document::Workspace workspace(frames, sinew::methods());
    const auto bent = document::evaluate(workspace, layers, session.frame()).shape;
    const std::span<const Vec3> here = session.bent_positions();
    if (here.size() != bent->positions.size()) return 1e300;
    double out = 0;
    for (std::size_t i = 0; i < here.size(); ++i) out = std::max(out, (here[i] - bent->positions[i]).norm());
    return out;
  }

  TemporaryFolder folder;
  Session session{sinew::methods()};
  std::string notices;
};

}  // namespace

TEST_F(EditorMarkers, AnEditWithMarkersHasTheFramesOfItsMotionAndTheirShapes) {
  open(folder / "lean.json");
  EXPECT_NE(notices.find("lean.csv: E: 2 frames bridged (6-7)."), std::string::npos) << notices;
  EXPECT_EQ(session.frames().size(), 8u);
  EXPECT_EQ(session.frame(), 3);
  EXPECT_TRUE(session.moves());
  EXPECT_FALSE(session.dirty());
  for (const int frame : {3, 10, 5}) {
    session.go_to_frame(frame);
    ASSERT_TRUE(settle(session));
    EXPECT_EQ(session.frame(), frame);
    EXPECT_LE(apart(folder / "bar.obj"), 1e-6) << frame;
  }
  EXPECT_GT(session.bent_bounds().max.x(), session.rest_bounds().max.x() + 0.02);
  ASSERT_NE(session.markers(), nullptr);
  EXPECT_NEAR(session.markers()->scale(), 1e-3, 1e-9);

  session.export_shape(folder / "window.pc2");
  ASSERT_TRUE(until(session, [&] { return !session.job(); })) << errors_of(session);
  const Sequence written = io::open_sequence(folder / "window.pc2");
  EXPECT_EQ(written.frames.size(), 8u);
}

TEST_F(EditorMarkers, PlaysItsFrames) {
  open(folder / "lean.json");
  session.set_looping(false);
  session.play(true);
  std::vector<int> seen;
  ASSERT_TRUE(until(session, [&] {
    if (seen.empty() || seen.back() != session.frame()) seen.push_back(session.frame());
    return !session.playing();
  }));
  EXPECT_EQ(seen.front(), 3);
  EXPECT_EQ(seen.back(), 10);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));

  // An export ends it and has all frames.
  session.set_looping(true);
  session.play(true);
  session.export_shape(folder / "while.pc2");
  ASSERT_TRUE(until(session, [&] { return std::filesystem::exists(folder / "while.pc2"); })) << errors_of(session);
  EXPECT_FALSE(session.playing());
}

TEST_F(EditorMarkers, MarkersThatWereNotSeenAreToldApart) {
  open(folder / "lean.json");
  const auto counts = [&](int frame) {
    session.go_to_frame(frame);
    EXPECT_TRUE(settle(session));
    const std::vector<document::Markers::Picture> pictures = session.marker_pictures();
    EXPECT_EQ(pictures.size(), 1u);
    return std::pair{pictures[0].seen.size(), pictures[0].unseen.size()};
  };
  EXPECT_EQ(counts(3), (std::pair<std::size_t, std::size_t>{6, 0}));
  EXPECT_EQ(counts(6), (std::pair<std::size_t, std::size_t>{5, 1}));
  // Bridged: on its way, 0.06 to the right.
  const Vec3 origin = session.input()->origin;
  EXPECT_NEAR((session.marker_pictures()[0].unseen[0] + origin - Vec3(0.06, 1.05, 0.05)).norm(), 0, 1e-6);
  EXPECT_EQ(counts(9), (std::pair<std::size_t, std::size_t>{5, 1}));
  // Released at the end: where it was last seen, in frame 7.
  EXPECT_NEAR((session.marker_pictures()[0].unseen[0] + origin - Vec3(0.08, 0.95, 0)).norm(), 0, 1e-6);
}

TEST_F(EditorMarkers, AMotionThatIsDroppedDrivesTheLayerAndIsAlignedByHand) {
  open(folder / "bar.obj");
  drop(folder / "lean.csv");  // no layer yet: it makes one
  ASSERT_NE(session.layer(), nullptr) << notices;
  EXPECT_EQ(session.layer()->method, "tet");
  ASSERT_TRUE(session.layer()->markers.has_value());
  EXPECT_NE(notices.find("lean.csv lies over the shape by its size alone, because the layer has no \"matches\""),
            std::string::npos)
      << notices;
  EXPECT_EQ(session.frames().size(), 8u);
  // z up was laid along the bar, which is as large as the markers.
  const document::MarkersEdit first = *session.layer()->markers;
  EXPECT_NEAR(*first.scale, 1e-3, 1e-4);
  EXPECT_EQ(session.marker_pictures().size(), 1u);
  Bounds bounds;
  session.marker_pictures()[0].add_to(bounds);
  EXPECT_LT((bounds.centre() - session.rest_bounds().centre()).norm(), 1e-9);
  EXPECT_GT(bounds.max.y() - bounds.min.y(), 0.9);

  document::MarkersEdit smaller = first;
  smaller.scale = *first.scale / 2;
  session.set_markers(smaller);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
  EXPECT_NEAR(session.markers()->scale(), *smaller.scale, 1e-12);
  session.go_to_frame(7);
  ASSERT_TRUE(settle(session));
  EXPECT_LE(apart(folder / "bar.obj"), 1e-6);

  // What is saved is opened again as it was.
  session.save_edit(folder / "saved.json");
  ASSERT_TRUE(until(session, [&] { return !session.dirty() && !session.job(); })) << errors_of(session);
  EXPECT_TRUE(document::read_edit(folder / "saved.json") == session.project());

  session.undo();
  EXPECT_TRUE(*session.layer()->markers == first);
  session.undo();
  EXPECT_EQ(session.layer(), nullptr);
  EXPECT_FALSE(session.moves());
  ASSERT_TRUE(settle(session));
  session.redo();
  EXPECT_TRUE(session.moves());
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
  EXPECT_EQ(session.marker_pictures().size(), 1u);
  session.remove_markers();
  EXPECT_FALSE(session.moves());
  ASSERT_TRUE(settle(session));
  EXPECT_TRUE(session.marker_pictures().empty());
}

TEST_F(EditorMarkers, AnotherTakeKeepsTheMatches) {
  open(folder / "lean.json");
  std::ofstream(folder / "again.csv") << test::bar_motion();
  drop(folder / "again.csv");
  EXPECT_EQ(session.layer()->markers->path, folder / "again.csv");
  EXPECT_EQ(session.layer()->markers->matches.size(), 3u);
  EXPECT_EQ(notices.find("no \"matches\""), std::string::npos) << notices;
  // The markers of another motion have other names.
  std::ofstream(folder / "other.csv") << "frame,P.x,P.y,P.z\n1,0,0,0\n2,1,0,0\n";
  drop(folder / "other.csv");
  EXPECT_NE(notices.find("expected a marker that is seen in the first frame (\"P\"), found \"A\""), std::string::npos)
      << notices;
  EXPECT_EQ(session.layer()->markers->path, folder / "again.csv");
}

TEST_F(EditorMarkers, WhatCantBeDrivenSaysSo) {
  session.open(folder / "lean.csv");
  ASSERT_TRUE(until(session, [&] { return !session.job(); }));
  EXPECT_EQ(errors_of(session), "lean.csv is a motion: open the shape that it is to drive before it.\n");
  open(folder / "bar.obj");
  session.add_layer("graph");
  ASSERT_TRUE(settle(session));
  drop(folder / "lean.csv");
  EXPECT_EQ(notices, "lean.csv is a motion, which drives a layer of the method tet: this layer's is graph.\n");
  EXPECT_FALSE(session.layer()->markers.has_value());
  session.set_method(0, "tet");
  drop(folder / "missing.c3d");
  EXPECT_NE(notices.find("missing.c3d"), std::string::npos);
  EXPECT_FALSE(session.layer()->markers.has_value());
  std::ofstream(folder / "broken.json") << R"({ "sinew": 1, "inputs": ["bar.obj"], "layers": [
    { "method": "tet", "markers": { "file": "gone.trc" } } ] })";
  drop(folder / "broken.json");
  EXPECT_NE(notices.find("gone.trc"), std::string::npos) << notices;
  EXPECT_EQ(session.edit_path(), "");
}

TEST_F(EditorMarkers, TheBonesOfASkeletonAreSeen) {
  std::ofstream(folder / "arm.bvh") << "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 1 Zrotation\nJOINT arm\n{\n"
                                       "OFFSET 0 1 0\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n}\n"
                                       "MOTION\nFrames: 2\nFrame Time: 0.04\n0 0\n0 30\n";
  open(folder / "bar.obj");
  drop(folder / "arm.bvh");
  ASSERT_EQ(session.marker_pictures().size(), 1u) << notices;
  EXPECT_EQ(session.rate(), 25);
  const document::Markers::Picture rest = session.marker_pictures()[0];
  ASSERT_EQ(rest.bones.size(), 2u);
  EXPECT_NEAR((rest.bones[1].second - rest.bones[1].first).normalized().y(), 1, 1e-9);
  session.go_to_frame(2);
  ASSERT_TRUE(settle(session));
  const document::Markers::Picture turned = session.marker_pictures()[0];
  EXPECT_NEAR((turned.bones[1].second - turned.bones[1].first).normalized().y(), std::cos(M_PI / 6), 1e-9);
}

TEST_F(EditorMarkers, CommandsShowMarkersAndRemoveTheMotion) {
  open(folder / "lean.json");
  View view;
  Preferences preferences;
  Context context{session, view, preferences, [](Request) {}};
  const Command* show = find_command("view.markers");
  const Command* remove = find_command("layer.remove_motion");
  ASSERT_TRUE(show != nullptr && remove != nullptr);
  EXPECT_TRUE(show->checked(context));
  EXPECT_TRUE(run_command(*show, context));
  EXPECT_FALSE(view.show_markers);
  EXPECT_TRUE(run_command(*remove, context));
  EXPECT_FALSE(session.layer()->markers.has_value());
  EXPECT_FALSE(run_command(*remove, context));
  ASSERT_TRUE(settle(session));
}

TEST_F(EditorMarkers, ADanceMovesABody) {
  SHARED_DATA(data, "mocap");
  const std::string body = (data.parent_path() / "meshes" / "armadillo.obj").string();
  open(body);
  session.add_layer("tet");
  session.set_setting(0, "vertices", 600.0);
  ASSERT_TRUE(settle(session));
  drop((data / "c3d" / "Dance.c3d").string());
  EXPECT_NE(notices.find("no \"matches\""), std::string::npos) << notices;
  EXPECT_EQ(session.frames().size(), 499u);
  session.go_to_frame(60);
  ASSERT_TRUE(settle(session));
  EXPECT_EQ(errors_of(session), "");
  EXPECT_LE(apart(body), 1e-5 * session.rest_bounds().diagonal());
}

}  // namespace sinew::editor
