/// Broken files opened in a session: a sentence that says what and where, and nothing else changes.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "apps/editor/session.h"
#include "deformers/methods.h"
#include "engine/io/io.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::editor {

namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class EditorBroken : public ::testing::Test {
 protected:
  EditorBroken() {
    Shape shape;
    for (int i = 0; i < 200; ++i) shape.positions.emplace_back(0.1 * (i % 20), 0.1 * (i / 20), 0);
    set_origin(shape);
    io::write(folder / "a.ply", shape, true);
    session.open(folder / "a.ply");
    EXPECT_TRUE(until(session, [&] { return session.has_input(); }));
    session.select_all();
    session.mark_selection(Mark::Handle);
    session.save_edit(folder / "a.edit.json");
    EXPECT_TRUE(until(session, [&] { return !session.dirty() && !session.job(); })) << errors_of(session);
    session.rename_layer(0, "Not saved");
    EXPECT_TRUE(settle(session));
    errors_of(session);
  }

  /// Opens it; whether it could be read. Where not, what is open must be as it was.
  bool opens(const std::string& path) {
    const auto input = session.input();
    const document::Project project = session.project();
    const std::size_t steps = session.history().size(), selected = session.selection().count();
    session.open_shape(path);
    EXPECT_TRUE(settle(session)) << path;
    if (session.input() != input) return true;
    const std::string told = errors_of(session);
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << path << " told: " << told;
    EXPECT_NE(told.find(std::filesystem::path(path).filename().string()), std::string::npos) << told;
    EXPECT_NE(told.find("expected "), std::string::npos) << told;
    EXPECT_NE(told.find(", found "), std::string::npos) << told;
    EXPECT_EQ(session.project(), project) << path;
    EXPECT_EQ(session.history().size(), steps) << path;
    EXPECT_EQ(session.selection().count(), selected) << path;
    EXPECT_TRUE(session.dirty()) << path;
    return false;
  }

  TemporaryFolder folder;
  Session session{methods()};
};

}  // namespace

TEST_F(EditorBroken, AnEditCutAnywhere) {
  const std::string whole = text_of(folder / "a.edit.json");
  ASSERT_GT(whole.size(), 300u);
  for (std::size_t size = 0; size + 3 < whole.size(); size += whole.size() / 40) {
    std::ofstream(folder / "cut.json", std::ios::binary) << whole.substr(0, size);
    EXPECT_FALSE(opens(folder / "cut.json")) << size;
  }
}

TEST_F(EditorBroken, AShapeCutAnywhere) {
  const std::string whole = text_of(folder / "a.ply");
  for (std::size_t size = 0; size < whole.size(); size += whole.size() / 40) {
    std::ofstream(folder / "cut.ply", std::ios::binary) << whole.substr(0, size);
    EXPECT_FALSE(opens(folder / "cut.ply")) << size;
  }
}

TEST_F(EditorBroken, FilesThatOtherProgramsStumbledOver) {
  SHARED_DATA(malformed, "malformed");
  std::size_t refused = 0, read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(malformed)) {
    if (!entry.is_regular_file()) continue;
    const std::string extension = entry.path().extension().string();
    const bool known = std::any_of(io::formats().begin(), io::formats().end(), [&](const io::Format& format) {
      return std::any_of(format.extensions.begin(), format.extensions.end(),
                         [&](const std::string& e) { return "." + e == extension; });
    });
    if (!known) continue;
    if (opens(entry.path().string())) {
      ++read;
      session.open(folder / "a.edit.json");
      ASSERT_TRUE(settle(session));
      session.select_all();
      session.rename_layer(0, "Not saved");
      ASSERT_TRUE(settle(session));
      errors_of(session);
    } else {
      ++refused;
    }
  }
  std::printf("%zu refused, %zu read\n", refused, read);
  EXPECT_GT(refused, 5u);
}

}  // namespace sinew::editor
