/// Control points of a file as handles, and how far each came to be from its target.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "apps/editor/commands.h"
#include "apps/samples/meshes.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/io/io.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"

namespace sinew::editor {

namespace {

/// A strip of ground of 40 x 4 m, walked along x, at UTM coordinates.
const Vec3 corner(5400000, 600000, 100);

Shape strip() {
  Shape shape;
  for (int i = 0; i <= 200; ++i)
    for (int j = 0; j <= 20; ++j)
      shape.positions.emplace_back(corner + Vec3(0.2 * i, 0.2 * j, 0.3 * std::sin(0.5 * i)));
  shape.position_type = Type::Float64;
  set_origin(shape);
  return shape;
}

/// What the walk drifted by.
Vec3 drift(const Vec3& p) {
  const double x = p.x() - corner.x();
  return {0.001 * x, 0.0004 * x * x, -0.0002 * x * x};
}

class EditorControlPoints : public ::testing::Test {
 protected:
  void open_strip() {
    io::write(input(), strip(), true);
    session.open(input());
    ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
    ASSERT_TRUE(settle(session));
  }
  /// Opens a file of this text, which is then one step.
  void take(const std::string& text, const std::string& name = "control.csv") {
    std::ofstream(folder / name) << text;
    session.take_notices();
    if (text.starts_with("name") || text.starts_with("id"))
      session.open(folder / name);
    else
      session.add_control_points(folder / name);
    arrived = false;
    until(session, [&] { return !session.job(); });
    ASSERT_TRUE(until(session, [&] {
      arrived |= session.poll().control_points;
      return !session.solving() && !session.job();
    }));
  }
  /// Each 5 m along both sides; the last is measured wrong by 1 m.
  std::string survey() {
    std::string text = "name,x,y,z,tx,ty,tz\n";
    const Shape shape = strip();
    for (int i = 0; i <= 200; i += 25)
      for (const int j : {1, 19}) {
        const Vec3 p = shape.positions[static_cast<std::size_t>(21 * i + j)] + shape.origin + Vec3(0.01, -0.02, 0.005);
        Vec3 to = p + drift(p);
        if (i == 100 && j == 1) to.z() += 0.8;
        text += fmt_name(i, j) + row(p) + row(to) + "\n";
      }
    return text;
  }
  static std::string fmt_name(int i, int j) {
    return (i == 100 && j == 1 ? "wrong " : "P") + std::to_string(i) + "-" + std::to_string(j);
  }
  static std::string row(const Vec3& p) {
    char text[128];
    std::snprintf(text, sizeof text, ",%.6f,%.6f,%.6f", p.x(), p.y(), p.z());
    return text;
  }
  std::string warnings() {
    std::string out;
    for (const Notice& notice : session.take_notices())
      if (notice.severity != Severity::Info) out += notice.text + "\n";
    return out;
  }
  std::string input() const { return folder / "strip.ply"; }

  TemporaryFolder folder;
  Session session{sinew::methods()};
  bool arrived = false;
};

}  // namespace

TEST_F(EditorControlPoints, ADriftIsTakenOutInOneStepAndTheCommandLineDoesTheSame) {
  open_strip();
  take(survey());
  ASSERT_EQ(warnings(), "");
  const document::Layer& layer = session.project().layers.at(0);
  ASSERT_EQ(layer.handles.size(), 18u);
  EXPECT_EQ(layer.handles[0].name, "P0-1");
  EXPECT_EQ(session.history().label(session.history().position()), "18 control points");
  EXPECT_EQ(session.history().size(), 2u);

  // Half way between control points, too, what it drifted by is taken out; away from the wrong one.
  const std::vector<Vec3> bent(session.bent_positions().begin(), session.bent_positions().end());
  double before = 0, after = 0;
  for (std::size_t i = 0; i < bent.size(); ++i) {
    const Vec3 p = session.input()->positions[i] + session.input()->origin;
    if (std::abs(p.x() - corner.x() - 20) < 8) continue;
    before = std::max(before, drift(p).norm());
    after = std::max(after, (bent[i] + session.input()->origin - p - drift(p)).norm());
  }
  EXPECT_GT(before, 0.6);
  EXPECT_LT(after, 0.15);

  const std::vector<Residual> residuals = session.residuals();
  ASSERT_EQ(residuals.size(), 18u);
  for (std::size_t k = 1; k < residuals.size(); ++k) EXPECT_GE(residuals[k - 1].distance, residuals[k].distance);
  EXPECT_LT(residuals[0].distance, 0.2);
  EXPECT_GT(residuals[0].distance, 0);
  double squares = 0;
  for (const Residual& residual : residuals) {
    const Index point =
        session.project().layers[0].handles[residual.handle].points.what.index() == 1
            ? std::get<document::SelectIndices>(layer.handles[residual.handle].points.what).points.get()[0]
            : 0;
    const Vec3 wanted = layer.handles[residual.handle].motion.to.get()[0] - session.input()->origin;
    EXPECT_NEAR((bent[point] - wanted).norm(), residual.distance, 1e-9) << residual.name;
    squares += residual.distance * residual.distance;
  }
  EXPECT_NEAR(rms_of(residuals), std::sqrt(squares / 18), 1e-12);
  const std::string csv = csv_of(residuals);
  EXPECT_TRUE(csv.starts_with("handle,points,distance\n" + residuals[0].name + ",1,")) << csv;

  session.save_edit(folder / "edit.json");
  ASSERT_TRUE(until(session, [&] { return !session.dirty() && !session.job(); })) << errors_of(session);
  const document::Project project = document::read_edit(folder / "edit.json");
  EXPECT_TRUE(project == session.project()) << "the saved edit reads back as another";
  const auto line = document::evaluate(io::read(input()), project.layers, sinew::methods());
  for (std::size_t i = 0; i < bent.size(); ++i) ASSERT_LE((bent[i] - line.shape->positions[i]).norm(), 1e-9);
  // The report has the same residuals, in units of the diagonal.
  ASSERT_EQ(line.reports[0].handles.size(), 18u);
  for (const Residual& residual : residuals) {
    const document::HandleReport& handle = line.reports[0].handles[residual.handle];
    EXPECT_EQ(handle.name, residual.name);
    EXPECT_NEAR(handle.rms * session.rest_bounds().diagonal(), residual.distance, 1e-9);
  }

  // A drag of one is seen in the table, and taking back the file takes all of them.
  ASSERT_TRUE(session.begin_drag(3));
  session.undo();
  EXPECT_TRUE(session.project().layers.empty());
  EXPECT_TRUE(session.residuals().empty());
}

TEST_F(EditorControlPoints, PointsByNumberWithoutNames) {
  open_strip();
  const Vec3 p = session.input()->positions[50] + session.input()->origin;
  take("50" + row(p + Vec3(0, 0, 0.1)) + "\n4000" + row(corner + Vec3(38, 0.4, 0)) + "\n");
  ASSERT_EQ(warnings(), "");
  const document::Layer& layer = session.project().layers.at(0);
  ASSERT_EQ(layer.handles.size(), 2u);
  EXPECT_EQ(layer.handles[0].name, "Point 50");
  EXPECT_LT((layer.handles[0].motion.to.get()[0] - p - Vec3(0, 0, 0.1)).norm(), 1e-6);
  // More of them take their points from what was marked before.
  session.select_all();
  session.mark_selection(Mark::Fixed);
  ASSERT_TRUE(settle(session));
  take("id,tx,ty,tz\n50" + row(p) + "\n");
  EXPECT_EQ(session.project().layers[0].handles.size(), 1u);
  EXPECT_EQ(session.project().layers[0].fixed.size(), 1u);
  EXPECT_EQ(std::get<document::SelectIndices>(session.project().layers[0].fixed[0].what).points.get().size(),
            session.input()->size() - 1);
}

TEST_F(EditorControlPoints, WhatIsOddIsSaid) {
  take("name,x,y,z,tx,ty,tz\nA,0,0,0,0,0,0\n");
  EXPECT_NE(warnings().find("open the shape that they are on before it"), std::string::npos);
  open_strip();
  take("id,tx,ty,tz\n100000,0,0,0\n");
  EXPECT_NE(warnings().find("numbers of finite points below 4221, found 100000"), std::string::npos);
  EXPECT_TRUE(session.project().layers.empty());
  const Vec3 p = session.input()->positions[50] + session.input()->origin;
  take("name,x,y,z,tx,ty,tz\nA" + row(p + Vec3(0, 0, 0.03)) + row(p) + "\nB" + row(p + Vec3(0, 0, 0.01)) + row(p) +
       "\nC" + row(p + Vec3(0, 50, 0)) + row(p) + "\n");
  const std::string said = warnings();
  EXPECT_NE(said.find("1 of 3 control points are farther"), std::string::npos) << said;
  EXPECT_NE(said.find("1 of 3 control points are left out"), std::string::npos) << said;
  ASSERT_EQ(session.project().layers.at(0).handles.size(), 2u);
  EXPECT_EQ(session.project().layers[0].handles[0].name, "B") << "the nearer one";
}

TEST_F(EditorControlPoints, ResidualsOfManyPointsAreTheirRms) {
  io::write(folder / "box.ply", samples::box({4, 16, 4}, {0.05, 0.05, 0.05}), true);
  session.open(folder / "box.ply");
  ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
  EXPECT_TRUE(session.residuals().empty());
  const Bounds bounds = session.rest_bounds();
  for (const bool top : {false, true}) {
    PointSet end(session.input()->size());
    for (std::size_t i = 0; i < end.size(); ++i) {
      const double y = session.input()->positions[i].y();
      if (top ? y > bounds.max.y() - 0.01 : y < bounds.min.y() + 0.01) end.add(i);
    }
    session.select(end, SelectMode::Replace);
    session.mark_selection(Mark::Handle);
  }
  ASSERT_TRUE(settle(session));
  ASSERT_TRUE(session.begin_drag(1));
  session.drag_to(move_by({0.3, 0.1, 0}));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  const std::vector<Residual> residuals = session.residuals();
  ASSERT_EQ(residuals.size(), 2u);
  EXPECT_EQ(name_of_handle(session.project().layers[0], 1), "Handle 2");
  EXPECT_EQ(residuals[0].points, residuals[1].points);
  EXPECT_GT(residuals[0].points, 10u);
  EXPECT_NEAR(rms_of(residuals), session.figures().residual * bounds.diagonal(), 0.2 * rms_of(residuals));
}

}  // namespace sinew::editor
