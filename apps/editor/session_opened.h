#pragma once
/// What the session's functions that open and save share.

#include "apps/editor/session.h"

namespace sinew::editor {

/// What a file gave, on its way from the reader's thread.
struct Session::Opened {
  std::shared_ptr<const Sequence> sequence;
  std::shared_ptr<const Shape> shape;  ///< its first frame
  bool stream = false;
  std::size_t run = 0;  ///< how many numbered files the input is one of
  std::string input_path, edit_path;
  document::Project project;
  std::shared_ptr<document::Selector> selector;
  std::map<std::string, document::MotionTime> motions;  ///< by path
  std::vector<std::string> notes;                       ///< on the motion
  Bounds bounds;
  PointSet finite;
  bool on_disk = true;                            ///< the project is what the edit's file says
  std::shared_ptr<document::OldJournal> journal;  ///< that it is from
};

/// Writes an edit with the hash of its input (input_hash.h), which is found now where it is not known. Throws
/// InputError.
void save_project(const std::string& path, document::Project project, std::string hash);

/// The history that a journal holds.
document::History history_of(const document::JournalContent& content);

}  // namespace sinew::editor
