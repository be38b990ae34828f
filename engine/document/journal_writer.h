#pragma once
/// The threads behind a Journal: one encodes and writes, one waits for the disk. All of the file belongs to the first.

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

#include "engine/document/journal.h"
#include "engine/document/journal_format.h"

namespace sinew::document {

/// What is to be done, in the order in which it came.
struct JournalItem {
  enum class What { Begin, State, Present, Saved, Hashes, End, Remove, Replace } what = What::State;
  std::uint64_t index = 0;
  History::State state{};
  std::string path{};
  std::vector<std::string> hashes{};
  std::shared_ptr<OldJournal> journal{};
};

class Journal::Writer {
 public:
  Writer(std::string folder, std::function<void()> wake);
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer();

  void put(JournalItem item);
  std::string take_problem();
  void wait_written();
  std::uint64_t bytes() const;
  double seconds() const;

 private:
  /// A wish to have the file on the disk, and its answer.
  struct Sync {
    int file = -1;
    std::uint64_t content = 0;  ///< content_ when it was asked for
    std::uint64_t up_to = 0;    ///< bytes of the file
    int error = 0;              ///< errno
  };

  void run();
  void run_sync();
  void take(JournalItem& item);
  void open_file();
  void drop_content();
  void remove_file();
  void flush();
  void ask_sync();
  void take_sync(const Sync& sync);
  void finish();
  void fail(const std::string& expected, int error);

  const std::string folder_;
  const std::function<void()> wake_;

  // Of the writing thread
  std::string path_;
  int file_ = -1;
  std::uint64_t content_ = 0;  ///< counts how often it was begun anew
  SharedArrays arrays_;
  std::vector<std::byte> unsynced_;  ///< what is not known to be on the disk: the file from byte synced_ on
  std::uint64_t synced_ = 0;
  std::uint64_t written_ = 0;  ///< bytes of the file that were written
  bool syncing_ = false;
  bool told_ = false;  ///< of the present problem
  std::vector<std::shared_ptr<OldJournal>> replaced_;

  // Between threads
  mutable std::mutex mutex_;
  std::condition_variable to_do_, to_sync_, idle_;
  std::deque<JournalItem> items_;
  std::optional<Sync> wish_, answer_;
  bool busy_ = false, closing_ = false, sync_closing_ = false;
  std::string problem_;
  std::uint64_t bytes_ = 0;
  double seconds_ = 0;
  std::thread thread_, sync_thread_;  ///< last: they begin when all else is there
};

}  // namespace sinew::document
