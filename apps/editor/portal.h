#pragma once
/// Portal: the desktop's own file dialog, asked for over D-Bus [XDG Desktop Portal,
/// org.freedesktop.portal.FileChooser]. sd-bus is seen by portal.cpp alone.

#include <functional>
#include <string>
#include <vector>

namespace sinew::editor {

struct PortalRequest {
  std::string title, action;            ///< of the dialog, of its button
  bool save = false;                    ///< asks for a name to write to; otherwise for files that are there
  bool several = false;                 ///< more than one file may be chosen
  std::string folder, name;             ///< where it begins; the name that it proposes
  std::vector<std::string> extensions;  ///< lower case, without dot; files of others are hidden at first. Empty: all
};

struct PortalAnswer {
  /// Unavailable: no bus, no portal, or none with a file dialog, or it left before it answered.
  enum class What { Unavailable, Cancelled, Chosen } what = What::Unavailable;
  std::vector<std::string> paths;  ///< absolute; of files on this machine
};

/// Waits until the user has answered; once `go_on` says false it asks the portal to close its dialog and gives up.
/// From any thread.
PortalAnswer ask_portal(const PortalRequest& request, const std::function<bool()>& go_on);

/// "file:///a%20b" as "/a b"; empty for what is no file of this machine.
std::string path_of_uri(const std::string& uri);

}  // namespace sinew::editor
