#pragma once
/// Recovery: finds the journals that killed programs left behind, without holding up the window, to offer them one
/// after the other.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/editor/background.h"
#include "engine/document/journal.h"

namespace sinew::editor {

class Recovery {
 public:
  explicit Recovery(std::function<void()> wake) : background_(std::move(wake)) {}

  /// Once, in the background. Journals without anything unsaved are removed.
  void look(const std::string& folder);
  /// Takes in what was found; sentences about what could not be read, which stays as it is.
  std::vector<std::string> poll();

  /// The one to be asked about, newest first; null where there is none.
  const document::OldJournal* offered() const { return found_.empty() ? nullptr : found_.front().get(); }
  /// To be handed to Session::recover.
  std::shared_ptr<document::OldJournal> recover();
  void discard();
  void later();  ///< stays for the next start
  void all_later() { found_.clear(); }

 private:
  std::vector<std::shared_ptr<document::OldJournal>> found_;
  std::vector<std::string> problems_;
  Background background_;
};

/// "scan.ply: 5 steps that were not saved", of an offered journal.
std::string what_of(const document::OldJournal& journal);
/// "The last one was \"Drag handle\", on 2026-11-25 at 13:50.", and what was lost of it.
std::string details_of(const document::OldJournal& journal);

}  // namespace sinew::editor
