// sinew blend: poses in files, by weights.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/samples/meshes.h"
#include "engine/io/io.h"
#include "tests/apps/program.h"
#include "tests/io/temporary_folder.h"

namespace sinew {
namespace {

using Json = nlohmann::json;

/// A cylinder whose upper half leans, as if by a joint, by so many degrees.
Shape leaning(double degrees) {
  Shape out = samples::cylinder(12, 1, 24);
  const double angle = degrees * M_PI / 180;
  for (Vec3& p : out.positions) {
    const double a = angle * std::clamp((p.y() - 0.4) / 0.3, 0.0, 1.0), y = p.y() - 0.4;
    p = Vec3(p.x() + std::sin(a) * std::max(y, 0.0), 0.4 + (y > 0 ? std::cos(a) * y : y), p.z());
  }
  out.position_type = Type::Float64;
  return out;
}

class SinewBlend : public testing::Test {
 protected:
  SinewBlend() {
    io::write(rest, leaning(0));
    io::write(left, leaning(-60));
    io::write(right, leaning(60));
  }
  double lean(const std::string& path) const {
    const auto shape = io::read(path);
    Vec3 top = Vec3::Zero();
    for (const Vec3& p : shape->positions)
      if ((p + shape->origin).y() > top.y()) top = p + shape->origin;
    return top.x();
  }

  TemporaryFolder folder;
  std::string rest = folder / "rest.ply", left = folder / "left.ply", right = folder / "right.ply",
              out = folder / "out.ply";
};

TEST_F(SinewBlend, WritesTheShapeBetweenPosesAndItsReport) {
  const Outcome outcome =
      run_sinew({"blend", rest, left, right, "-w", "0,1", "-o", out, "--report", folder / "r.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Outcome diff = run_sinew({"diff", out, right, "--json"});
  EXPECT_LT(Json::parse(diff.out)["distance"]["max"].get<double>(), 1e-4) << diff.out;
  const Json layer = Json::parse(contents(folder / "r.json"))["layers"][0];
  EXPECT_EQ(layer["method"], "shell");
  EXPECT_EQ(layer["example_weights"], Json({0, 1}));
  EXPECT_LT(layer["energy"]["total"].get<double>(), 1e-6);
}

TEST_F(SinewBlend, ReachesBeyondAPose) {
  ASSERT_EQ(run_sinew({"blend", rest, right, "-w", "0.5", "-o", out}).status, 0);
  const double half = lean(out);
  ASSERT_EQ(run_sinew({"blend", rest, right, "-w", "1.25", "-o", out, "--force"}).status, 0);
  EXPECT_GT(half, 0.2 * lean(right));
  EXPECT_LT(half, 0.8 * lean(right));
  EXPECT_GT(lean(out), lean(right));
}

TEST_F(SinewBlend, AppliesHowAnotherShapeChanges) {
  Shape wide = leaning(0);
  for (Vec3& p : wide.positions) p.z() *= 2;
  io::write(folder / "wide.ply", wide);
  ASSERT_EQ(run_sinew({"blend", folder / "wide.ply", right, "--of", rest, "-w", "1", "-o", out}).status, 0);
  EXPECT_NEAR(lean(out), lean(right), 0.25 * lean(right));
}

TEST_F(SinewBlend, EachMistakeIsOneSentence) {
  const auto mistake = [&](const std::vector<std::string>& arguments, int status) {
    std::vector<std::string> all{"blend"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run_sinew(all);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(out));
    return outcome.err;
  };
  EXPECT_EQ(mistake({rest, left, "-w", "a", "-o", out}, 2),
            "sinew: --weights: expected numbers with commas between them, found \"a\"\n");
  EXPECT_EQ(mistake({rest, left, "-w", "1,,2", "-o", out}, 2),
            "sinew: --weights: expected numbers with commas between them, found \"\"\n");
  EXPECT_NE(
      mistake({rest, left, "-w", "1,2", "-o", out}, 3).find("at most 1 \"example_weights\", one an example, found 2"),
      std::string::npos);
  EXPECT_NE(mistake({rest, folder / "none.ply", "-w", "1", "-o", out}, 3).find("none.ply: "), std::string::npos);
  io::write(folder / "other.ply", samples::cylinder(13, 1, 24));
  EXPECT_NE(mistake({rest, folder / "other.ply", "-w", "1", "-o", out}, 3).find("other.ply: expected "),
            std::string::npos);
}

}  // namespace
}  // namespace sinew
