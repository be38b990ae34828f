#include "apps/editor/portal.h"

#include <systemd/sd-bus.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>

namespace sinew::editor {

namespace {

constexpr const char* portal_name = "org.freedesktop.portal.Desktop";
constexpr std::uint64_t call_timeout = 10'000'000, look_up_time = 100'000;  ///< microseconds

struct CloseBus {
  void operator()(sd_bus* bus) const { sd_bus_flush_close_unref(bus); }
  void operator()(sd_bus_message* message) const { sd_bus_message_unref(message); }
};
using Bus = std::unique_ptr<sd_bus, CloseBus>;
using Message = std::unique_ptr<sd_bus_message, CloseBus>;

/// What the signals said so far.
struct Conversation {
  std::optional<std::uint32_t> response;  ///< 0: chosen, 1: cancelled, else: ended in another way
  std::vector<std::string> uris;
  bool gone = false;    ///< the portal left the bus
  bool called = false;  ///< the call was answered,
  std::string path;     ///< by the path of its request; empty: by an error
};

/// Every [b] of an extension in both cases: patterns of the portal tell them apart.
std::string pattern_of(const std::string& extension) {
  std::string out = "*.";
  for (const char c : extension) {
    const auto upper = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    out += upper == c ? std::string(1, c) : std::string("[") + c + upper + "]";
  }
  return out;
}

void read_uris(sd_bus_message* message, std::vector<std::string>& uris) {
  if (sd_bus_message_enter_container(message, 'a', "{sv}") < 0) return;
  while (sd_bus_message_enter_container(message, 'e', "sv") > 0) {
    const char* key = nullptr;
    if (sd_bus_message_read(message, "s", &key) < 0) return;
    if (std::strcmp(key, "uris") == 0) {
      char** list = nullptr;
      if (sd_bus_message_enter_container(message, 'v', "as") >= 0 && sd_bus_message_read_strv(message, &list) >= 0) {
        for (char** uri = list; uri != nullptr && *uri != nullptr; ++uri) {
          uris.emplace_back(*uri);
          free(*uri);
        }
        free(list);
        sd_bus_message_exit_container(message);
      }
    } else {
      sd_bus_message_skip(message, "v");
    }
    sd_bus_message_exit_container(message);
  }
}

int on_response(sd_bus_message* message, void* data, sd_bus_error* /*error*/) {
  auto& conversation = *static_cast<Conversation*>(data);
  std::uint32_t response = 2;
  if (sd_bus_message_read(message, "u", &response) < 0) response = 2;
  if (response == 0) read_uris(message, conversation.uris);
  conversation.response = response;
  return 0;
}

int on_owner(sd_bus_message* message, void* data, sd_bus_error* /*error*/) {
  const char *name = nullptr, *before = nullptr, *after = nullptr;
  if (sd_bus_message_read(message, "sss", &name, &before, &after) >= 0 && std::strcmp(name, portal_name) == 0 &&
      after[0] == 0)
    static_cast<Conversation*>(data)->gone = true;
  return 0;
}

int on_called(sd_bus_message* message, void* data, sd_bus_error* /*error*/) {
  auto& conversation = *static_cast<Conversation*>(data);
  const char* path = nullptr;
  conversation.called = true;
  if (!sd_bus_message_is_method_error(message, nullptr) && sd_bus_message_read(message, "o", &path) >= 0)
    conversation.path = path;
  return 0;
}

int append_text(sd_bus_message* message, const char* key, const std::string& text) {
  return text.empty() ? 0 : sd_bus_message_append(message, "{sv}", key, "s", text.c_str());
}

/// The chosen extensions together, and everything.
int append_filters(sd_bus_message* message, const std::vector<std::string>& extensions) {
  if (extensions.empty()) return 0;
  sd_bus_message_open_container(message, 'e', "sv");
  sd_bus_message_append(message, "s", "filters");
  sd_bus_message_open_container(message, 'v', "a(sa(us))");
  sd_bus_message_open_container(message, 'a', "(sa(us))");
  const auto filter = [&](const char* name, const std::vector<std::string>& patterns) {
    sd_bus_message_open_container(message, 'r', "sa(us)");
    sd_bus_message_append(message, "s", name);
    sd_bus_message_open_container(message, 'a', "(us)");
    for (const std::string& pattern : patterns) sd_bus_message_append(message, "(us)", 0U, pattern.c_str());
    sd_bus_message_close_container(message);
    sd_bus_message_close_container(message);
  };
  std::vector<std::string> patterns;
  for (const std::string& extension : extensions) patterns.push_back(pattern_of(extension));
  filter("Known files", patterns);
  filter("All files", {"*"});
  sd_bus_message_close_container(message);
  sd_bus_message_close_container(message);
  return sd_bus_message_close_container(message);
}

/// The call with all its options; null where a message can't be made.
Message call_of(sd_bus* bus, const PortalRequest& request, const std::string& token) {
  sd_bus_message* made = nullptr;
  if (sd_bus_message_new_method_call(bus, &made, portal_name, "/org/freedesktop/portal/desktop",
                                     "org.freedesktop.portal.FileChooser", request.save ? "SaveFile" : "OpenFile") < 0)
    return nullptr;
  Message call(made);
  sd_bus_message_append(made, "ss", "", request.title.c_str());
  sd_bus_message_open_container(made, 'a', "{sv}");
  append_text(made, "handle_token", token);
  append_text(made, "accept_label", request.action);
  if (request.several && !request.save) sd_bus_message_append(made, "{sv}", "multiple", "b", 1);
  if (request.save) append_text(made, "current_name", request.name);
  if (!request.folder.empty()) {
    sd_bus_message_open_container(made, 'e', "sv");
    sd_bus_message_append(made, "s", "current_folder");
    sd_bus_message_open_container(made, 'v', "ay");
    sd_bus_message_append_array(made, 'y', request.folder.c_str(), request.folder.size() + 1);  // ends with a zero
    sd_bus_message_close_container(made);
    sd_bus_message_close_container(made);
  }
  append_filters(made, request.extensions);
  return sd_bus_message_close_container(made) < 0 ? nullptr : std::move(call);
}

/// Where the portal tells the answer, by its rules: known before the call, so that no answer is too early.
std::string request_path(sd_bus* bus, const std::string& token) {
  const char* unique = nullptr;
  if (sd_bus_get_unique_name(bus, &unique) < 0) return {};
  std::string sender(unique + 1);
  std::replace(sender.begin(), sender.end(), '.', '_');
  return "/org/freedesktop/portal/desktop/request/" + sender + "/" + token;
}

bool listen(sd_bus* bus, const std::string& path, Conversation& conversation) {
  return sd_bus_match_signal(bus, nullptr, portal_name, path.c_str(), "org.freedesktop.portal.Request", "Response",
                             on_response, &conversation) >= 0;
}

/// Without waiting for what the portal says to it.
void close_dialog(sd_bus* bus, const std::string& path) {
  sd_bus_message* made = nullptr;
  if (sd_bus_message_new_method_call(bus, &made, portal_name, path.c_str(), "org.freedesktop.portal.Request", "Close") <
      0)
    return;
  const Message call(made);
  sd_bus_message_set_expect_reply(made, 0);
  sd_bus_send(bus, made, nullptr);
}

}  // namespace

std::string path_of_uri(const std::string& uri) {
  constexpr std::string_view scheme = "file://";
  if (!uri.starts_with(scheme)) return {};
  const std::size_t begin = uri.find('/', scheme.size());
  const std::string host = uri.substr(scheme.size(), std::min(begin, uri.size()) - scheme.size());
  if (begin == std::string::npos || (!host.empty() && host != "localhost")) return {};
  std::string out;
  for (std::size_t i = begin; i < uri.size(); ++i) {
    const auto hex = [&](std::size_t at) {
      return at < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at]));
    };
    if (uri[i] == '%' && hex(i + 1) && hex(i + 2)) {
      out += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

PortalAnswer ask_portal(const PortalRequest& request, const std::function<bool()>& go_on) {
  sd_bus* opened = nullptr;
  if (sd_bus_open_user(&opened) < 0) return {};
  const Bus bus(opened);
  static std::atomic<int> asked{0};
  const std::string token = "sinew_" + std::to_string(getpid()) + "_" + std::to_string(++asked);
  Conversation conversation;
  std::string path = request_path(opened, token);
  if (path.empty() || !listen(opened, path, conversation) ||
      sd_bus_match_signal(opened, nullptr, "org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus",
                          "NameOwnerChanged", on_owner, &conversation) < 0)
    return {};
  const Message call = call_of(opened, request, token);
  if (call == nullptr || sd_bus_call_async(opened, nullptr, call.get(), on_called, &conversation, call_timeout) < 0)
    return {};
  while (!conversation.response && !conversation.gone) {
    if (!go_on()) {
      close_dialog(opened, path);
      return {PortalAnswer::What::Cancelled, {}};
    }
    const int done = sd_bus_process(opened, nullptr);
    if (done < 0 || (done == 0 && sd_bus_wait(opened, look_up_time) < 0)) return {};
    if (!conversation.called || conversation.path == path) continue;
    if (conversation.path.empty()) return {};
    path = conversation.path;  // of a portal older than its rules
    if (!listen(opened, path, conversation)) return {};
  }
  if (!conversation.response) return {};
  PortalAnswer out{PortalAnswer::What::Cancelled, {}};
  for (const std::string& uri : conversation.uris)
    if (std::string file = path_of_uri(uri); !file.empty()) out.paths.push_back(std::move(file));
  if (*conversation.response == 0 && !out.paths.empty()) out.what = PortalAnswer::What::Chosen;
  return out;
}

}  // namespace sinew::editor
