#include <gtest/gtest.h>

#include <set>

#include "engine/gpu/png.h"
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

}  // namespace sinew
