#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "engine/gpu/camera.h"
#include "engine/gpu/png.h"
#include "tests/apps/bar_motion.h"
#include "tests/apps/program.h"
#include "tests/apps/sinew_fixtures.h"
#include "tests/io/temporary_folder.h"

namespace sinew {

namespace {

/// Pixels whose colour is about the accent of handles (orange) or of fixed points (blue).
std::size_t count(const gpu::Picture& picture, bool orange) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    const int r = picture.rgba[i], b = picture.rgba[i + 2];
    n += orange ? r > b + 60 : b > r + 60;
  }
  return n;
}

/// An ascii 3DGS PLY: a row of eleven red blobs that melt into each other, x -1..1, and one blob far away.
std::string splats_ply() {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 112\n";
  for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                           "rot_0", "rot_1", "rot_2", "rot_3"})
    text += std::string("property float ") + name + "\n";
  text += "end_header\n";
  for (int i = 0; i < 112; ++i) {
    const int column = i % 11, row = i / 11;
    text += (i < 111 ? std::to_string(0.2 * column - 1) : "100000") + " " + std::to_string(0.03 * row) +
            " 0 1.7 -1.7 -1.7 3 -2 -2 -2 1 0 0 0\n";
  }
  return text;
}

/// Part of the pixels that are not dark grey.
double covered(const gpu::Picture& picture) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) n += picture.rgba[i] > 80;
  return static_cast<double>(n) / (0.25 * static_cast<double>(picture.rgba.size()));
}

/// Whether the middle of the uppermost orange spot is orange, too.
bool middle_is_orange(const gpu::Picture& picture) {
  const auto orange = [&](int x, int y) { return picture.at(x, y)[0] > picture.at(x, y)[2] + 60; };
  int first = -1, n = 0, x_sum = 0, y_sum = 0;
  for (int y = 0; y < picture.height && (first < 0 || y < first + 8); ++y)
    for (int x = 0; x < picture.width; ++x) {
      if (!orange(x, y)) continue;
      if (first < 0) first = y;
      ++n;
      x_sum += x;
      y_sum += y;
    }
  return n > 0 && orange(x_sum / n, y_sum / n);
}

/// The render of `arguments`, which must succeed.
gpu::Picture drawn(const TemporaryFolder& folder, std::vector<std::string> arguments, std::string* err = nullptr) {
  arguments.insert(arguments.begin(), "render");
  arguments.insert(arguments.end(), {"-o", folder / "drawn.png", "--force", "--size", "320x200"});
  const Outcome outcome = run_sinew(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  if (err != nullptr) *err = outcome.err;
  return gpu::read_png(folder / "drawn.png");
}

}  // namespace

TEST(SinewRender, DrawsTheShapeTheEditAndItsMarks) {
  const TemporaryFolder folder;
  save(folder / "scan.ply", sheet_ply());
  save(folder / "edit.json", turn_edit());
  const auto draw = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments{"render", folder / "scan.ply", "-o", folder / name, "--size", "320x200"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_sinew(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return gpu::read_png(folder / name);
  };
  const gpu::Picture plain = draw("plain.png", {});
  EXPECT_EQ(plain.width, 320);
  EXPECT_EQ(plain.height, 200);
  EXPECT_EQ(count(plain, true) + count(plain, false), 0u);
  const gpu::Picture bent = draw("bent.png", {"--edit", folder / "edit.json"});
  EXPECT_NE(bent.rgba, plain.rgba);
  const gpu::Picture marked =
      draw("marked.png", {"--edit", folder / "edit.json", "--show", "handles,fixed,graph,ground,rest"});
  EXPECT_GT(count(marked, true), 50u);
  EXPECT_GT(count(marked, false), 50u);
  EXPECT_EQ(draw("again.png", {"--edit", folder / "edit.json"}).rgba, bent.rgba);
  const gpu::Picture eye = draw("eye.png", {"--view", "2,1,9,2,1,0"});
  EXPECT_NE(eye.rgba, plain.rgba);
}

TEST(SinewRender, SplatsAreDrawnAsSuchAndFramedWithoutOutliers) {
  const TemporaryFolder folder;
  save(folder / "splats.ply", splats_ply());
  const gpu::Picture splats = drawn(folder, {folder / "splats.ply", "--view", "front"});
  const gpu::Picture points =
      drawn(folder, {folder / "splats.ply", "--view", "front", "--show", "points", "--point-size", "2"});
  EXPECT_GT(covered(splats), 0.2);
  EXPECT_LT(covered(points), 0.1);
  EXPECT_GT(covered(points), 0.001);
  const std::uint8_t* middle = splats.at(160, 100);
  EXPECT_GT(middle[0], 240);
  EXPECT_LT(middle[1], 30);
}

TEST(SinewRender, BentSplatsAreDrawn) {
  const TemporaryFolder folder;
  save(folder / "splats.ply", splats_ply());
  save(folder / "edit.json", R"({ "sinew": 1, "layers": [ { "method": "graph", "settings": { "nodes": 40 },
    "fixed": [ { "box": [[-1.1, -1, -1], [-0.7, 1, 1]] } ],
    "handles": [ { "points": { "box": [[0.7, -1, -1], [1.1, 1, 1]] }, "move": [0, 1, 0] } ] } ] })");
  const std::vector<std::string> view{folder / "splats.ply", "--view", "0,0.5,6,0,0.5,0"};
  std::vector<std::string> bent = view, marked;
  bent.insert(bent.end(), {"--edit", folder / "edit.json"});
  marked = bent;
  marked.insert(marked.end(), {"--show", "fixed"});
  const gpu::Picture before = drawn(folder, view), after = drawn(folder, bent);
  // The right end has moved up, and what was there is empty.
  Eigen::Vector3d from, to;
  gpu::Camera camera;
  camera.eye = {0, 0.5, 6};
  camera.target = {0, 0.5, 0};
  ASSERT_TRUE(gpu::project(camera, {320, 200}, {0.9, 0.15, 0}, from));
  ASSERT_TRUE(gpu::project(camera, {320, 200}, {0.9, 1.15, 0}, to));
  const auto red = [](const gpu::Picture& picture, const Eigen::Vector3d& at) {
    return picture.at(static_cast<int>(at.x()), static_cast<int>(at.y()))[0];
  };
  EXPECT_GT(red(before, from), 200);
  EXPECT_LT(red(before, to), 60);
  EXPECT_LT(red(after, from), 60);
  EXPECT_GT(red(after, to), 200);
  // The fixed end takes on blue.
  ASSERT_TRUE(gpu::project(camera, {320, 200}, {-0.9, 0.15, 0}, from));
  const gpu::Picture blue = drawn(folder, marked);
  EXPECT_LT(after.at(static_cast<int>(from.x()), static_cast<int>(from.y()))[2], 40);
  EXPECT_GT(blue.at(static_cast<int>(from.x()), static_cast<int>(from.y()))[2], 100);
}

TEST(SinewRender, TetsAreDrawnCutOpenAndInTheColoursOfTheirMaterial) {
  const TemporaryFolder folder;
  save(folder / "block.obj", R"(v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)");
  save(folder / "edit.json", R"({ "sinew": 1, "layers": [ { "method": "tet",
    "fixed": [ { "box": [[-2, -2, -2], [-0.9, 2, 2]] } ],
    "rigid": [ { "box": [[0.9, -2, -2], [2, 2, 2]] } ],
    "stiffness": [ { "points": { "box": [[0.9, -2, -2], [2, 2, 2]] }, "factor": 16 } ],
    "handles": [ { "points": { "box": [[0.9, 0.9, -2], [2, 2, 2]] }, "move": [0.2, 0, 0] } ] } ] })");
  const auto draw = [&](const std::string& show, const std::string& cut) {
    std::vector<std::string> arguments{folder / "block.obj", "--edit", folder / "edit.json", "--view", "front"};
    arguments.insert(arguments.end(), {"--show", show});
    if (!cut.empty()) arguments.insert(arguments.end(), {"--cut", cut});
    return drawn(folder, arguments);
  };
  // Pixels where red, green and blue differ as they do in what is looked for.
  const auto count = [](const gpu::Picture& picture, auto like) {
    int out = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t* c = picture.at(x, y);
        out += like(int{c[0]}, int{c[1]}, int{c[2]});
      }
    return out;
  };
  const auto violet = [](int r, int g, int b) { return b > g + 30 && r > g + 10; };
  const auto red = [](int r, int g, int b) { return r > g + 40 && r > b + 20; };
  const auto sand = [](int r, int g, int b) { return r > b + 25 && g > b + 10; };
  const gpu::Picture plain = draw("tets", "");
  EXPECT_GT(covered(plain), 0.1);
  EXPECT_EQ(count(plain, violet) + count(plain, red), 0);
  EXPECT_GT(count(draw("tets,rigid", ""), violet), 300);
  EXPECT_GT(count(draw("tets,stiffness", ""), red), 300);
  EXPECT_GT(count(draw("stiffness", ""), red), 300) << "on the shape itself";
  EXPECT_EQ(covered(draw("tets", "x=0")), 0);
  EXPECT_GT(count(draw("tets", "z=0.5"), sand), count(plain, sand) + 300);
  const auto refused = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"render", folder / "block.obj", "-o", folder / "x.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_sinew(arguments);
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  EXPECT_EQ(refused({"--show", "tets"}),
            "sinew: --show tets: expected an edit (--edit) with a layer of the method tet, found none\n");
  EXPECT_EQ(refused({"--cut", "z=0.5"}), "sinew: --cut: expected --show tets, found none\n");
  for (const std::string cut : {"w=0.5", "z", "z=2", "z=nan", "0.5"})
    EXPECT_EQ(refused({"--cut", cut}),
              "sinew: --cut: expected an axis and a part from 0 to 1, such as z=0.5, found \"" + cut + "\"\n");
}

TEST(SinewRender, EnergyAndDisplacementAreColoursWithALegend) {
  const TemporaryFolder folder;
  save(folder / "scan.ply", sheet_ply());
  save(folder / "edit.json", turn_edit());
  const std::vector<std::string> base{folder / "scan.ply", "--edit", folder / "edit.json"};
  const gpu::Picture plain = drawn(folder, base);
  for (const std::string name : {"energy", "displacement"}) {
    std::vector<std::string> arguments = base;
    arguments.insert(arguments.end(), {"--show", name});
    std::string err;
    const gpu::Picture picture = drawn(folder, arguments, &err);
    EXPECT_NE(err.find("sinew: " + name + ": colours from 0 to "), std::string::npos) << err;
    // Yellow and violet, on the sheet and in the legend at the bottom left, where nothing was.
    const auto tell = [&](int left, int top, int right, int bottom) {
      int yellow = 0, violet = 0;
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
          const std::uint8_t* c = picture.at(x, y);
          yellow += c[1] > c[2] + 60 && c[0] > 90;
          violet += c[2] > c[1] + 20;
        }
      return std::pair(yellow, violet);
    };
    const auto sheet = tell(110, 0, 320, 200), legend = tell(0, 160, 110, 200);
    EXPECT_GT(sheet.first, 20) << name;
    EXPECT_GT(sheet.second, 20) << name;
    EXPECT_GT(legend.first, 20) << name;
    EXPECT_GT(legend.second, 20) << name;
    int white = 0, before = 0;
    for (int y = 160; y < 200; ++y)
      for (int x = 0; x < 110; ++x) {
        white += picture.at(x, y)[2] > 220;
        before += plain.at(x, y)[2] > 220;
      }
    EXPECT_GT(white, 80) << name;
    EXPECT_EQ(before, 0) << name;
  }
}

TEST(SinewRender, ShowsTheMarkersOfAMotion) {
  const TemporaryFolder folder;
  test::write_bar_motion(folder / "");
  const auto render = [&](const std::string& frame, const std::string& show) {
    return drawn(folder, {folder / "bar.obj", "--edit", folder / "lean.json", "--view", "front", "--frame", frame,
                          "--show", show});
  };
  EXPECT_EQ(count(render("3", "ground"), true), 0u);
  EXPECT_GT(count(render("3", "markers"), true), 80u);
  // The marker above the bar: a ball, and where it was not seen a ring.
  EXPECT_TRUE(middle_is_orange(render("3", "markers")));
  EXPECT_FALSE(middle_is_orange(render("6", "markers")));

  const Outcome none = run_sinew({"render", folder / "bar.obj", "-o", folder / "x.png", "--show", "markers"});
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.err, "sinew: --show markers: expected an edit (--edit) with a layer that has markers, found none\n");
}

TEST(SinewRender, FieldsNeedAnEditAndOneOfThemIsEnough) {
  const TemporaryFolder folder;
  save(folder / "scan.ply", sheet_ply());
  save(folder / "edit.json", turn_edit());
  const Outcome without = run_sinew({"render", folder / "scan.ply", "-o", folder / "x.png", "--show", "energy"});
  EXPECT_EQ(without.status, 2);
  EXPECT_EQ(without.err, "sinew: --show energy: expected an edit (--edit), found none\n");
  const Outcome both = run_sinew({"render", folder / "scan.ply", "-o", folder / "x.png", "--edit", folder / "edit.json",
                                  "--show", "energy,displacement"});
  EXPECT_EQ(both.status, 2);
  EXPECT_EQ(both.err, "sinew: --show: expected energy or displacement, found both\n");
}

TEST(SinewRender, NumbersAreColoursByAnyMapInAnyRange) {
  const TemporaryFolder folder;
  save(folder / "scan.ply", sheet_ply());
  save(folder / "edit.json", turn_edit());
  const auto draw = [&](std::vector<std::string> more, std::string* err = nullptr) {
    std::vector<std::string> arguments{folder / "scan.ply", "--edit", folder / "edit.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return drawn(folder, arguments, err);
  };
  std::string err;
  const gpu::Picture displacement = draw({"--color", "displacement"});
  EXPECT_EQ(displacement.rgba, draw({"--show", "displacement"}).rgba) << "another name for the same";
  draw({"--color", "stretch"}, &err);
  EXPECT_NE(err.find("sinew: stretch: colours from -"), std::string::npos) << err;
  EXPECT_NE(err.find(" %; the most is "), std::string::npos) << err;
  draw({"--color", "rotation", "--colormap", "turbo"}, &err);
  EXPECT_NE(err.find("sinew: rotation: colours from 0 to "), std::string::npos) << err;
  EXPECT_NE(err.find("°"), std::string::npos) << err;
  EXPECT_NE(draw({"--color", "displacement", "--colormap", "turbo"}).rgba, displacement.rgba);
  draw({"--color", "displacement", "--range", "-1,7.5"}, &err);
  EXPECT_NE(err.find("displacement: colours from -1 to 7.5;"), std::string::npos) << err;
  // All of it is far below such a range: the sheet has the colour of its low end, dark violet.
  const gpu::Picture low = draw({"--color", "displacement", "--range", "1000,2000"});
  int yellow = 0;
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 320; ++x) yellow += low.at(x, y)[1] > low.at(x, y)[2] + 60;
  EXPECT_EQ(yellow, 0);

  const auto refused = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"render", folder / "scan.ply", "-o", folder / "x.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_sinew(arguments);
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  EXPECT_EQ(refused({"--color", "stretch"}), "sinew: --color stretch: expected an edit (--edit), found none\n");
  EXPECT_EQ(refused({"--color", "nonsense"}).find("sinew: --color: expected one of displacement, stretch"), 0U);
  EXPECT_EQ(refused({"--color", "stretch", "--colormap", "jet"}),
            "sinew: --colormap: expected viridis, turbo or cool-warm, found \"jet\"\n");
  for (const std::string range : {"1", "2,1", "a,b", "0,inf", ","})
    EXPECT_EQ(refused({"--color", "stretch", "--range", range}),
              "sinew: --range: expected two numbers, the lower first, such as 0,0.5, found \"" + range + "\"\n");
}

TEST(SinewRender, ATurntableGoesOnceAround) {
  const TemporaryFolder folder;
  save(folder / "scan.ply", sheet_ply());
  const std::vector<std::string> base{"render", folder / "scan.ply",     "--size", "160x100",
                                      "-o",     folder / "turn.####.png"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = base;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sinew(arguments);
  };
  const Outcome outcome = with({"--turntable", "4", "--view", "front"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::vector<gpu::Picture> pictures;
  for (int i = 1; i <= 4; ++i) pictures.push_back(gpu::read_png(folder / ("turn.000" + std::to_string(i) + ".png")));
  for (std::size_t i = 1; i < 4; ++i) EXPECT_NE(pictures[i].rgba, pictures[0].rgba) << i;
  EXPECT_FALSE(std::filesystem::exists(folder / "turn.0005.png")) << "the first again";
  // A sheet seen from the side is narrow, from the back as wide as from the front.
  EXPECT_LT(covered(pictures[1]), 0.5 * covered(pictures[0]));
  EXPECT_NEAR(covered(pictures[2]), covered(pictures[0]), 0.15 * covered(pictures[0]));

  EXPECT_EQ(with({"--turntable", "4"}).status, 1) << "the pictures exist";
  EXPECT_EQ(with({}).status, 2);
  EXPECT_EQ(with({"--turntable", "1", "--force"}).status, 2);
  const Outcome one = run_sinew({"render", folder / "scan.ply", "-o", folder / "x.png", "--turntable", "4"});
  EXPECT_EQ(one.err,
            "sinew: " + (folder / "x.png") + ": expected the name of a run, such as turn.####.png, with --turntable\n");
}

}  // namespace sinew
