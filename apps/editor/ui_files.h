#pragma once
/// FileDialog: a plain dialog that opens or names a file: folders, a filter, recent files.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/editor/background.h"

namespace sinew::editor {

struct FileRequest {
  std::string title;                       ///< "Open"
  std::string action;                      ///< text of the button
  bool save = false;                       ///< a name may be typed; an existing one asks once more
  std::vector<std::string> extensions;     ///< lower case, without dot; files of others are not listed. Empty: all
  std::string start;                       ///< a folder, or a file whose folder and name are the first
  std::string note;                        ///< a sentence above the buttons; or empty
  std::string folder_action, folder_help;  ///< of a button that takes the chosen folder, or the one shown; empty: none
  std::function<void(const std::string& path)> done;
  /// Takes several files that were chosen together; empty: only one may be.
  std::function<void(const std::vector<std::string>& paths)> done_several = {};
  /// What a file of this name would not hold, a sentence each. May take long; called from another thread.
  std::function<std::vector<std::string>(const std::string& path)> changes = {};
};

class FileDialog {
 public:
  void open(FileRequest request);
  bool shown() const { return shown_; }
  /// Whether what a file would not hold is being found out.
  bool looking() const { return looking_.busy(); }

  /// A frame of the dialog; calls FileRequest::done when a file was chosen.
  void show(std::span<const std::string> recent);

 private:
  struct Entry {
    std::string name;
    bool folder = false;
    std::uintmax_t size = 0;
    std::string date;
  };

  void list_folder();
  bool listed(const Entry& entry) const;
  void show_head();
  void show_recent(std::span<const std::string> recent, float width, float height);
  void show_entries(float height);
  void show_foot(std::span<const std::string> sentences);
  void enter(const std::string& folder);
  void take(const std::string& path);
  void choose();  ///< what Enter and the button do
  std::vector<std::string> notes();

  FileRequest request_;
  bool shown_ = false, just_opened_ = false, ask_again_ = false, close_ = false;
  std::string folder_, typed_folder_, name_, filter_, error_;
  std::vector<Entry> entries_;
  int chosen_ = -1;
  std::string looked_at_;  ///< ending of the names that changes_ are of
  std::vector<std::string> changes_;
  Background looking_;
};

/// "12.4 MB".
std::string size_text(std::uintmax_t bytes);

}  // namespace sinew::editor
