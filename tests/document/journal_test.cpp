#include "engine/document/journal.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "engine/document/journal_format.h"
#include "engine/io/io.h"
#include "tests/io/temporary_folder.h"

namespace sinew::document {

namespace {

Selection indices(std::size_t count, Index first) {
  std::vector<Index> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = first + static_cast<Index>(i);
  Selection out;
  out.what = SelectIndices{Shared<Index>(std::move(points))};
  return out;
}

Project project_of(std::size_t layers, std::size_t points = 3) {
  Project project;
  project.inputs = {"/data/scan.ply"};
  for (std::size_t i = 0; i < layers; ++i) {
    Layer layer;
    layer.name = "Layer " + std::to_string(i);
    layer.fixed = {indices(points, static_cast<Index>(100 * i))};
    project.layers.push_back(layer);
  }
  return project;
}

/// Everything that has an array of its own, long and short.
Project with_all_arrays() {
  Project project = project_of(1, 500);
  Layer& layer = project.layers[0];
  HandleEdit to, places;
  to.points = indices(70, 5);
  to.motion.to = Shared<Vec3>(std::vector<Vec3>(70, Vec3(0.1, -0.0, 1e-300)));
  places.points.what = SelectPlaces{Shared<Vec3>(std::vector<Vec3>(65, Vec3(1, 2, 3)))};
  places.motion.move = Vec3(0, 1, 0);
  layer.handles = {to, places};
  layer.start = Shared<Affine>(std::vector<Affine>(226, Affine::Constant(1.0 / 3)));
  layer.path.emplace();
  layer.path->points = Shared<Vec3>(std::vector<Vec3>(100, Vec3(3, 2, 1)));
  layer.rigid = {indices(64, 9), indices(65, 9), indices(500, 0)};
  return project;
}

void expect_same(const JournalContent& content, const History& history) {
  ASSERT_EQ(content.states.size(), history.size());
  EXPECT_EQ(content.present, history.position());
  for (std::size_t i = 0; i < history.size(); ++i) {
    EXPECT_EQ(content.states[i].label, history.label(i)) << i;
    EXPECT_EQ(content.states[i].project, history.state(i).project) << i;
  }
}

JournalContent only_journal_in(const std::string& folder) {
  const std::vector<std::shared_ptr<OldJournal>> found = find_journals(folder);
  EXPECT_EQ(found.size(), 1u);
  if (found.size() != 1) return {};
  found.front()->read();
  return found.front()->content();
}

std::string only_file_in(const std::string& folder) {
  std::string out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_TRUE(out.empty());
    out = entry.path().string();
  }
  return out;
}

}  // namespace

TEST(Journal, StepsUndoRedoAndJumpsComeBack) {
  const TemporaryFolder folder;
  History history(project_of(1));
  {
    Journal journal(folder / "state");
    journal.begin(history, "", 0);
    const auto commit = [&](Project project, const char* label) {
      history.commit(std::move(project), label);
      journal.note(history);
    };
    commit(project_of(2), "Add layer");
    commit(with_all_arrays(), "All \"arrays\" \n of it");
    history.undo();
    journal.note(history);
    commit(project_of(4), "Another way");
    commit(project_of(5), "Add layer");
    journal.saved(history, history.state(2).serial, "/data/e.json");
    journal.hashes({"sha256:" + std::string(64, 'a')});
    commit(with_all_arrays(), "All arrays again");
    history.go_to(1);
    journal.note(history);
    EXPECT_EQ(journal.take_problem(), "");
  }
  const JournalContent content = only_journal_in(folder / "state");
  expect_same(content, history);
  EXPECT_EQ(content.saved, 2u);
  EXPECT_EQ(content.edit_path, "/data/e.json");
  EXPECT_EQ(content.hashes, std::vector<std::string>{"sha256:" + std::string(64, 'a')});
  EXPECT_EQ(content.torn, 0u);
  EXPECT_TRUE(content.unsaved());
}

TEST(Journal, AReplacedStateIsTheNewOne) {
  const TemporaryFolder folder;
  History history(project_of(1));
  {
    Journal journal(folder.path().string());
    journal.begin(history, "", 0);
    history.commit(project_of(2), "Drag handle");
    journal.note(history);
    history.undo();
    history.commit(with_all_arrays(), "Drag handle");  // as a drag that settles elsewhere does
    journal.note(history);
  }
  expect_same(only_journal_in(folder.path().string()), history);
}

TEST(Journal, RandomStepsComeBack) {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  History history(project_of(1));
  {
    Journal journal(folder.path().string());
    journal.begin(history, "", 0);
    for (int i = 0; i < 500; ++i) {
      switch (random() % 4) {
        case 0: history.undo(); break;
        case 1: history.redo(); break;
        case 2: history.go_to(random() % history.size()); break;
        default: history.commit(project_of(1 + random() % 5, random() % 200), "Step " + std::to_string(i));
      }
      journal.note(history);
    }
  }
  expect_same(only_journal_in(folder.path().string()), history);
}

/// A file that was cut anywhere gives what its whole records say; a damaged byte, what is before it.
TEST(Journal, ATornEndIsLeftOutWhereverItIs) {
  std::vector<std::byte> bytes;
  const auto magic = std::as_bytes(std::span(journal::magic));
  bytes.assign(magic.begin(), magic.end());
  SharedArrays arrays;
  std::vector<std::size_t> ends;
  std::vector<History::State> states;
  for (std::uint64_t i = 0; i < 6; ++i) {
    states.push_back({"Step " + std::to_string(i), project_of(1, 60 + 3 * i), i});
    journal::put_state(bytes, arrays, i, states.back());
    ends.push_back(bytes.size());
  }
  const auto expect_prefix = [&](const JournalContent& content, std::size_t whole, std::size_t at) {
    const auto steps = static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), whole) - ends.begin());
    ASSERT_EQ(content.states.size(), steps) << "byte " << at;
    for (std::size_t i = 0; i < steps; ++i) ASSERT_EQ(content.states[i].project, states[i].project) << "byte " << at;
  };
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    const JournalContent content = parse_journal("j", std::span(bytes).first(size));
    expect_prefix(content, size, size);
    if (std::count(ends.begin(), ends.end(), size) > 0) {
      ASSERT_EQ(content.torn, 0u) << size;
    }
  }
  for (std::size_t at = magic.size(); at < bytes.size(); ++at) {
    std::vector<std::byte> damaged = bytes;
    damaged[at] ^= std::byte{0x10};
    const JournalContent content = parse_journal("j", damaged);
    expect_prefix(content, at, at);
    ASSERT_GT(content.torn, 0u);
  }
  bytes.resize(bytes.size() + 4096);  // zeros, as a machine that lost its power leaves them
  EXPECT_EQ(parse_journal("j", bytes).torn, 4096u);
  EXPECT_THROW(parse_journal("j", std::as_bytes(std::span("sinew journal 2\n"))), InputError);
}

TEST(Journal, LongArraysAreWrittenOnce) {
  const TemporaryFolder folder;
  Project project = project_of(1, 1000000);
  project.layers[0].start = Shared<Affine>(std::vector<Affine>(300, Affine::Identity()));
  HandleEdit handle;
  handle.points = indices(1000, 0);
  handle.motion.move = Vec3(0, 0, 0);
  project.layers[0].handles = {handle};
  History history(project);
  Journal journal(folder.path().string());
  journal.begin(history, "", 0);
  journal.wait_written();
  const std::uint64_t first = journal.bytes();
  std::printf("1,000,000 points: %llu bytes, %.1f ms at first\n", static_cast<unsigned long long>(first),
              1000 * journal.seconds());
  double longest = 0, sum = 0;
  for (int i = 1; i <= 200; ++i) {
    project.layers[0].handles[0].motion.move = Vec3(0, 0, 0.001 * i);
    project.layers[0].handles[0].points = indices(1000, 0);  // the same points, in an array of its own
    history.commit(project, "Drag handle");
    journal.note(history);
    journal.wait_written();
    sum += journal.seconds();
    longest = std::max(longest, journal.seconds());
  }
  const double each = static_cast<double>(journal.bytes() - first) / 200;
  std::printf("a drag after it: %.0f bytes, %.2f ms (longest %.2f ms)\n", each, 1000 * sum / 200, 1000 * longest);
  EXPECT_LT(first, 4'100'000u);
  EXPECT_LT(each, 2000);
}

TEST(Journal, TwoProgramsDoNotDisturbEachOther) {
  const TemporaryFolder folder;
  History a(project_of(1)), b(project_of(2));
  {
    Journal first(folder.path().string());
    first.begin(a, "", 0);
    first.wait_written();
    {
      Journal second(folder.path().string());
      second.begin(b, "", 0);
      second.wait_written();
      EXPECT_TRUE(find_journals(folder.path().string()).empty()) << "both are alive";
    }
    const auto found = find_journals(folder.path().string());
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(find_journals(folder.path().string()).empty()) << "it is offered once";
    found.front()->read();
    expect_same(found.front()->content(), b);
    found.front()->discard();
    first.remove();
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Journal, WhatIsOnlyOpenOrSavedIsNotOffered) {
  const TemporaryFolder folder;
  History history(project_of(1));
  {
    Journal journal(folder.path().string());
    journal.begin(history, "", 0);
  }
  EXPECT_FALSE(only_journal_in(folder.path().string()).unsaved());
  {
    Journal journal(folder / "b");
    journal.begin(history, "", 0);
    history.commit(project_of(2), "Add layer");
    journal.note(history);
    journal.saved(history, history.state(1).serial, "/e.json");
  }
  EXPECT_FALSE(only_journal_in(folder / "b").unsaved());
  {
    Journal journal(folder / "c");
    journal.begin(history, "", std::nullopt);
    journal.wait_written();
    journal.end();
  }
  EXPECT_TRUE(only_journal_in(folder / "c").states.empty());
}

TEST(Journal, AProblemIsToldOnceAndNothingIsMissingAfterIt) {
  const TemporaryFolder folder;
  const std::string place = folder / "state";
  std::ofstream(place) << "no folder";
  History history(project_of(1));
  {
    Journal journal(place);
    const auto step = [&](std::size_t layers) {
      history.commit(project_of(layers), "Add layer");
      journal.note(history);
      journal.wait_written();
    };
    journal.begin(history, "", 0);
    step(2);
    EXPECT_NE(journal.take_problem().find(place), std::string::npos);
    step(3);
    EXPECT_EQ(journal.take_problem(), "") << "a second time";
    std::filesystem::remove(place);
    step(4);
  }
  expect_same(only_journal_in(place), history);
}

TEST(Journal, AnOldOneGoesOnceTheNewOneIsOnTheDisk) {
  const TemporaryFolder folder;
  History history(project_of(1));
  history.commit(project_of(2), "Add layer");
  {
    Journal journal(folder.path().string());
    journal.begin(history, "", 0);
  }
  const std::string old_file = only_file_in(folder.path().string());
  {
    const auto found = find_journals(folder.path().string());
    ASSERT_EQ(found.size(), 1u);
    found.front()->read();
    Journal journal(folder.path().string());
    journal.begin({found.front()->content().states, found.front()->content().present}, "", 0);
    journal.replace(found.front());
  }
  EXPECT_FALSE(std::filesystem::exists(old_file));
  expect_same(only_journal_in(folder.path().string()), history);
}

}  // namespace sinew::document
