#include "engine/document/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/document/journal_writer.h"
#include "engine/io/io.h"

namespace sinew::document {

std::string journal_folder() {
  // Relative values of the variable are to be ignored [XDG Base Directory Specification].
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && state[0] == '/') return std::string(state) + "/sinew";
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/') return std::string(home) + "/.local/state/sinew";
  return {};
}

OldJournal::~OldJournal() {
  close(file_);
}

void OldJournal::read() {
  struct stat status;
  if (fstat(file_, &status) == 0) written_ = status.st_mtim.tv_sec;
  content_ = parse_journal(path_, io::load_bytes(path_));
}

void OldJournal::discard() {
  unlink(path_.c_str());
}

namespace {

/// The journal under this name where no program holds it; null where one does, or it is gone.
std::shared_ptr<OldJournal> lock_journal(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return nullptr;
  auto journal = std::make_shared<OldJournal>(path, file);
  struct stat ours, there;
  const bool locked = flock(file, LOCK_EX | LOCK_NB) == 0;
  // Another program may have removed it between the opening and the locking.
  if (!locked || fstat(file, &ours) != 0 || stat(path.c_str(), &there) != 0 || ours.st_ino != there.st_ino)
    return nullptr;
  return journal;
}

}  // namespace

std::vector<std::shared_ptr<OldJournal>> find_journals(const std::string& folder) {
  std::vector<std::shared_ptr<OldJournal>> out;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".journal")
      if (std::shared_ptr<OldJournal> journal = lock_journal(entry->path().string())) out.push_back(std::move(journal));
  return out;
}

using What = JournalItem::What;

Journal::Journal(std::string folder, std::function<void()> wake)
    : writer_(std::make_unique<Writer>(std::move(folder), std::move(wake))) {}

Journal::~Journal() = default;

void Journal::begin(const History& history, const std::string& edit_path, std::optional<std::size_t> saved) {
  open_ = true;
  known_.clear();
  writer_->put({.what = What::Begin});
  for (std::size_t i = 0; i < history.size(); ++i) {
    known_.push_back(history.state(i).serial);
    writer_->put({.what = What::State, .index = i, .state = history.state(i)});
  }
  writer_->put({.what = What::Present, .index = history.position()});
  writer_->put({.what = What::Saved, .index = saved ? *saved : journal::none, .path = edit_path});
  present_ = history.position();
}

void Journal::note(const History& history) {
  if (!open_) return;
  const std::size_t now = history.position();
  for (std::size_t i = 0; i <= now; ++i) {
    const History::State& state = history.state(i);
    if (i < known_.size() && known_[i] == state.serial) continue;
    known_.resize(i);
    known_.push_back(state.serial);
    present_ = i;
    writer_->put({.what = What::State, .index = i, .state = state});
  }
  if (present_ != now) writer_->put({.what = What::Present, .index = now});
  present_ = now;
}

void Journal::saved(const History& history, std::uint64_t serial, const std::string& edit_path) {
  if (!open_) return;
  note(history);
  const auto found = std::find(known_.begin(), known_.end(), serial);
  const std::uint64_t index =
      found == known_.end() ? journal::none : static_cast<std::uint64_t>(found - known_.begin());
  writer_->put({.what = What::Saved, .index = index, .path = edit_path});
}

void Journal::hashes(std::vector<std::string> of_inputs) {
  if (open_) writer_->put({.what = What::Hashes, .hashes = std::move(of_inputs)});
}

void Journal::end() {
  if (std::exchange(open_, false)) writer_->put({.what = What::End});
}

void Journal::remove() {
  open_ = false;
  writer_->put({.what = What::Remove});
}

void Journal::replace(std::shared_ptr<OldJournal> journal) {
  writer_->put({.what = What::Replace, .journal = std::move(journal)});
}

std::string Journal::take_problem() {
  return writer_->take_problem();
}

void Journal::wait_written() const {
  writer_->wait_written();
}

std::uint64_t Journal::bytes() const {
  return writer_->bytes();
}

double Journal::seconds() const {
  return writer_->seconds();
}

}  // namespace sinew::document
