#include "apps/sinew/interrupt.h"

#include <unistd.h>
#include <csignal>
#include <exception>

#include "apps/sinew/command.h"

namespace sinew::app {

namespace {

volatile std::sig_atomic_t writing = 0, noted = 0;
bool failed = false;

extern "C" void on_signal(int) {
  noted = 1;
  if (writing == 0) _exit(Interrupted);
}

}  // namespace

void handle_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  // A reader that goes away is a failed write with a message, not a silent death.
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() {
  return noted != 0;
}

Writing::Writing() : exceptions_(std::uncaught_exceptions()) {
  writing = 1;
}

Writing::~Writing() {
  if (std::uncaught_exceptions() > exceptions_)
    failed = true;
  else
    writing = 0;
}

bool writing_failed() {
  return failed;
}

}  // namespace sinew::app
