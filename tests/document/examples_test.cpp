/// Layers with example poses, from the files to the bent shape.

#include "engine/document/examples.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/document/keys.h"
#include "engine/geometry/error.h"
#include "engine/io/io.h"
#include "tests/io/temporary_folder.h"

namespace sinew::document {
namespace {

/// A strip of 2 x 20 squares along x, rolled up to an arc of so many degrees.
Shape strip(double degrees) {
  constexpr Index cells = 20, across = 2;
  Shape out;
  const double angle = degrees * M_PI / 180;
  for (Index i = 0; i <= cells; ++i)
    for (Index j = 0; j <= across; ++j) {
      const double s = i / static_cast<double>(cells), a = s * angle;
      const double x = angle == 0 ? s : std::sin(a) / angle, z = angle == 0 ? 0 : (1 - std::cos(a)) / angle;
      out.positions.emplace_back(x, 0.05 * j, z);
    }
  for (Index i = 0; i < cells; ++i)
    for (Index j = 0; j < across; ++j) {
      const Index a = i * (across + 1) + j, b = a + across + 1;
      out.faces.add(std::array{a, b, b + 1, a + 1});
    }
  out.position_type = Type::Float64;
  return out;
}

class ExamplesTest : public testing::Test {
 protected:
  ExamplesTest() {
    std::filesystem::create_directory(folder_ / "poses");
    io::write(folder_ / "rest.ply", strip(0));
    io::write(folder_ / "poses/up.ply", strip(90));
    io::write(folder_ / "poses/down.ply", strip(-90));
    rest_ = io::read(folder_ / "rest.ply");
  }

  Project edit(const std::string& members) const {
    return parse_edit(folder_ / "edit.json",
                      R"({"sinew": 1, "layers": [{"method": "shell", "examples": ["poses"], )" + members + "}]}");
  }
  Evaluation bent(const std::string& members) const { return evaluate(rest_, edit(members).layers, methods()); }
  std::string mistake(const Project& project) const {
    try {
      evaluate(rest_, project.layers, methods());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
  std::shared_ptr<const Shape> rest_;
};

/// How far the strip's end rises.
double rise(const Shape& shape) {
  return shape.positions.back().z() - shape.positions.front().z();
}

TEST_F(ExamplesTest, PinnedWeightsGiveTheShapeBetween) {
  // Poses are in the order of their names: down, up.
  EXPECT_NEAR(rise(*bent(R"("example_weights": [0, 1])").shape), rise(strip(90)), 1e-5);
  EXPECT_NEAR(rise(*bent(R"("example_weights": [1, 0])").shape), rise(strip(-90)), 1e-5);
  EXPECT_NEAR(std::abs(rise(*bent(R"("example_weights": [0, 0])").shape)), 0, 1e-9);
  const Evaluation half = bent(R"("example_weights": [0, 0.5])");
  EXPECT_NEAR(rise(*half.shape), rise(strip(45)), 0.05);
  EXPECT_EQ(half.reports[0].solve.example_weights, (std::vector<double>{0, 0.5}));
}

TEST_F(ExamplesTest, HandlesFindTheWeightsThatAreFree) {
  // The end goes where it is in a half roll.
  const Vec3 end = strip(45).positions.back();
  const std::string handles = R"("fixed": [{"box": [[-1, -1, -1], [0.06, 1, 1]]}], "handles": [{"points": {"nearest":
    [1, 0.1, 0]}, "to": [[)" + std::to_string(end.x()) +
                              ", 0.1, " + std::to_string(end.z()) + "]]}]";
  const Evaluation found = bent(R"("example_weights": [0], )" + handles);
  ASSERT_EQ(found.reports[0].solve.example_weights.size(), 2U);
  EXPECT_EQ(found.reports[0].solve.example_weights[0], 0);
  EXPECT_NEAR(found.reports[0].solve.example_weights[1], 0.5, 0.1);
  const Evaluation null = bent(R"("example_weights": [0, null], )" + handles);
  EXPECT_EQ(null.shape->positions, found.shape->positions);
}

TEST_F(ExamplesTest, WhatDoesNotCorrespondIsNamed) {
  Shape other = strip(30);
  std::swap(other.faces.points[5], other.faces.points[6]);
  io::write(folder_ / "other.ply", other);
  Project project = edit(R"("name": "a")");
  project.layers[0].examples = {folder_ / "other.ply"};
  const std::string said = mistake(project);
  EXPECT_NE(said.find("other.ply: expected face 1 of 40 to have corners "), std::string::npos) << said;
  EXPECT_NE(said.find("(of 40 faces)"), std::string::npos) << said;

  Shape fewer = strip(30);
  fewer.faces.offsets.pop_back();
  fewer.faces.points.resize(fewer.faces.offsets.back());
  io::write(folder_ / "fewer.ply", fewer);
  project.layers[0].examples = {folder_ / "fewer.ply"};
  EXPECT_NE(mistake(project).find("fewer.ply: expected 40 faces, found 39"), std::string::npos) << mistake(project);

  EXPECT_NE(mistake(edit(R"("example_weights": [1, 2, 3])"))
                .find("expected at most 2 \"example_weights\", one an example, found 3"),
            std::string::npos);
  project.layers[0].examples = {folder_ / "none.ply"};
  EXPECT_NE(mistake(project).find("none.ply"), std::string::npos);
}

TEST_F(ExamplesTest, PosesOfAnotherShapeAreAppliedToThisOne) {
  // The same strip twice as long and wide: rolled by the poses of the small one.
  Shape large = strip(0);
  for (Vec3& p : large.positions) p *= 2;
  const auto rest = std::make_shared<const Shape>(large);
  Project project = edit(R"("example_weights": [0, 1], "examples_of": "rest.ply")");
  const Evaluation out = evaluate(rest, project.layers, methods());
  EXPECT_NEAR(rise(*out.shape), 2 * rise(strip(90)), 1e-3);
}

TEST_F(ExamplesTest, WeightsOfKeysAreBlendedOverTime) {
  EXPECT_EQ(weights_between(std::vector<std::optional<double>>{0.0, 1.0, std::nullopt},
                            std::vector<std::optional<double>>{1.0, std::nullopt, std::nullopt, 2.0}, 0.25),
            (std::vector<std::optional<double>>{0.25, std::nullopt, std::nullopt, std::nullopt}));
  const Project project = edit(R"("keys": [{"frame": 1, "handles": [], "example_weights": [0, 0]},
                                           {"frame": 11, "handles": [], "example_weights": [0, 1]}])");
  const auto moving = std::make_shared<Sequence>();
  for (int frame = 1; frame <= 11; ++frame) moving->frames.resize(static_cast<std::size_t>(frame), frame);
  moving->load = [rest = rest_](int) { return rest; };
  Workspace workspace(moving, methods());
  EXPECT_NEAR(rise(*evaluate(workspace, project.layers, 6).shape), rise(strip(45)), 0.05);
  EXPECT_NEAR(rise(*evaluate(workspace, project.layers, 11).shape), rise(strip(90)), 1e-4);
}

}  // namespace
}  // namespace sinew::document
