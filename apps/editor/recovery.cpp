#include "apps/editor/recovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

namespace sinew::editor {

void Recovery::look(const std::string& folder) {
  if (folder.empty() || background_.busy()) return;
  background_.start("Looking for unsaved work", false, [this, folder](const Tell&) -> Background::Finish {
    std::vector<std::shared_ptr<document::OldJournal>> found;
    std::vector<std::string> problems;
    for (const std::shared_ptr<document::OldJournal>& journal : document::find_journals(folder)) {
      const std::string failure = sentence_of_failure([&] { journal->read(); });
      if (!failure.empty())
        problems.push_back(failure + "; it stays as it is");
      else if (journal->content().unsaved())
        found.push_back(journal);
      else
        journal->discard();
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a->written() > b->written(); });
    return [this, found, problems] {
      found_ = found;
      problems_ = problems;
    };
  });
}

std::vector<std::string> Recovery::poll() {
  if (const std::optional<Background::Outcome> outcome = background_.take(); outcome && outcome->finish)
    outcome->finish();
  return std::exchange(problems_, {});
}

std::shared_ptr<document::OldJournal> Recovery::recover() {
  if (found_.empty()) return nullptr;
  std::shared_ptr<document::OldJournal> out = found_.front();
  found_.erase(found_.begin());
  return out;
}

void Recovery::discard() {
  if (const std::shared_ptr<document::OldJournal> journal = recover()) journal->discard();
}

void Recovery::later() {
  recover();
}

std::string what_of(const document::OldJournal& journal) {
  const document::JournalContent& content = journal.content();
  const std::vector<std::string>& inputs = content.states[content.present].project.inputs;
  const std::string name = inputs.empty() ? "A shape" : std::filesystem::path(inputs.front()).filename().string();
  // Steps behind the present one were taken back, and can be had again.
  const std::size_t since = content.saved.value_or(0), last = content.states.size() - 1;
  const std::size_t steps = last > since ? last - since : since - content.present;
  return fmt::format("{}: {} step{} not saved", name, steps, steps == 1 ? "" : "s");
}

std::string details_of(const document::OldJournal& journal) {
  const document::JournalContent& content = journal.content();
  // Where all was taken back, what can be had again.
  const std::size_t last = content.present > 0 ? content.present : content.states.size() - 1;
  const std::time_t time = journal.written();
  std::tm local{};
  localtime_r(&time, &local);
  std::string out =
      fmt::format("The last one was \"{}\", on {:04}-{:02}-{:02} at {:02}:{:02}.", content.states[last].label,
                  local.tm_year + 1900, local.tm_mon + 1, local.tm_mday, local.tm_hour, local.tm_min);
  if (content.torn > 0) out += " Another was being written and is lost.";
  return out;
}

}  // namespace sinew::editor
