/// The desktop's file dialog: asked for on a bus of the test's own, where a service answers as a portal does.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "apps/editor/portal.h"
#include "tests/apps/fake_portal.h"

extern char** environ;

namespace sinew::editor {

namespace {

/// A dbus-daemon, and the environment that names it.
class PrivateBus {
 public:
  PrivateBus() {
    int out[2];
    if (pipe2(out, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    std::string words[] = {"dbus-daemon", "--session", "--nofork", "--print-address"};
    char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
    started_ = posix_spawnp(&pid_, "dbus-daemon", &actions, nullptr, arguments, environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    std::string address;
    for (char c = 0; started_ && read(out[0], &c, 1) == 1 && c != '\n';) address += c;
    close(out[0]);
    const char* before = std::getenv("DBUS_SESSION_BUS_ADDRESS");
    before_ = before == nullptr ? "" : before;
    setenv("DBUS_SESSION_BUS_ADDRESS", address.c_str(), 1);
  }
  ~PrivateBus() {
    if (started_) {
      kill(pid_, SIGTERM);
      waitpid(pid_, nullptr, 0);
    }
    before_.empty() ? unsetenv("DBUS_SESSION_BUS_ADDRESS") : setenv("DBUS_SESSION_BUS_ADDRESS", before_.c_str(), 1);
  }
  PrivateBus(const PrivateBus&) = delete;
  PrivateBus& operator=(const PrivateBus&) = delete;
  bool started() const { return started_; }

 private:
  pid_t pid_ = -1;
  bool started_ = false;
  std::string before_;
};

using What = PortalAnswer::What;
using Manner = FakePortal::Manner;

const std::function<bool()> forever = [] { return true; };

class EditorPortal : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(bus.started()) << "dbus-daemon is not installed"; }
  PrivateBus bus;
  const PortalRequest open{"Open", "Take", false, true, "/scans", "", {"ply", "obj"}};
};

}  // namespace

TEST(EditorPortalUris, AreFilesOfThisMachineOrNothing) {
  EXPECT_EQ(path_of_uri("file:///a/b.ply"), "/a/b.ply");
  EXPECT_EQ(path_of_uri("file://localhost/a/b.ply"), "/a/b.ply");
  EXPECT_EQ(path_of_uri("file:///my%20scans/%C3%A4%25.ply"), "/my scans/ä%.ply");
  EXPECT_EQ(path_of_uri("file:///a%2"), "/a%2");
  for (const char* uri : {"", "file://", "file://elsewhere/a", "https://a/b", "/a/b"}) EXPECT_EQ(path_of_uri(uri), "");
}

TEST_F(EditorPortal, GivesTheFilesThatWereChosen) {
  FakePortal portal(Manner::Chooses, {"file:///scans/a%20b.ply", "https://elsewhere/c.ply", "file:///scans/d.obj"});
  ASSERT_TRUE(portal.ready());
  const PortalAnswer answer = ask_portal(open, forever);
  EXPECT_EQ(answer.what, What::Chosen);
  EXPECT_EQ(answer.paths, (std::vector<std::string>{"/scans/a b.ply", "/scans/d.obj"}));
  EXPECT_EQ(portal.member, "OpenFile");
  EXPECT_EQ(portal.title, "Open");
  EXPECT_TRUE(portal.several);
  EXPECT_EQ(portal.folder, std::string("/scans") + '\0');
  EXPECT_EQ(portal.patterns, (std::vector<std::string>{"*.[pP][lL][yY]", "*.[oO][bB][jJ]", "*"}));
}

TEST_F(EditorPortal, ProposesANameToSave) {
  FakePortal portal(Manner::Chooses, {"file:///scans/bent.ply"});
  const PortalAnswer answer = ask_portal({"Export", "Write", true, false, "/scans", "bent.ply", {"ply"}}, forever);
  EXPECT_EQ(answer.paths, std::vector<std::string>{"/scans/bent.ply"});
  EXPECT_EQ(portal.member, "SaveFile");
  EXPECT_EQ(portal.name, "bent.ply");
  EXPECT_FALSE(portal.several);
}

TEST_F(EditorPortal, TellsACancelledDialogFromNone) {
  {
    FakePortal portal(Manner::Cancels, {});
    EXPECT_EQ(ask_portal(open, forever).what, What::Cancelled);
  }
  EXPECT_EQ(ask_portal(open, forever).what, What::Unavailable) << "a bus without a portal";
  FakePortal portal(Manner::Refuses, {});
  EXPECT_EQ(ask_portal(open, forever).what, What::Unavailable) << "a portal without a file dialog";
}

TEST_F(EditorPortal, ClosesTheDialogWhenItIsNotWantedAnyMore) {
  FakePortal portal(Manner::Waits, {});
  EXPECT_EQ(ask_portal(open, [&] { return !portal.called; }).what, What::Cancelled);
  for (int i = 0; i < 100 && !portal.closed; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(portal.closed);
}

TEST_F(EditorPortal, APortalThatLeavesIsNotWaitedFor) {
  FakePortal portal(Manner::Leaves, {});
  EXPECT_EQ(ask_portal(open, forever).what, What::Unavailable);
}

TEST_F(EditorPortal, OldPortalsAnswerElsewhere) {
  FakePortal portal(Manner::OldPath, {"file:///scans/a.ply"});
  EXPECT_EQ(ask_portal(open, forever).paths, std::vector<std::string>{"/scans/a.ply"});
}

TEST(EditorPortalAlone, WithoutABusThereIsNone) {
  const char* before = std::getenv("DBUS_SESSION_BUS_ADDRESS");
  const std::string saved = before == nullptr ? "" : before;
  setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere/bus", 1);
  EXPECT_EQ(ask_portal({"Open", "Open", false, false, "", "", {}}, forever).what, What::Unavailable);
  saved.empty() ? unsetenv("DBUS_SESSION_BUS_ADDRESS") : setenv("DBUS_SESSION_BUS_ADDRESS", saved.c_str(), 1);
}

}  // namespace sinew::editor
