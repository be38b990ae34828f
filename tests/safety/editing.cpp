/// sinew-editing SHAPE FOLDER SEED STEPS: an editing session without a window, with its journal in FOLDER, for a test
/// that kills it. Says "doing I" before a step and "done I PRESENT HASH" after it, when it is in the journal.

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <random>

#include "apps/editor/session.h"
#include "deformers/methods.h"
#include "tests/safety/editing.h"

namespace {

using namespace sinew;
using editor::Session;

void say(const std::string& line) {
  const std::string text = line + "\n";
  if (write(STDOUT_FILENO, text.data(), text.size()) < 0) std::exit(4);
}

void wait(Session& session) {
  while (session.solving() || session.job()) {
    session.poll();
    usleep(1000);
  }
}

void select_some(Session& session, std::mt19937& random) {
  const auto& positions = session.input()->positions;
  const Vec3 center = positions[random() % positions.size()];
  const double radius = session.rest_bounds().diagonal() * (0.05 + 0.001 * static_cast<double>(random() % 100));
  std::vector<Index> touched;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if ((positions[i] - center).norm() < radius) touched.push_back(static_cast<Index>(i));
  session.select(editor::PointSet(positions.size(), touched), editor::SelectMode::Replace);
}

void drag_some(Session& session, std::mt19937& random) {
  if (session.layer() == nullptr || session.layer()->handles.empty()) return;
  if (!session.begin_drag(random() % session.layer()->handles.size())) return;
  for (int i = 1; i <= 5; ++i) {
    editor::Transform motion;
    motion.move = Vec3(0.01 * i, 0.002 * static_cast<double>(random() % 10), 0);
    session.drag_to(motion);
    session.poll();
  }
  session.end_drag();
}

/// What a user might do next.
void step(Session& session, std::mt19937& random) {
  switch (random() % 8) {
    case 0: session.undo(); break;
    case 1: session.redo(); break;
    case 2: session.go_to(random() % session.history().size()); break;
    case 3: session.set_setting(0, "nodes", 20.0 + static_cast<double>(random() % 30)); break;
    case 4: drag_some(session, random); break;
    case 5: session.rename_layer(0, "Layer " + std::to_string(random() % 1000)); break;
    default: {
      select_some(session, random);
      constexpr editor::Mark marks[] = {editor::Mark::Handle, editor::Mark::Fixed, editor::Mark::Free};
      session.mark_selection(marks[random() % 3]);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  std::mt19937 random(static_cast<unsigned>(std::atoi(argv[3])));
  Session session(methods());
  session.keep_journal(argv[2]);
  session.open(argv[1]);
  wait(session);
  if (!session.has_input()) return 3;
  for (int i = 1; i <= std::atoi(argv[4]); ++i) {
    say("doing " + std::to_string(i));
    step(session, random);
    session.poll();
    if (random() % 4 == 0) wait(session);  // a drag may still find another minimum, which becomes its step
    session.journal()->wait_written();
    say("done " + std::to_string(i) + " " + std::to_string(session.history().position()) + " " +
        std::to_string(hash_of(session.project())));
  }
  return 0;
}
