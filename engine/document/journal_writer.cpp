#include "engine/document/journal_writer.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <utility>

#include "engine/io/shared_file.h"

namespace sinew::document {

namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Whether the open file is still the one under this name.
bool same_file(int file, const std::string& path) {
  struct stat a, b;
  return fstat(file, &a) == 0 && stat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Without it the file is there after a crash of the machine, but its name may not be.
void sync_folder(const std::string& folder) {
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  fsync(file);
  close(file);
}

}  // namespace

Journal::Writer::Writer(std::string folder, std::function<void()> wake)
    : folder_(std::move(folder)),
      wake_(std::move(wake)),
      thread_([this] { run(); }),
      sync_thread_([this] { run_sync(); }) {}

Journal::Writer::~Writer() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  to_do_.notify_one();
  thread_.join();
  sync_thread_.join();
  if (file_ >= 0) close(file_);  // and with it the lock
}

void Journal::Writer::put(JournalItem item) {
  {
    const std::lock_guard lock(mutex_);
    items_.push_back(std::move(item));
  }
  to_do_.notify_one();
}

std::string Journal::Writer::take_problem() {
  const std::lock_guard lock(mutex_);
  return std::exchange(problem_, {});
}

void Journal::Writer::wait_written() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return items_.empty() && !busy_; });
}

std::uint64_t Journal::Writer::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

double Journal::Writer::seconds() const {
  const std::lock_guard lock(mutex_);
  return seconds_;
}

void Journal::Writer::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    to_do_.wait(lock, [this] { return !items_.empty() || answer_ || closing_; });
    std::deque<JournalItem> items = std::exchange(items_, {});
    const std::optional<Sync> answer = std::exchange(answer_, std::nullopt);
    const bool last = closing_;
    busy_ = true;
    lock.unlock();
    const double began = seconds_now();
    if (answer) take_sync(*answer);
    for (JournalItem& item : items) take(item);
    if (!items.empty()) flush();
    if (last) finish();
    lock.lock();
    busy_ = false;
    bytes_ = written_;
    if (!items.empty()) seconds_ = seconds_now() - began;
    if (items_.empty()) idle_.notify_all();
    if (last) break;
  }
  sync_closing_ = true;
  to_sync_.notify_one();
}

/// The disk may take as long as it likes: what is in the file survives the end of the program, and the next step need
/// not wait until it would survive the end of the machine.
void Journal::Writer::run_sync() {
  std::unique_lock lock(mutex_);
  for (;;) {
    to_sync_.wait(lock, [this] { return wish_ || sync_closing_; });
    if (!wish_) return;
    Sync sync = *std::exchange(wish_, std::nullopt);
    lock.unlock();
    sync.error = fdatasync(sync.file) == 0 ? 0 : errno;
    lock.lock();
    answer_ = sync;
    to_do_.notify_one();
  }
}

void Journal::Writer::take(JournalItem& item) {
  using What = JournalItem::What;
  switch (item.what) {
    case What::Begin: {
      drop_content();
      const std::span<const std::byte> magic = std::as_bytes(std::span(journal::magic));
      unsynced_.assign(magic.begin(), magic.end());
      break;
    }
    case What::State: journal::put_state(unsynced_, arrays_, item.index, item.state); break;
    case What::Present: journal::put_present(unsynced_, item.index); break;
    case What::Saved: journal::put_saved(unsynced_, item.index, item.path); break;
    case What::Hashes: journal::put_hashes(unsynced_, item.hashes); break;
    case What::Replace: replaced_.push_back(std::move(item.journal)); break;
    case What::End: drop_content(); break;
    case What::Remove: remove_file(); break;
  }
}

/// Nobody may take the file for one that was left behind before it is locked: such a one is made anew.
void Journal::Writer::open_file() {
  static std::atomic<unsigned> counter{0};
  std::error_code error;
  if (std::filesystem::create_directories(folder_, error)) chmod(folder_.c_str(), 0700);
  for (int tries = 0; tries < 100; ++tries) {
    path_ = folder_ + "/editor-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".journal";
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file_ < 0 && errno == EEXIST) continue;
    if (file_ < 0) return;
    if (flock(file_, LOCK_EX | LOCK_NB) == 0 && same_file(file_, path_)) {
      sync_folder(folder_);
      return;
    }
    const int why = errno;
    unlink(path_.c_str());
    close(std::exchange(file_, -1));
    errno = why;
  }
}

void Journal::Writer::drop_content() {
  unsynced_.clear();
  arrays_ = {};
  synced_ = written_ = 0;
  ++content_;
  if (file_ < 0 || ftruncate(file_, 0) == 0) return;
  // Old records must not follow new ones. It stays open: the other thread may be waiting for it.
  unlink(path_.c_str());
  file_ = -1;
}

void Journal::Writer::remove_file() {
  drop_content();
  if (file_ >= 0) unlink(path_.c_str());
  for (const std::shared_ptr<OldJournal>& old : std::exchange(replaced_, {})) old->discard();
}

/// Writes all that is not in the file yet. After a failure the file ends where it did, and the next step tries again.
void Journal::Writer::flush() {
  if (unsynced_.empty()) return;
  if (file_ < 0) open_file();
  if (file_ < 0) {
    fail("a file that can be made", errno);
    return;
  }
  const auto rest = std::span(unsynced_).subspan(written_ - synced_);
  if (!rest.empty() && !io::write_all_at(file_, written_, rest)) {
    fail("room for " + std::to_string(rest.size()) + " more bytes", errno);
    if (ftruncate(file_, static_cast<off_t>(written_)) != 0) return;  // a torn end, which a reader leaves out
    return;
  }
  written_ += rest.size();
  ask_sync();
}

void Journal::Writer::ask_sync() {
  if (syncing_ || written_ == synced_ || file_ < 0) return;
  syncing_ = true;
  {
    const std::lock_guard lock(mutex_);
    wish_ = Sync{file_, content_, written_};
  }
  to_sync_.notify_one();
}

/// After an error nobody knows what of it is on the disk [fsync(2)]: it is all written again with the next step.
void Journal::Writer::take_sync(const Sync& sync) {
  syncing_ = false;
  if (sync.content != content_) {
    ask_sync();
    return;
  }
  if (sync.error != 0) {
    fail("to be brought to the disk", sync.error);
    written_ = synced_;
    return;
  }
  unsynced_.erase(unsynced_.begin(), unsynced_.begin() + static_cast<std::ptrdiff_t>(sync.up_to - synced_));
  synced_ = sync.up_to;
  if (unsynced_.empty()) told_ = false;
  if (written_ > synced_) {
    ask_sync();
    return;
  }
  for (const std::shared_ptr<OldJournal>& old : std::exchange(replaced_, {})) old->discard();
}

/// The program ends, and what was noted is to be on the disk.
void Journal::Writer::finish() {
  flush();
  if (!syncing_) return;
  std::unique_lock lock(mutex_);
  to_do_.wait(lock, [this] { return answer_.has_value(); });
  const Sync answer = *std::exchange(answer_, std::nullopt);
  lock.unlock();
  take_sync(answer);
  if (syncing_) finish();
}

void Journal::Writer::fail(const std::string& expected, int error) {
  if (std::exchange(told_, true)) return;
  {
    const std::lock_guard lock(mutex_);
    problem_ = (path_.empty() ? folder_ : path_) + ": expected " + expected + ", found " +
               sinew::quoted(std::strerror(error)) +
               ". Work goes on, but what is not saved would be lost if the program ended now.";
  }
  if (wake_) wake_();
}

}  // namespace sinew::document
