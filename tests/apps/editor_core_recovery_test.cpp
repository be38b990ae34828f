/// What a killed session leaves, and that the next one goes on from it.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <thread>

#include "apps/editor/recovery.h"
#include "apps/editor/session.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/input_hash.h"
#include "engine/io/io.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"
#include "tests/safety/editing.h"

namespace sinew::editor {

namespace {

/// 30 x 11 points of a sheet.
void write_sheet(const std::string& path) {
  Shape shape;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 11; ++j) shape.positions.emplace_back(0.1 * i, 0.1 * j, 0.01 * ((i * j) % 3));
  shape.position_type = Type::Float64;
  set_origin(shape);
  io::write(path, shape, true);
}

PointSet beyond(const Session& session, double x, double sign) {
  PointSet out(session.input()->size());
  for (std::size_t i = 0; i < out.size(); ++i)
    if (sign * (session.input()->positions[i] + session.input()->origin).x() > sign * x) out.add(i);
  return out;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> texts_of(Session& session, Severity severity) {
  std::vector<std::string> out;
  for (const Notice& notice : session.take_notices())
    if (notice.severity == severity) out.push_back(notice.text);
  return out;
}

class EditorRecovery : public ::testing::Test {
 protected:
  EditorRecovery() { write_sheet(input()); }

  std::unique_ptr<Session> begin() {
    auto session = std::make_unique<Session>(methods());
    session->keep_journal(state());
    return session;
  }
  std::unique_ptr<Session> begin_open() {
    auto session = begin();
    session->open(input());
    EXPECT_TRUE(until(*session, [&] { return session->has_input(); })) << errors_of(*session);
    EXPECT_TRUE(settle(*session));
    return session;
  }
  /// Both ends marked, the right one dragged, renamed, and that taken back: five states, the fourth is present.
  static void edit_some(Session& session) {
    session.select(beyond(session, 0.5, -1), SelectMode::Replace);
    session.mark_selection(Mark::Fixed);
    session.select(beyond(session, 2.5, 1), SelectMode::Replace);
    session.mark_selection(Mark::Handle);
    ASSERT_TRUE(settle(session));
    ASSERT_TRUE(session.begin_drag(0));
    session.drag_to(move_by(Vec3(0, 0, 0.4)));
    session.end_drag();
    ASSERT_TRUE(settle(session));
    session.rename_layer(0, "Bent");
    session.undo();
    ASSERT_TRUE(settle(session));
    ASSERT_EQ(errors_of(session), "");
  }
  std::shared_ptr<document::OldJournal> offered() {
    std::atomic<bool> found = false;
    Recovery recovery([&] { found = true; });
    recovery.look(state());
    while (!found) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    recovery.poll();
    return recovery.recover();
  }
  std::size_t journals() const {
    std::error_code error;
    const std::filesystem::directory_iterator begin(state(), error);
    return error ? 0 : static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
  }

  std::string input() const { return folder / "sheet.ply"; }
  std::string edit() const { return folder / "edit.json"; }
  std::string state() const { return folder / "state"; }

  TemporaryFolder folder;
};

}  // namespace

TEST_F(EditorRecovery, TheEditAndItsHistoryComeBackAndGoOn) {
  auto killed = begin_open();
  edit_some(*killed);
  const document::History before = killed->history();
  const std::vector<Vec3> bent(killed->bent_positions().begin(), killed->bent_positions().end());
  killed.reset();  // without leave()
  ASSERT_EQ(journals(), 1u);

  auto session = begin();
  session->recover(offered());
  ASSERT_TRUE(until(*session, [&] { return session->has_input(); })) << errors_of(*session);
  ASSERT_TRUE(settle(*session));
  EXPECT_EQ(session->history().size(), before.size());
  EXPECT_EQ(session->history().position(), before.position());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(session->history().label(i), before.label(i));
    EXPECT_EQ(session->history().state(i).project, before.state(i).project);
  }
  EXPECT_TRUE(session->dirty());
  ASSERT_EQ(session->bent_positions().size(), bent.size());
  for (std::size_t i = 0; i < bent.size(); ++i) ASSERT_LT((session->bent_positions()[i] - bent[i]).norm(), 1e-9) << i;
  session->redo();
  EXPECT_EQ(session->layer()->name, "Bent");
  session->undo();
  session->undo();
  ASSERT_TRUE(settle(*session));
  EXPECT_LT((session->bent_positions().back() - session->input()->positions.back()).norm(), 1e-9) << "undone";
  session.reset();  // killed again

  ASSERT_EQ(journals(), 1u) << "the journal that was recovered from is gone";
  session = begin();
  session->recover(offered());
  ASSERT_TRUE(until(*session, [&] { return session->has_input(); })) << errors_of(*session);
  EXPECT_EQ(session->history().size(), before.size());
  EXPECT_EQ(session->history().position(), before.position() - 1);
  session->leave();
  session.reset();
  EXPECT_EQ(journals(), 0u);
}

TEST_F(EditorRecovery, NothingIsOfferedWhereNothingWasChangedOrAllIsSaved) {
  begin_open().reset();
  EXPECT_EQ(offered(), nullptr);
  EXPECT_EQ(journals(), 0u);
  auto session = begin_open();
  edit_some(*session);
  session->go_to(session->history().size() - 1);
  session->save_edit(edit());
  ASSERT_TRUE(until(*session, [&] { return !session->dirty() && !session->job(); }));
  session.reset();
  EXPECT_EQ(offered(), nullptr);
  session = begin_open();
  edit_some(*session);
  session->close();
  session.reset();
  EXPECT_EQ(offered(), nullptr);
}

TEST_F(EditorRecovery, WhatWasSavedBeforeItIsKnown) {
  auto session = begin_open();
  edit_some(*session);
  session->save_edit(edit());
  ASSERT_TRUE(until(*session, [&] { return !session->dirty() && !session->job(); }));
  session->rename_layer(0, "After");
  session.reset();
  const auto journal = offered();
  ASSERT_NE(journal, nullptr);
  EXPECT_EQ(what_of(*journal), "sheet.ply: 1 step not saved");
  EXPECT_EQ(details_of(*journal).substr(0, 32), "The last one was \"Rename layer\",");
  session = begin();
  session->recover(journal);
  ASSERT_TRUE(until(*session, [&] { return session->has_input(); }));
  EXPECT_EQ(session->edit_path(), edit());
  EXPECT_TRUE(session->dirty());
  session->undo();
  EXPECT_FALSE(session->dirty()) << "that is what the file holds";
}

TEST_F(EditorRecovery, LaterOffersItAgainAndDiscardNeverAgain) {
  auto session = begin_open();
  edit_some(*session);
  session.reset();
  offered().reset();  // later
  EXPECT_EQ(journals(), 1u);
  const auto journal = offered();
  ASSERT_NE(journal, nullptr);
  journal->discard();
  EXPECT_EQ(offered(), nullptr);
  EXPECT_EQ(journals(), 0u);
}

TEST_F(EditorRecovery, WithoutItsInputTheJournalStays) {
  auto session = begin_open();
  edit_some(*session);
  session.reset();
  std::filesystem::rename(input(), folder / "away.ply");
  session = begin();
  session->recover(offered());
  ASSERT_TRUE(until(*session, [&] { return !session->job(); }));
  EXPECT_FALSE(session->has_input());
  EXPECT_NE(errors_of(*session).find("sheet.ply: expected a file that can be read"), std::string::npos);
  session.reset();
  std::filesystem::rename(folder / "away.ply", input());
  EXPECT_NE(offered(), nullptr);
}

TEST_F(EditorRecovery, AnUnwritableJournalIsToldOnceAndEditingGoesOn) {
  std::ofstream(state()) << "no folder";
  auto session = begin_open();
  std::size_t told = 0;
  for (int i = 0; i < 5; ++i) {
    session->add_layer("graph");
    session->journal()->wait_written();
    session->poll();
    for (const std::string& text : texts_of(*session, Severity::Warning))
      told += text.find("journal of this session can't be written") != std::string::npos;
  }
  EXPECT_EQ(told, 1u);
  EXPECT_EQ(session->project().layers.size(), 5u);
}

TEST_F(EditorRecovery, AnInputThatIsAnotherIsTold) {
  auto session = begin_open();
  edit_some(*session);
  session->save_edit(edit());
  ASSERT_TRUE(until(*session, [&] { return !session->dirty() && !session->job(); }));
  const document::Project saved = document::read_edit(edit());
  EXPECT_EQ(saved.hashes.of, std::vector<std::string>{document::input_hash(input())});

  const auto warnings_at_opening = [&] {
    session = begin();
    session->open(edit());
    EXPECT_TRUE(until(*session, [&] { return session->has_input(); }));
    EXPECT_TRUE(settle(*session));
    for (int i = 0; i < 100; ++i) {
      session->poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return texts_of(*session, Severity::Warning);
  };
  EXPECT_TRUE(warnings_at_opening().empty());
  std::ofstream(input(), std::ios::app | std::ios::binary) << '\n';
  const std::vector<std::string> told = warnings_at_opening();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0], document::sentence_of_other_input("sheet.ply"));
  EXPECT_FALSE(session->dirty());

  session->rename_layer(0, "Killed");
  session.reset();
  std::ofstream(input(), std::ios::app | std::ios::binary) << '\n';
  session = begin();
  session->recover(offered());
  ASSERT_TRUE(until(*session, [&] { return session->has_input(); })) << errors_of(*session);
  std::vector<std::string> after;
  EXPECT_TRUE(until(*session, [&] {
    after = texts_of(*session, Severity::Warning);
    return !after.empty();
  }));
  EXPECT_EQ(after, told);
}

TEST_F(EditorRecovery, WhatWasLostOfATornStepIsSaid) {
  auto session = begin_open();
  edit_some(*session);
  session->go_to(0);
  session.reset();
  EXPECT_EQ(details_of(*offered()).substr(0, 32), "The last one was \"Rename layer\",") << "that can be had again";
  const std::string file = std::filesystem::directory_iterator(state())->path().string();
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5);
  const auto journal = offered();
  ASSERT_NE(journal, nullptr);
  EXPECT_TRUE(details_of(*journal).ends_with(" Another was being written and is lost.")) << details_of(*journal);
}

/// Killed at random moments, it has all that was in the journal, and nothing but that or one step more.
TEST_F(EditorRecovery, KilledAtRandomMomentsOneStepIsLostAtMost) {
  std::mt19937 random(5);
  std::size_t steps = 0, in_between = 0;
  for (int run = 0; run < 25; ++run) {
    std::filesystem::remove_all(state());
    const std::string out = folder / "said";
    std::filesystem::remove(out);
    const pid_t child = fork();
    if (child == 0) {
      const std::string program = std::string(SINEW_BINARY_DIR) + "/bin/sinew-editing";
      if (freopen(out.c_str(), "w", stdout) == nullptr) _exit(126);
      execl(program.c_str(), "sinew-editing", input().c_str(), state().c_str(), std::to_string(run).c_str(), "400",
            nullptr);
      _exit(127);
    }
    for (int i = 0; i < 5000 && text_of(out).find("done 2") == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 300000));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << WEXITSTATUS(status);

    std::ifstream said(out);
    std::size_t doing = 0, done = 0, present = 0, hash = 0;
    for (std::string word; said >> word;) {
      if (word == "doing") said >> doing;
      if (word == "done") said >> done >> present >> hash;
    }
    steps += done;
    const std::vector<std::shared_ptr<document::OldJournal>> found = document::find_journals(state());
    ASSERT_GE(done, 2u);
    ASSERT_EQ(found.size(), 1u);
    found.front()->read();
    const document::JournalContent& content = found.front()->content();
    const document::Project& project = content.states[content.present].project;
    if (content.present == present && hash_of(project) == hash) continue;
    ASSERT_EQ(doing, done + 1) << "step " << done << " was in the journal";
    ++in_between;
  }
  std::printf("killed 25 times in %zu steps, %zu times with the step in the journal that was being done\n", steps,
              in_between);
}

}  // namespace sinew::editor
