#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "apps/editor/session_opened.h"
#include "engine/document/edit.h"
#include "engine/document/input_hash.h"
#include "engine/document/settings.h"
#include "engine/io/io.h"

namespace sinew::editor {

void save_project(const std::string& path, document::Project project, std::string hash) {
  // A shape without a file has no hash, and is saved all the same.
  if (hash.empty() && project.inputs.size() == 1)
    sentence_of_failure([&] { hash = document::input_hash(project.inputs.front()); });
  project.hashes.of.clear();
  if (!hash.empty()) project.hashes.of.push_back(hash);
  const std::string text = document::edit_text(path, project);
  io::save_bytes(path, std::as_bytes(std::span(text)), true);
}

document::History history_of(const document::JournalContent& content) {
  return {content.states, content.present};
}

void Session::keep_journal(const std::string& folder) {
  journal_ = std::make_unique<document::Journal>(folder, wake_);
}

void Session::recover(std::shared_ptr<document::OldJournal> journal) {
  const document::JournalContent& content = journal->content();
  if (content.states.empty() || content.states[content.present].project.inputs.empty()) return;
  const std::string input = content.states[content.present].project.inputs.front();
  open_next({Opening::As::Recovered, {input}, std::move(journal)});
}

void Session::read_journal(const std::shared_ptr<document::OldJournal>& journal) {
  const document::JournalContent& content = journal->content();
  const std::string input = content.states[content.present].project.inputs.front();
  const auto work = [this, journal, input](const Tell& tell) -> Background::Finish {
    auto opened = std::make_shared<Opened>();
    const document::JournalContent& from = journal->content();
    opened->journal = journal;
    opened->input_path = input;
    opened->edit_path = from.edit_path;
    opened->project = from.states[from.present].project;
    if (!from.hashes.empty()) opened->project.hashes.of = from.hashes;
    document::check_layers(opened->project.layers, methods_);
    read_shape(*opened, tell);
    prepare(*opened);
    if (!tell(1)) throw io::Cancelled{};
    return [this, opened] { show(std::move(*opened)); };
  };
  background_->start("Recovering " + std::filesystem::path(input).filename().string(), true, work);
}

/// What is shown now becomes all that the journal has.
void Session::begin_journal(const Opened& opened) {
  std::optional<std::size_t> saved = opened.on_disk ? std::optional<std::size_t>(0) : std::nullopt;
  if (opened.journal) {
    saved = opened.journal->content().saved;
    saved_ = saved ? history_.state(*saved).project : document::Project{};
  }
  if (journal_ == nullptr) return;
  journal_->begin(history_, edit_path_, saved);
  if (opened.journal) journal_->replace(opened.journal);
}

void Session::watch_journal() {
  if (const std::optional<Background::Outcome> outcome = hashing_->take(); outcome && outcome->finish)
    outcome->finish();
  if (journal_ == nullptr) return;
  if (std::string problem = journal_->take_problem(); !problem.empty())
    notify(Severity::Warning, "The journal of this session can't be written: " + problem);
}

/// In the background; tells where the input is not what the edit was saved with.
void Session::hash_input(const std::vector<std::string>& expected) {
  while (hashing_->busy()) {  // of the shape before, which is being cancelled
    hashing_->take();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  hashing_->start("Hashing", true,
                  [this, path = input_path_, input = input_, expected](const Tell& tell) -> Background::Finish {
                    const std::string hash = document::input_hash(path, [&] { return tell(-1); });
                    return [this, path, input, expected, hash] {
                      if (input != input_) return;
                      input_hash_ = hash;
                      if (journal_ != nullptr) journal_->hashes({hash});
                      if (!expected.empty() && expected.front() != hash)
                        notify(Severity::Warning,
                               document::sentence_of_other_input(std::filesystem::path(path).filename().string()));
                    };
                  });
}

void Session::leave() {
  while (background_->busy() && !background_->can_cancel()) {
    take_background();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (finish_waiting() && journal_ != nullptr) journal_->remove();
}

}  // namespace sinew::editor
