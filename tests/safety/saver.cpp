/// sinew-saver: what kill_test.sh kills.
///   save FILE NEW       writes the bytes of NEW to FILE as all programs here do
///   careless FILE NEW   the same as it should not be done: opens, empties, writes
///   journal FOLDER N    keeps a journal of N steps; says "noted I" when step I is in the file, and what went wrong
///   journals FOLDER     says the last step of each journal there that nobody holds

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "engine/document/journal.h"
#include "engine/io/io.h"

namespace {

using namespace sinew;

/// What the script finds in a log of system calls: what comes before it is the start of the program.
void mark_begin() {
  const int none = open("/sinew-begins", O_RDONLY);
  if (none >= 0) close(none);
}

void save_carelessly(const std::string& path, const std::vector<std::byte>& bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0 || write(file, bytes.data(), bytes.size()) < 0 || close(file) != 0)
    throw std::runtime_error(path + " was not written");
}

void say(const std::string& line) {
  const std::string text = line + "\n";
  if (write(STDOUT_FILENO, text.data(), text.size()) < 0) std::exit(4);
}

document::Project project_of(int step) {
  document::Project project;
  project.inputs = {"/data/scan.ply"};
  document::Layer layer;
  std::vector<Index> points(500, static_cast<Index>(step / 2));  // every other step has an array of its own
  layer.fixed.emplace_back().what = document::SelectIndices{document::Shared<Index>(std::move(points))};
  layer.name = std::to_string(step);
  project.layers.push_back(layer);
  return project;
}

void keep_journal(const std::string& folder, int steps) {
  document::History history(project_of(0));
  document::Journal journal(folder);
  journal.begin(history, "", 0);
  for (int i = 1; i <= steps; ++i) {
    history.commit(project_of(i), "Step " + std::to_string(i));
    journal.note(history);
    journal.wait_written();
    if (const std::string problem = journal.take_problem(); !problem.empty())
      say("problem " + problem);
    else
      say("noted " + std::to_string(i));
  }
}

void show_journals(const std::string& folder) {
  for (const std::shared_ptr<document::OldJournal>& journal : document::find_journals(folder)) {
    journal->read();
    const document::JournalContent& content = journal->content();
    if (content.states.empty()) continue;
    for (std::size_t i = 0; i < content.states.size(); ++i)
      if (!(content.states[i].project == project_of(static_cast<int>(i)))) throw std::runtime_error("a mixed state");
    say(std::to_string(content.present));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::string what = argv[1], path = argv[2], more = argc > 3 ? argv[3] : "";
  try {
    if (what == "journals") {
      show_journals(path);
      return 0;
    }
    const std::vector<std::byte> bytes = what == "journal" ? std::vector<std::byte>{} : io::load_bytes(more);
    mark_begin();
    if (what == "save") io::save_bytes(path, bytes, true);
    if (what == "careless") save_carelessly(path, bytes);
    if (what == "journal") keep_journal(path, std::atoi(more.c_str()));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
