#pragma once
/// Ctrl-C. It ends the program at once (status 130), except while an output is being written: then it is only noted,
/// and the writer finishes or gives up its temporary file.

namespace sinew::app {

void handle_interrupts();

/// True once Ctrl-C was pressed while an output was being written.
bool interrupted();

/// Lives while an output is written. An exception that leaves it says that the output, not the input, was at fault.
class Writing {
 public:
  Writing();
  ~Writing();
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;

 private:
  int exceptions_;
};

/// Whether an exception left a Writing.
bool writing_failed();

}  // namespace sinew::app
