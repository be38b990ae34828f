#include "engine/document/history.h"

#include <gtest/gtest.h>

namespace sinew::document {

namespace {

Project with_layers(std::size_t n) {
  Project project;
  project.layers.resize(n);
  return project;
}

}  // namespace

TEST(History, UndoAndRedoGoToTheSnapshots) {
  History history(with_layers(0));
  history.commit(with_layers(1), "Add layer");
  history.commit(with_layers(2), "Add layer");
  EXPECT_TRUE(history.undo());
  EXPECT_EQ(history.present().layers.size(), 1u);
  EXPECT_TRUE(history.undo());
  EXPECT_FALSE(history.undo());
  EXPECT_EQ(history.present().layers.size(), 0u);
  EXPECT_TRUE(history.redo());
  EXPECT_TRUE(history.redo());
  EXPECT_FALSE(history.redo());
  EXPECT_EQ(history.present().layers.size(), 2u);
}

TEST(History, ANewStateForgetsWhatWasUndone) {
  History history(with_layers(0));
  history.commit(with_layers(1), "one");
  history.commit(with_layers(2), "two");
  history.undo();
  history.commit(with_layers(5), "five");
  EXPECT_FALSE(history.can_redo());
  EXPECT_EQ(history.size(), 3u);
  EXPECT_EQ(history.label(2), "five");
  history.go_to(0);
  EXPECT_EQ(history.present().layers.size(), 0u);
  EXPECT_TRUE(history.can_redo());
}

TEST(History, AnEqualStateAddsNoStep) {
  History history(with_layers(1));
  history.commit(with_layers(1), "nothing");
  EXPECT_FALSE(history.can_undo());
}

TEST(History, SnapshotsShareTheirBigArrays) {
  Project project = with_layers(1);
  Selection selection;
  selection.what = SelectIndices{Shared<Index>(std::vector<Index>(1000000, 3))};
  project.layers[0].fixed = {selection};
  History history(project);
  for (int i = 0; i < 1000; ++i) {  // 4 GB if they were copied
    project.layers[0].name = std::to_string(i);
    history.commit(project, "Rename");
  }
  const auto data = [](const Project& p) {
    return std::get<SelectIndices>(p.layers[0].fixed[0].what).points.get().data();
  };
  const auto* newest = data(history.present());
  history.go_to(0);
  EXPECT_EQ(data(history.present()), newest);
}

}  // namespace sinew::document
