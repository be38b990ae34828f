#pragma once
/// What tests ask in place of a desktop.

#include <systemd/sd-bus.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace sinew::editor {

/// A desktop's portal whose file dialog answers by itself: in one of these manners, on the bus of the environment.
class FakePortal {
 public:
  /// Chooses: all files; InTurn: the next of them with each call; Waits: it never answers; Leaves: it goes in place of
  /// an answer; OldPath: it answers by a path of its own choice, as before the tokens.
  enum class Manner { Chooses, InTurn, Cancels, Refuses, Waits, Leaves, OldPath };

  FakePortal(Manner manner, std::vector<std::string> uris) : manner_(manner), uris_(std::move(uris)) {
    ready_ = sd_bus_open_user(&bus_) >= 0;
    static const sd_bus_vtable table[] = {
        SD_BUS_VTABLE_START(0), SD_BUS_METHOD("OpenFile", "ssa{sv}", "o", on_call, SD_BUS_VTABLE_UNPRIVILEGED),
        SD_BUS_METHOD("SaveFile", "ssa{sv}", "o", on_call, SD_BUS_VTABLE_UNPRIVILEGED), SD_BUS_VTABLE_END};
    ready_ = ready_ && sd_bus_add_object_vtable(bus_, nullptr, "/org/freedesktop/portal/desktop",
                                                "org.freedesktop.portal.FileChooser", table, this) >= 0;
    ready_ = ready_ && sd_bus_add_filter(bus_, nullptr, on_any, this) >= 0;
    ready_ = ready_ && sd_bus_request_name(bus_, "org.freedesktop.portal.Desktop", 0) >= 0;
    if (!ready_) return;
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
    if (thread_.joinable()) thread_.join();
  }
  FakePortal(const FakePortal&) = delete;
  FakePortal& operator=(const FakePortal&) = delete;

  bool ready() const { return ready_; }

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
      const bool one = manner_ == Manner::InTurn;
      for (std::size_t i = 0; i < uris_.size(); ++i)
        if (!one || i == turn_) list.push_back(uris_[i].data());
      turn_ = (turn_ + 1) % std::max<std::size_t>(1, uris_.size());
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
  std::size_t turn_ = 0;
  sd_bus* bus_ = nullptr;
  bool ready_ = false;
  std::atomic<bool> stop_{false}, leave_{false};
  std::thread thread_;
};

}  // namespace sinew::editor
