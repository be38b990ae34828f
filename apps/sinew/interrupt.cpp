#include "apps/sinew/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <exception>

#include "apps/sinew/command.h"

namespace sinew::app {

namespace {

volatile std::sig_atomic_t held = 0, noted = 0;
bool failed = false;
std::string place;

extern "C" void on_signal(int) {
  if (held == 0 || noted != 0) _exit(Interrupted);
  noted = 1;
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

HoldInterrupts::HoldInterrupts() {
  held = held + 1;
}

HoldInterrupts::~HoldInterrupts() {
  held = held - 1;
  if (held == 0 && noted != 0 && std::uncaught_exceptions() == 0) _exit(Interrupted);
}

Writing::Writing() : exceptions_(std::uncaught_exceptions()) {}

Writing::~Writing() {
  if (std::uncaught_exceptions() > exceptions_) failed = true;
}

bool writing_failed() {
  return failed;
}

Naming::Naming(std::string path) : path_(std::move(path)), exceptions_(std::uncaught_exceptions()) {}

Naming::~Naming() {
  if (std::uncaught_exceptions() > exceptions_) place = path_ + ": ";
}

std::string failed_place() {
  return place;
}

}  // namespace sinew::app
