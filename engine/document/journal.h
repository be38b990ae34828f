#pragma once
/// Journal: the history of one session on the disk, step by step, so that a program that was killed loses at most the
/// step that was being written. One file for each running program; it is locked (flock) as long as the program lives,
/// and removed when the user leaves, so that a journal which nobody holds is what is left of a program that was killed.
///
/// File: "sinew journal 1\n", then records. A record is its length in bytes (8 bytes, little-endian), the first 8 bytes
/// of the SHA-256 of length and content, and the content: a kind and what belongs to it (journal_format.h). Long arrays
/// are records of their own, each written once, however many states have it. Where the file was cut in the middle of a
/// record, that record and what follows it are left out.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/document/history.h"

namespace sinew::document {

/// $XDG_STATE_HOME/sinew, or ~/.local/state/sinew; empty where neither is known.
std::string journal_folder();

/// What a journal holds.
struct JournalContent {
  std::vector<History::State> states;  ///< paths of their projects are absolute
  std::size_t present = 0;
  std::optional<std::size_t> saved;  ///< the state that is in `edit_path`, or that the input is in by itself
  std::string edit_path;             ///< empty: never saved
  std::vector<std::string> hashes;   ///< of the inputs (input_hash.h); none: not known
  std::size_t torn = 0;              ///< bytes at the end that are no whole record

  /// Whether something is there that is neither the input nor in the file of the edit.
  bool unsaved() const { return !states.empty() && (saved != present || states.size() > present + 1); }
};

/// Of bytes that are cut or damaged what is whole before that. Throws InputError where the file is none of version 1,
/// or a whole record holds what is no edit of this version. An empty file has no states.
JournalContent parse_journal(const std::string& path, std::span<const std::byte> bytes);

/// The journal of a program that is gone, locked by this one.
class OldJournal {
 public:
  OldJournal(std::string path, int file) : path_(std::move(path)), file_(file) {}
  OldJournal(const OldJournal&) = delete;
  OldJournal& operator=(const OldJournal&) = delete;
  ~OldJournal();  ///< the file stays, for others to find

  /// Throws InputError.
  void read();
  void discard();  ///< removes the file

  const std::string& path() const { return path_; }
  const JournalContent& content() const { return content_; }
  std::int64_t written() const { return written_; }  ///< when, seconds since 1970

 private:
  std::string path_;
  int file_;
  JournalContent content_;
  std::int64_t written_ = 0;
};

/// Those in a folder whose programs are gone, not read yet.
std::vector<std::shared_ptr<OldJournal>> find_journals(const std::string& folder);

/// The journal of this program. All calls return at once: a thread of its own writes, another one waits for the disk.
class Journal {
 public:
  /// `wake` is called from another thread where take_problem() has something to tell.
  explicit Journal(std::string folder, std::function<void()> wake = {});
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  /// Waits until what was noted is on the disk. The file stays unless it was removed.
  ~Journal();

  /// Another history, from its beginning: what the journal had is dropped.
  void begin(const History& history, const std::string& edit_path, std::optional<std::size_t> saved);
  /// After each change of that history: writes what is new.
  void note(const History& history);
  /// The state with this serial number is in a file now.
  void saved(const History& history, std::uint64_t serial, const std::string& edit_path);
  void hashes(std::vector<std::string> of_inputs);
  /// Nothing is open any more.
  void end();
  /// The user leaves: the file is removed. Nothing may be noted after it.
  void remove();
  /// Removes `journal` once all that was noted so far is on the disk.
  void replace(std::shared_ptr<OldJournal> journal);

  /// Why it can't be written, once until it can again. What was noted is kept and tried again at the next step.
  std::string take_problem();
  /// Waits until all that was noted is in the file (not yet: on the disk), or could not be written.
  void wait_written() const;
  /// So far: bytes of the file, and the seconds that the writing thread took for the last step.
  std::uint64_t bytes() const;
  double seconds() const;

 private:
  class Writer;
  std::unique_ptr<Writer> writer_;
  bool open_ = false;
  std::vector<std::uint64_t> known_;  ///< serial numbers of the states that were noted
  std::size_t present_ = 0;
};

}  // namespace sinew::document
