#pragma once
/// FileDialog: a plain dialog that opens or names a file: folders, a filter, recent files.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

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
};

class FileDialog {
 public:
  void open(FileRequest request);
  bool shown() const { return shown_; }

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
  void show_foot();
  void enter(const std::string& folder);
  void take(const std::string& path);
  void choose();  ///< what Enter and the button do

  FileRequest request_;
  bool shown_ = false, just_opened_ = false, ask_again_ = false, close_ = false;
  std::string folder_, typed_folder_, name_, filter_, error_;
  std::vector<Entry> entries_;
  int chosen_ = -1;
};

/// "12.4 MB".
std::string size_text(std::uintmax_t bytes);

}  // namespace sinew::editor
