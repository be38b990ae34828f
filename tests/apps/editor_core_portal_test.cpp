/// The desktop's file dialog: asked for on a bus of the test's own, where a service answers as a portal does.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <systemd/sd-bus.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "apps/editor/portal.h"

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

/// A portal that answers every call with the same files, or not at all.
class FakePortal {
 public:
  enum class Manner { Chooses, Cancels, Refuses, Waits, Leaves, OldPath };

  FakePortal(Manner manner, std::vector<std::string> uris) : manner_(manner), uris_(std::move(uris)) {
    EXPECT_GE(sd_bus_open_user(&bus_), 0);
    static const sd_bus_vtable table[] = {
        SD_BUS_VTABLE_START(0), SD_BUS_METHOD("OpenFile", "ssa{sv}", "o", on_call, SD_BUS_VTABLE_UNPRIVILEGED),
        SD_BUS_METHOD("SaveFile", "ssa{sv}", "o", on_call, SD_BUS_VTABLE_UNPRIVILEGED), SD_BUS_VTABLE_END};
    EXPECT_GE(sd_bus_add_object_vtable(bus_, nullptr, "/org/freedesktop/portal/desktop",
                                       "org.freedesktop.portal.FileChooser", table, this),
              0);
    EXPECT_GE(sd_bus_add_filter(bus_, nullptr, on_any, this), 0);
    EXPECT_GE(sd_bus_request_name(bus_, "org.freedesktop.portal.Desktop", 0), 0);
    thread_ = std::thread([this] {
      while (!stop_) {
        const int done = sd_bus_process(bus_, nullptr);
        if (leave_) break;
        if (done <= 0) sd_bus_wait(bus_, 20'000);
      }
      sd_bus_flush_close_unref(bus_);
    });
  }
  ~FakePortal() {
    stop_ = true;
    thread_.join();
  }
  FakePortal(const FakePortal&) = delete;
  FakePortal& operator=(const FakePortal&) = delete;

  std::string member, title, token, folder, name;  ///< of the call; to be read when it was answered
  bool several = false;
  std::vector<std::string> patterns;
  std::atomic<bool> closed{false}, called{false};

 private:
  static int on_any(sd_bus_message* message, void* data, sd_bus_error* /*error*/) {
    if (sd_bus_message_is_method_call(message, "org.freedesktop.portal.Request", "Close"))
      static_cast<FakePortal*>(data)->closed = true;
    return 0;
  }

  void read_filters(sd_bus_message* message) {
    sd_bus_message_enter_container(message, 'v', "a(sa(us))");
    sd_bus_message_enter_container(message, 'a', "(sa(us))");
    while (sd_bus_message_enter_container(message, 'r', "sa(us)") > 0) {
      const char* text = nullptr;
      sd_bus_message_read(message, "s", &text);
      sd_bus_message_enter_container(message, 'a', "(us)");
      std::uint32_t kind = 0;
      while (sd_bus_message_read(message, "(us)", &kind, &text) > 0) patterns.emplace_back(text);
      sd_bus_message_exit_container(message);
      sd_bus_message_exit_container(message);
    }
    sd_bus_message_exit_container(message);
    sd_bus_message_exit_container(message);
  }

  void read_call(sd_bus_message* message) {
    const char *parent = nullptr, *text = nullptr;
    member = sd_bus_message_get_member(message);
    sd_bus_message_read(message, "ss", &parent, &text);
    title = text;
    sd_bus_message_enter_container(message, 'a', "{sv}");
    while (sd_bus_message_enter_container(message, 'e', "sv") > 0) {
      const char* key = nullptr;
      sd_bus_message_read(message, "s", &key);
      const std::string option = key;
      if (option == "handle_token" || option == "current_name") {
        sd_bus_message_read(message, "v", "s", &text);
        (option == "handle_token" ? token : name) = text;
      } else if (option == "multiple") {
        int on = 0;
        sd_bus_message_read(message, "v", "b", &on);
        several = on != 0;
      } else if (option == "current_folder") {
        sd_bus_message_enter_container(message, 'v', "ay");
        const void* bytes = nullptr;
        std::size_t size = 0;
        sd_bus_message_read_array(message, 'y', &bytes, &size);
        folder.assign(static_cast<const char*>(bytes), size);
        sd_bus_message_exit_container(message);
      } else if (option == "filters") {
        read_filters(message);
      } else {
        sd_bus_message_skip(message, "v");
      }
      sd_bus_message_exit_container(message);
    }
    sd_bus_message_exit_container(message);
  }

  static int on_call(sd_bus_message* message, void* data, sd_bus_error* /*error*/) {
    auto& self = *static_cast<FakePortal*>(data);
    self.read_call(message);
    if (self.manner_ == Manner::Refuses)
      return sd_bus_reply_method_errorf(message, SD_BUS_ERROR_UNKNOWN_METHOD, "no file dialog");
    std::string sender = sd_bus_message_get_sender(message) + 1;
    std::replace(sender.begin(), sender.end(), '.', '_');
    const std::string path = self.manner_ == Manner::OldPath
                                 ? "/org/freedesktop/portal/desktop/request/7"
                                 : "/org/freedesktop/portal/desktop/request/" + sender + "/" + self.token;
    sd_bus_reply_method_return(message, "o", path.c_str());
    self.called = true;
    if (self.manner_ == Manner::Leaves) {
      sd_bus_flush(self.bus_);
      self.leave_ = true;
    } else if (self.manner_ != Manner::Waits) {
      // Who listens only after the call was answered must hear it, too.
      if (self.manner_ == Manner::OldPath) std::this_thread::sleep_for(std::chrono::milliseconds(300));
      self.respond(path);
    }
    return 1;
  }

  void respond(const std::string& path) {
    sd_bus_message* signal = nullptr;
    sd_bus_message_new_signal(bus_, &signal, path.c_str(), "org.freedesktop.portal.Request", "Response");
    const bool chosen = manner_ != Manner::Cancels;
    sd_bus_message_append(signal, "u", chosen ? 0U : 1U);
    sd_bus_message_open_container(signal, 'a', "{sv}");
    if (chosen) {
      sd_bus_message_append(signal, "{sv}", "writable", "b", 1);
      sd_bus_message_open_container(signal, 'e', "sv");
      sd_bus_message_append(signal, "s", "uris");
      sd_bus_message_open_container(signal, 'v', "as");
      std::vector<char*> list;
      for (std::string& uri : uris_) list.push_back(uri.data());
      list.push_back(nullptr);
      sd_bus_message_append_strv(signal, list.data());
      sd_bus_message_close_container(signal);
      sd_bus_message_close_container(signal);
    }
    sd_bus_message_close_container(signal);
    sd_bus_send(bus_, signal, nullptr);
    sd_bus_message_unref(signal);
  }

  Manner manner_;
  std::vector<std::string> uris_;
  sd_bus* bus_ = nullptr;
  std::atomic<bool> stop_{false}, leave_{false};
  std::thread thread_;
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
