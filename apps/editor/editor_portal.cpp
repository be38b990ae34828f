#include <algorithm>
#include <filesystem>

#include "apps/editor/editor.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

PortalRequest portal_request(const FileRequest& request) {
  PortalRequest out;
  out.title = request.title;
  out.action = request.action;
  out.save = request.save;
  out.several = static_cast<bool>(request.done_several);
  out.extensions = request.extensions;
  std::error_code error;
  const fs::path start = fs::absolute(request.start, error);
  out.folder = (fs::is_directory(start, error) ? start : start.parent_path()).lexically_normal().string();
  if (request.save) out.name = start.filename().string();
  return out;
}

}  // namespace

/// By the desktop's dialog where there is one and the user wants it; else by the plain one.
void Editor::ask_for_file(FileRequest request) {
  frames_wanted_ = 2;
  if (!preferences_.native_dialogs || no_portal_) {
    ui_.files.open(std::move(request));
    return;
  }
  if (portal_.busy()) {
    session_.notify(Severity::Hint, "Another file dialog is open.");
    return;
  }
  portal_.start("Asking for a file", true, [this, request](const Tell& tell) -> Background::Finish {
    const PortalAnswer answer = ask_portal(portal_request(request), [&] { return tell(-1); });
    std::vector<std::string> changes;
    if (answer.what == PortalAnswer::What::Chosen && request.changes) changes = request.changes(answer.paths.front());
    return [this, request, answer, changes] { take_portal_answer(request, answer, changes); };
  });
}

void Editor::take_portal_answer(const FileRequest& request, const PortalAnswer& answer,
                                const std::vector<std::string>& changes) {
  switch (answer.what) {
    case PortalAnswer::What::Unavailable:
      no_portal_ = true;
      ui_.files.open(request);
      return;
    case PortalAnswer::What::Cancelled: return;
    case PortalAnswer::What::Chosen: break;
  }
  if (request.done_several) {
    request.done_several(answer.paths);
  } else if (changes.empty()) {
    request.done(answer.paths.front());
  } else {
    // The desktop's dialog has no place for what the plain one says before.
    std::string text = fs::path(answer.paths.front()).filename().string() + ":";
    for (const std::string& change : changes) text += " " + change + (change.ends_with('.') ? "" : ".");
    ui_.ask = {text, request.action, [request, path = answer.paths.front()] { request.done(path); }};
  }
}

}  // namespace sinew::editor
