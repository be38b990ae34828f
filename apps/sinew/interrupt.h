#pragma once
/// Ctrl-C, and what an exception left behind. Ctrl-C ends the program at once (status 130), except while an output is
/// open: then it is only noted, and the writer finishes or gives up its temporary file. A second one ends it there too.

#include <string>

namespace sinew::app {

void handle_interrupts();

/// True once Ctrl-C was pressed while it was held.
bool interrupted();

/// While it lives, Ctrl-C is only noted.
class HoldInterrupts {
 public:
  HoldInterrupts();
  ~HoldInterrupts();
  HoldInterrupts(const HoldInterrupts&) = delete;
  HoldInterrupts& operator=(const HoldInterrupts&) = delete;
};

/// Lives while an output is written. An exception that leaves it says that the output, not the input, was at fault.
class Writing {
 public:
  Writing();
  ~Writing();

 private:
  HoldInterrupts hold_;
  int exceptions_;
};
bool writing_failed();

/// Lives while something of a file is checked by code that does not know its path.
class Naming {
 public:
  explicit Naming(std::string path);
  ~Naming();
  Naming(const Naming&) = delete;
  Naming& operator=(const Naming&) = delete;

 private:
  std::string path_;
  int exceptions_;
};
/// "PATH: " of the Naming that an exception left, or nothing.
std::string failed_place();

}  // namespace sinew::app
